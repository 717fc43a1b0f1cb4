// SPDX-License-Identifier: Apache-2.0
#include "catoptric/renderer/expected_cost.h"

#include <algorithm>
#include <cmath>

#include "catoptric/geometry/nearest_hit.h"

namespace catoptric::renderer {
namespace {

// What composing the frame takes is part of each first constant.
constexpr double kMapMs = 0.9, kMapPixelMs = 1.5e-4;
constexpr double kRefinedMs = 2.3, kRefinedPixelMs = 1.2e-4, kRefinedTriangleMs = 2.4e-5;
constexpr double kExactMs = 2.6, kExactPixelMs = 2.3e-4, kExactOfferedMs = 4.9e-4;
constexpr double kPartsMs = 6, kPartsPixelMs = 5e-5;

constexpr double kStart = 1e-4;        // of the mirror's radius: a ray does not meet where it starts
constexpr double kMostTriangles = 64;  // at a pixel

/// How many triangles like the one that the sample's ray meets a pixel shows; less than one where they are
/// large.
double countTriangles(const virtual_object::MirrorTriangle& t, const virtual_object::MirrorSample& sample,
                      const virtual_object::SceneRays& scene, const scene::WorldGeometry& world,
                      const dvec3& eye, double least) {
  const dvec3 j = t.position(sample.at.u, sample.at.v);
  const dvec3 r =
      core::reflectDirection(glm::normalize(j - eye), glm::normalize(t.normal(sample.at.u, sample.at.v)));
  const auto hit = geometry::findNearestHit(scene.triangles, j, r, least);
  if (!hit) return 0;
  const std::uint32_t* v = &world.indices[3 * std::size_t(hit->triangle)];
  const dvec3 a(world.positions[v[0]]), b(world.positions[v[1]]), c(world.positions[v[2]]);
  const double across = 0.5 * std::abs(glm::dot(glm::cross(b - a, c - a), r));
  const double pencil =
      std::abs(virtual_object::findPencil(t, eye, sample.at.u, sample.at.v).areaAt(hit->distance));
  return std::min(pencil / std::max(sample.cellPixels * across, 1e-300), kMostTriangles);
}

}  // namespace

MirrorLoad measureLoad(const virtual_object::ReflectorMesh& mesh, const virtual_object::SceneRays& scene,
                       const scene::WorldGeometry& world, const dvec3& eye,
                       std::span<const virtual_object::MirrorSample> samples) {
  MirrorLoad load;
  for (const virtual_object::MirrorSample& sample : samples) {
    load.pixels += sample.pixels;
    load.offered += sample.pixels * countTriangles(mesh.triangles()[sample.at.triangle], sample, scene, world,
                                                   eye, kStart * mesh.radius());
  }
  return load;
}

double expectMapMs(const MirrorLoad& load) {
  return kMapMs + kMapPixelMs * load.pixels;
}

double expectRefinedMs(const MirrorLoad& load) {
  return kRefinedMs + kRefinedPixelMs * load.pixels + kRefinedTriangleMs * load.triangles;
}

double expectExactMs(const MirrorLoad& load) {
  return kExactMs + kExactPixelMs * load.pixels + kExactOfferedMs * load.offered;
}

double expectPartsMs(const MirrorLoad& load) {
  MirrorLoad rest = load;
  rest.pixels *= 1 - load.virtualShare;
  rest.offered *= 1 - load.virtualShare;
  return kPartsMs + kPartsPixelMs * load.pixels + load.partsMs + expectExactMs(rest);
}

}  // namespace catoptric::renderer
