// SPDX-License-Identifier: Apache-2.0
// A picture test: a scene drawn by a raster method and by the ray tracer, compared as 8-bit pictures.
#pragma once

#include <string>

#include "catoptric/metrics/image_difference.h"
#include "catoptric/renderer/frame.h"

namespace catoptric::image_test {

inline constexpr int kSizePx = 256;

/// What a picture may differ from the truth by, on a scale of 0 to 255, and why.
struct Limits {
  double largest;  ///< of any channel, of means over 5x5 pixels: an edge that falls to the other side of one
                   ///< pixel's centre counts little there, a hole, a seam or a leak counts whole
  double mean;     ///< of all channels and pixels
  const char* reason;
};

struct Subject {
  std::string name;
  const scene::Scene& scene;
  const scene::WorldGeometry& world;
  scene::Camera camera;
  int bounces = 1;
  renderer::Solver solver = renderer::Solver::Auto;
  bool allParts = false;  ///< FrameOptions::allParts
};

/// Expects the raster picture of `subject` to keep the limits, and that of `twin`, its world with a fault in
/// a normal or plane, to break them. A picture that does not keep them leaves NAME.actual.png, .expected.png
/// and .difference.png in the build folder.
void expectWithin(const Subject& subject, const scene::WorldGeometry& twin, const Limits& limits);

/// Compares two pictures as expectWithin() does.
[[nodiscard]] bool isWithin(const std::string& name, const core::ImageRgba8& actual,
                            const core::ImageRgba8& expected, const Limits& limits);
[[nodiscard]] core::ImageRgba8 draw(const Subject& subject, const scene::WorldGeometry& world,
                                    renderer::Method method, int sizePx = kSizePx);

void writeFailure(const std::string& name, const core::ImageRgba8& actual, const core::ImageRgba8& expected);

[[nodiscard]] const scene::Environment& sky();

/// `world` with the vertex normals of all curved reflectors turned by `radians` about the x axis.
[[nodiscard]] scene::WorldGeometry withTurnedNormals(scene::WorldGeometry world, double radians);
/// `world` with the planes of all flat reflectors turned by `radians` about an axis in the plane, about their
/// centres.
[[nodiscard]] scene::WorldGeometry withTurnedPlanes(scene::WorldGeometry world, double radians);

}  // namespace catoptric::image_test
