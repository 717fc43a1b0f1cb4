// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/reference_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::depth_reflection_map {

MirrorWindow makeMirrorWindow(const scene::WorldGeometry& world, std::uint32_t reflector, double brightSide) {
  const scene::Reflector& mirror = world.reflectors[reflector];
  MirrorWindow window;
  window.forward = brightSide * mirror.plane.normal;
  const dvec3 upright = std::abs(window.forward.y) < 0.99 ? dvec3(0, 1, 0) : dvec3(0, 0, 1);
  window.right = glm::normalize(glm::cross(window.forward, upright));
  window.up = glm::cross(window.right, window.forward);
  dvec2 lower(std::numeric_limits<double>::max()), upper(-lower);
  const scene::Part& part = world.parts[mirror.part];
  for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v) {
    const dvec3 offset = dvec3(world.positions[v]) - mirror.centre;
    const dvec2 p(glm::dot(offset, window.right), glm::dot(offset, window.up));
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  const dvec2 middle = 0.5 * (lower + upper);
  window.centre = mirror.centre + middle.x * window.right + middle.y * window.up;
  window.centre -= mirror.plane.signedDistance(window.centre) * mirror.plane.normal;
  window.half = glm::max(0.5 * (upper - lower), dvec2(1e-6));
  return window;
}

raster::PinholeView ReferenceCamera::makeView() const {
  raster::PinholeView view;
  view.eye = centre;
  view.rayDx = worldFromZexel[0];
  view.rayDy = worldFromZexel[1];
  view.rayOrigin = worldFromZexel[2];
  // zexel (x, y, 1) / d -> clip space: 2 x / width - 1, 2 y / height - 1, and d = 1 on the near plane.
  const dmat3 zexelFromWorld = glm::inverse(worldFromZexel);
  const dmat3 ndcFromZexel(dvec3(2.0 / width, 0, 0), dvec3(0, 2.0 / height, 0), dvec3(-1, -1, 1));
  const dmat3 linear = ndcFromZexel * zexelFromWorld;
  for (int column = 0; column < 3; ++column)
    view.clipFromWorld[column] =
        dvec4(linear[column].x, linear[column].y, linear[column].z, linear[column].z);
  const dvec3 moved = -(linear * centre);
  view.clipFromWorld[3] = dvec4(moved.x, moved.y, moved.z - 2.0, moved.z);
  return view;
}

ReferenceCamera makeReferenceCamera(const MirrorWindow& window, const dvec3& centre, double margin,
                                    int size) {
  ReferenceCamera camera;
  const dvec2 half = window.half + margin;
  camera.centre = centre;
  camera.forward = window.forward;
  camera.planeDistance = glm::dot(window.centre - centre, window.forward);
  // Square zexels; the longer side has `size` of them.
  const double edge = 2.0 * std::max(half.x, half.y) / size;
  camera.width = std::max(1, int(std::lround(2.0 * half.x / edge)));
  camera.height = std::max(1, int(std::lround(2.0 * half.y / edge)));
  camera.worldFromZexel[0] = window.right * (2.0 * half.x / camera.width);
  camera.worldFromZexel[1] = window.up * (2.0 * half.y / camera.height);
  camera.worldFromZexel[2] = window.centre - half.x * window.right - half.y * window.up - centre;
  return camera;
}

namespace {

/// Point i of n on the unit hemisphere, each with the same area around it.
dvec3 pointOfHemisphere(const MirrorWindow& window, int i, int n) {
  constexpr double kLowest = 0.1, kGolden = 2.399963229728653;  // golden angle, radians
  const double z = 1.0 - (1.0 - kLowest) * (i + 0.5) / n;
  const double r = std::sqrt(1.0 - z * z), angle = kGolden * i;
  return r * std::cos(angle) * window.right + r * std::sin(angle) * window.up - z * window.forward;
}

}  // namespace

Hemisphere makeHemisphere(const MirrorWindow& window, double radius, int count, const core::Box* room) {
  const auto isWithin = [&](const dvec3& point) {
    const dvec3 eye = point - 2.0 * glm::dot(point - window.centre, window.forward) * window.forward;
    return !room || (glm::all(glm::greaterThanEqual(eye, room->lower)) &&
                     glm::all(glm::lessThanEqual(eye, room->upper)));
  };
  const auto take = [&](int n) {
    std::vector<dvec3> points;
    for (int i = 0; i < n; ++i)
      if (const dvec3 p = window.centre + radius * pointOfHemisphere(window, i, n); isWithin(p))
        points.push_back(p);
    return points;
  };
  constexpr int kTrial = 4096, kLeast = kTrial / 100;
  const int inside = room ? int(take(kTrial).size()) : kTrial;
  if (inside < kLeast) return makeHemisphere(window, radius, count);
  const double share = double(inside) / kTrial;
  Hemisphere hemisphere{take(int(std::lround(count / share))),
                        radius * std::sqrt(2.0 * glm::pi<double>() * share / count)};
  if (hemisphere.centres.empty()) return makeHemisphere(window, radius, count);
  return hemisphere;
}

}  // namespace catoptric::depth_reflection_map
