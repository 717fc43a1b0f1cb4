// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mixed/mirror_samples.h"

#include <algorithm>
#include <cmath>

#include "catoptric/geometry/nearest_hit.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kBefore = 0.9999;  // of the way to the point: what lies farther is the point itself

/// The k-th of a sequence that fills a triangle evenly (Roberts' R2, folded over the diagonal).
dvec2 placeInTriangle(std::size_t k) {
  const double x = 0.5 + 0.7548776662466927 * double(k), y = 0.5 + 0.5698402909980532 * double(k);
  const dvec2 s(x - std::floor(x), y - std::floor(y));
  return s.x + s.y <= 1 ? s : dvec2(1) - s;
}

/// Step 2, for a point `away` from the eye.
bool isSeen(const SceneRays& scene, const scene::CameraFrame& camera, const dvec3& away) {
  const double forward = glm::dot(away, camera.forward), reach = forward * camera.tanHalfFovY;
  if (!(forward > 0) || std::abs(glm::dot(away, camera.up)) > reach ||
      std::abs(glm::dot(away, camera.right)) * camera.heightPx > reach * camera.widthPx)
    return false;
  const auto hit = geometry::findNearestHit(scene.triangles, camera.eye, away);
  return !hit || hit->distance >= kBefore;
}

}  // namespace

std::vector<MirrorSample> sampleMirror(const ReflectorMesh& mesh, const SceneRays& scene,
                                       const scene::CameraFrame& camera, std::size_t about) {
  std::vector<MirrorSample> samples;
  const std::size_t count = std::max<std::size_t>(mesh.ordinaryCount(), 1);
  const std::size_t step = std::max<std::size_t>(1, count / about);
  const std::size_t perTriangle = (about + count - 1) / count;
  const double pixelsPerTangent = 0.5 * camera.heightPx / camera.tanHalfFovY;
  // 1
  for (std::size_t i = step / 2; i < mesh.ordinaryCount(); i += step) {
    const MirrorTriangle& t = mesh.triangles()[i];
    const dvec3 area = glm::cross(t.edge1, t.edge2);
    for (std::size_t k = 0; k < perTriangle; ++k) {
      const dvec2 uv = perTriangle == 1 ? dvec2(1.0 / 3) : placeInTriangle(k);
      const dvec3 away = t.position(uv.x, uv.y) - camera.eye;
      if (!(glm::dot(t.normal(uv.x, uv.y), away) < 0 && glm::dot(area, away) < 0)) continue;
      if (!isSeen(scene, camera, away)) continue;
      // 3
      const double forward = glm::dot(away, camera.forward);
      const double cell =
          pixelsPerTangent * pixelsPerTangent * -glm::dot(area, away) / (forward * forward * forward);
      samples.push_back(
          {{std::uint32_t(i), uv.x, uv.y}, 0.5 * cell * double(step) / double(perTriangle), cell});
    }
  }
  return samples;
}

bool isSeenFromBehind(const scene::WorldGeometry& world, std::uint32_t reflector, const dvec3& eye) {
  const scene::Reflector& mirror = world.reflectors[reflector];
  if (!mirror.doubleSided) return false;
  const scene::Part& part = world.parts[mirror.part];
  double front = 0, back = 0;  // solid angles
  for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3) {
    const std::uint32_t* v = &world.indices[i];
    const dvec3 a(world.positions[v[0]]), b(world.positions[v[1]]), c(world.positions[v[2]]);
    const dvec3 toEye = eye - (a + b + c) / 3.0;
    const double square = std::max(glm::dot(toEye, toEye), 1e-300);
    const double seen = glm::dot(glm::cross(b - a, c - a), toEye) / (square * std::sqrt(square));
    (seen > 0 ? front : back) += std::abs(seen);
  }
  return back > 2 * front;
}

}  // namespace catoptric::virtual_object
