// SPDX-License-Identifier: Apache-2.0
#include "catoptric/sketch/zexel_sketch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "catoptric/core/tone_map.h"

namespace catoptric::sketch {
namespace {

using reflection_morphing::MirrorRays;
using reflection_morphing::ReflectedRay;

constexpr double kSkyLength = 1.0;  // metres of a ray into the sky that are drawn

/// The first mirror that a pixel of the middle row shows.
std::vector<ReflectedRay> listMirrorPixels(const MirrorRays& rays, const scene::CameraFrame& camera) {
  std::vector<ReflectedRay> found;
  ReflectedRay view;
  view.origin = camera.eye;
  for (int x = 0; x < camera.widthPx; ++x) {
    view.direction = glm::normalize(camera.rayDirection(x + 0.5, 0.5 * camera.heightPx));
    rays.follow(camera.eye, view.direction, 1, 1, [&](const ReflectedRay& ray) {
      if (rays.findObstacle(view) > ray.distance) found.push_back(ray);
    });
  }
  return found;
}

}  // namespace

const std::array<CubeFace, 6>& cubeFaces() {
  static const std::array<CubeFace, 6> kFaces{{{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                               {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                               {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                               {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                               {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
                                               {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}}};
  return kFaces;
}

scene::Camera makeFaceCamera(const dvec3& centre, const CubeFace& face) {
  scene::Camera camera;
  camera.eye = centre, camera.target = centre + face.forward, camera.up = face.up;
  camera.fovYRadians = glm::half_pi<double>();
  return camera;
}

Sketch sketchReflectionCell(const dvec3& centre, double edge, double reach,
                            const std::array<core::ImageRgba8, 6>& faces) {
  constexpr std::size_t kTop = 2, kBottom = 3;
  Sketch sketch;
  const double half = 0.5 * edge;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (f == kTop) continue;
    const CubeFace& face = cubeFaces()[f];
    const int n = faces[f].width();
    const auto at = [&](int x, int y) {
      return centre +
             half * (face.forward + (2.0 * x / n - 1.0) * face.right + (1.0 - 2.0 * y / n) * face.up);
    };
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        sketch.addFace(at(x, y), at(x + 1, y), at(x + 1, y + 1), faces[f].at(x, y));
        sketch.addFace(at(x, y), at(x + 1, y + 1), at(x, y + 1), faces[f].at(x, y));
      }
    for (int x = 0; x <= n && f != kBottom; ++x) {
      const dvec3 direction = glm::normalize(at(x, 0) + at(x, n) - 2.0 * centre);
      sketch.addDashes(centre, centre + reach * direction, 0.15 * edge, kGrey, 1.2f);
    }
  }
  sketch.addBox({centre - half, centre + half}, kBlack, 2.5f);
  sketch.addDot(centre, kBlack, 5);
  return sketch;
}

Sketch sketchMappedRays(const MirrorRays& rays, const scene::CameraFrame& camera, const dvec3& cellCentre,
                        int count) {
  Sketch sketch;
  const std::vector<ReflectedRay> mirrors = listMirrorPixels(rays, camera);
  const auto findEnd = [&](const ReflectedRay& ray) {
    const double length = rays.findObstacle(ray);
    return ray.origin + (std::isfinite(length) ? length : kSkyLength) * ray.direction;
  };
  for (int i = 0; i < count && !mirrors.empty(); ++i) {
    const ReflectedRay& ray = mirrors[std::size_t((i + 0.5) * double(mirrors.size()) / count)];
    ReflectedRay mapped = ray;
    mapped.origin = cellCentre;
    sketch.addLine(camera.eye, ray.origin, kGreen);
    sketch.addLine(ray.origin, findEnd(ray), kBlack);
    sketch.addLine(cellCentre, findEnd(mapped), kRed);
    sketch.addDot(findEnd(ray), kBlack, 5);
    sketch.addDot(findEnd(mapped), kRed, 5);
  }
  sketch.addDot(cellCentre, kRed, 5);
  return sketch;
}

Sketch sketchZexels(const depth_reflection_map::StoredImage& image, int step) {
  Sketch sketch;
  const depth_reflection_map::ReferenceCamera& camera = image.camera;
  for (int y = step / 2; y < camera.height; y += step)
    for (int x = step / 2; x < camera.width; x += step) {
      const std::size_t i = std::size_t(y) * std::size_t(camera.width) + std::size_t(x);
      const float disparity = std::bit_cast<float>(image.zexels[i].x);
      if (!(disparity > 0)) continue;  // the sky
      const dvec3 direction = camera.worldFromZexel * dvec3(x + 0.5, y + 0.5, 1.0);
      const vec4 radiance = glm::unpackHalf4x16(image.radiance[i]);
      sketch.addDot(camera.centre + direction / double(disparity), core::toneMap(vec4(vec3(radiance), 1.0f)),
                    2.5f);
    }
  const auto corner = [&](int x, int y) {
    return camera.centre + camera.worldFromZexel * dvec3(x * camera.width, y * camera.height, 1.0);
  };
  const dvec3 corners[] = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
  for (int k = 0; k < 4; ++k) {
    sketch.addLine(corners[k], corners[(k + 1) % 4], kOrange, 3);
    sketch.addLine(camera.centre, corners[k], kOrange, 1.2f);
  }
  sketch.addDot(camera.centre, kOrange, 7);
  return sketch;
}

std::size_t markExposures(const core::SeenImage& seen, const core::SeenImage& truth,
                          core::ImageRgba8& picture) {
  constexpr Colour kExposure{255, 0, 255, 255};
  std::size_t count = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const core::SeenPixel& pixel = seen.pixels()[i];
    if (!pixel.isMirror() || !pixel.isSky() || truth.pixels()[i].isSky()) continue;
    picture.pixels()[i] = kExposure;
    ++count;
  }
  return count;
}

}  // namespace catoptric::sketch
