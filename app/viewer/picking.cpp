// SPDX-License-Identifier: Apache-2.0
// Steps: 1 the pixel, 2 where its ray meets the first mirror, 3 by how much the way on from there to the seen
// point misses the mirrored ray (zero for an exact reflection).
#include "viewer/picking.h"

#include <algorithm>
#include <cmath>

#include "catoptric/scene/camera_frame.h"
#include "viewer/triangle_hit.h"

namespace catoptric::viewer {
namespace {

struct MirrorHit {
  double distance;
  dvec3 normal;
};

/// Over the triangles of one mirror: some ten thousand at most, once a mouse move.
std::optional<MirrorHit> hitMirror(const scene::WorldGeometry& world, std::uint32_t reflector,
                                   const dvec3& eye, const dvec3& direction) {
  const scene::Part& part = world.parts[world.reflectors[reflector].part];
  std::optional<MirrorHit> nearest;
  for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3) {
    const auto hit = hitTriangle(world, i, eye, direction);
    if (!hit || (nearest && nearest->distance <= hit->distance)) continue;
    const auto normalAt = [&](std::uint32_t k) { return dvec3(world.normals[world.indices[i + k]]); };
    const dvec3 normal = (1 - hit->u - hit->v) * normalAt(0) + hit->u * normalAt(1) + hit->v * normalAt(2);
    nearest = MirrorHit{hit->distance, glm::normalize(normal)};
  }
  return nearest;
}

}  // namespace

std::optional<Picked> pick(const FrameResult& frame, const dvec2& at) {
  // 1
  if (!frame.frame || frame.frame->seen.isEmpty() || at.x < 0 || at.y < 0 || at.x >= 1 || at.y >= 1)
    return std::nullopt;
  const core::SeenImage& seen = frame.frame->seen;
  Picked picked;
  picked.pixel = ivec2(int(at.x * seen.width()), int(at.y * seen.height()));
  picked.seen = seen.at(picked.pixel.x, picked.pixel.y);
  if (!picked.seen.isMirror() || !frame.geometry) return picked;
  // 2
  const scene::CameraFrame view = scene::makeCameraFrame(frame.request.camera, seen.width(), seen.height());
  const dvec3 direction = glm::normalize(view.rayDirection(picked.pixel.x + 0.5, picked.pixel.y + 0.5));
  const auto hit = hitMirror(*frame.geometry, picked.seen.firstReflector, view.eye, direction);
  if (!hit) return picked;
  picked.reflectionPoint = view.eye + hit->distance * direction;
  // 3
  if (picked.seen.bounces != 1) return picked;
  const dvec3 mirrored = direction - 2.0 * glm::dot(direction, hit->normal) * hit->normal;
  const dvec3 way =
      picked.seen.isSky() ? dvec3(picked.seen.point) : dvec3(picked.seen.point) - *picked.reflectionPoint;
  if (glm::length(way) > 0)
    picked.lawErrorDegrees =
        glm::degrees(std::atan2(glm::length(glm::cross(mirrored, way)), glm::dot(mirrored, way)));
  return picked;
}

}  // namespace catoptric::viewer
