// SPDX-License-Identifier: Apache-2.0
#include "viewer/dragging.h"

#include <algorithm>

#include "catoptric/scene/camera_frame.h"
#include "viewer/triangle_hit.h"

namespace catoptric::viewer {
namespace {

constexpr int kUnitPx = 1 << 16;  // a picture of this height stands for shares

scene::CameraFrame makeFrame(const scene::Camera& camera, double aspect) {
  return scene::makeCameraFrame(camera, std::max(1, int(kUnitPx * aspect)), kUnitPx);
}

}  // namespace

std::optional<Grabbed> findObjectAt(const scene::WorldGeometry& world, const scene::Camera& camera,
                                    const dvec2& at, double aspect) {
  const scene::CameraFrame frame = makeFrame(camera, aspect);
  const dvec3 direction = frame.rayDirection(at.x * frame.widthPx, at.y * frame.heightPx);
  std::optional<Grabbed> nearest;
  double distance = 0;
  for (std::size_t t = 0; t < world.triangleCount(); ++t) {
    const auto hit = hitTriangle(world, 3 * t, frame.eye, direction);
    if (!hit || (nearest && hit->distance >= distance)) continue;
    const scene::Part& part = world.parts[world.triangleParts[t]];
    if (!hit->isFront && !part.isSeenFromBehind) continue;
    distance = hit->distance;
    nearest = Grabbed{part.object, part.material, frame.eye + distance * direction};
  }
  return nearest;
}

dvec3 findDrag(const scene::Camera& camera, const dvec3& point, const dvec2& mousePx, int heightPx) {
  const scene::CameraFrame frame = makeFrame(camera, 1);
  const double depth = glm::dot(point - frame.eye, frame.forward);
  const double perPixel = 2.0 * depth * frame.tanHalfFovY / std::max(heightPx, 1);
  return (mousePx.x * frame.right - mousePx.y * frame.up) * perPixel;
}

std::optional<std::array<dvec2, 8>> findBoxInPicture(const scene::WorldGeometry& world,
                                                     std::uint32_t instance, const dvec3& shift,
                                                     const scene::Camera& camera, double aspect) {
  core::Box box;
  for (const scene::Part& part : world.parts)
    if (part.object == instance)
      for (std::uint32_t v = 0; v < part.vertexCount; ++v)
        box.add(dvec3(world.positions[part.firstVertex + v]));
  if (box.isEmpty()) return std::nullopt;
  const scene::CameraFrame frame = makeFrame(camera, aspect);
  std::array<dvec2, 8> corners;
  for (std::size_t k = 0; k < 8; ++k) {
    const dvec3 corner((k & 1) != 0 ? box.upper.x : box.lower.x, (k & 2) != 0 ? box.upper.y : box.lower.y,
                       (k & 4) != 0 ? box.upper.z : box.lower.z);
    const dvec3 offset = corner + shift - frame.eye;
    const double depth = glm::dot(offset, frame.forward);
    if (depth <= 1e-6 * glm::length(offset)) return std::nullopt;
    const double half = depth * frame.tanHalfFovY;
    corners[k] = {0.5 + 0.5 * glm::dot(offset, frame.right) / (half * aspect),
                  0.5 - 0.5 * glm::dot(offset, frame.up) / half};
  }
  return corners;
}

}  // namespace catoptric::viewer
