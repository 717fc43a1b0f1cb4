// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "catoptric/core/error.h"
#include "catoptric/core/image_io.h"
#include "catoptric/core/log.h"
#include "catoptric/core/parallel.h"
#include "catoptric/scene/environment_mips.h"
#include "catoptric/scene/environment_prefilter.h"
#include "catoptric/scene/sky.h"

namespace catoptric::scene {
namespace {

constexpr float kLargestHalf = 65504.0f;  // renderers keep the map as half floats

struct Repairs {
  std::size_t notFinite = 0, negative = 0, tooBright = 0;
  float peak = 0;  ///< before the cap

  void add(const Repairs& other) {
    notFinite += other.notFinite;
    negative += other.negative;
    tooBright += other.tooBright;
    peak = std::max(peak, other.peak);
  }
};

void repairPixel(vec3& pixel, Repairs& repairs) {
  if (!std::isfinite(pixel.r) || !std::isfinite(pixel.g) || !std::isfinite(pixel.b)) {
    ++repairs.notFinite;
    pixel = vec3(0);
    return;
  }
  const float largest = std::max({pixel.r, pixel.g, pixel.b});
  repairs.peak = std::max(repairs.peak, largest);
  if (largest > kLargestHalf) ++repairs.tooBright;
  if (std::min({pixel.r, pixel.g, pixel.b}) < 0.0f) ++repairs.negative;
  pixel = glm::clamp(pixel, vec3(0), vec3(kLargestHalf));
}

/// Makes every pixel finite, not negative and at most kLargestHalf, and says so.
void repairRadiance(core::ImageRgbF& map) {
  std::mutex mutex;
  Repairs total;
  core::parallelFor(map.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    Repairs repairs;
    for (std::size_t i = begin; i < end; ++i) repairPixel(map.data()[i], repairs);
    const std::lock_guard lock(mutex);
    total.add(repairs);
  });
  if (total.notFinite > 0)
    core::logWarningOnce(
        fmt::format("environment: {} pixels are not finite numbers; they are now 0", total.notFinite));
  if (total.negative > 0)
    core::logWarningOnce(fmt::format("environment: {} pixels are negative; they are now 0", total.negative));
  if (total.tooBright > 0)
    core::logWarningOnce(fmt::format("environment: peak radiance was {:g}, is now {:g} ({} pixels)",
                                     total.peak, kLargestHalf, total.tooBright));
}

}  // namespace

Environment makeSkyEnvironment() {
  return makeEnvironment(makeSkyImage(2048, 1024));
}

Environment makeConstantEnvironment(const vec3& radiance) {
  return makeEnvironment(core::ImageRgbF(4, 2, radiance));
}

Environment readEnvironment(const std::filesystem::path& path) {
  core::ImageRgbF map = core::readRadianceImage(path);
  if (map.width() != 2 * map.height())
    core::logWarningOnce(
        fmt::format("environment '{}' is {}x{}, not twice as wide as high; it is stretched over the "
                    "whole sphere",
                    path.string(), map.width(), map.height()));
  return makeEnvironment(std::move(map));
}

Environment makeEnvironment(core::ImageRgbF latitudeLongitude) {
  if (latitudeLongitude.isEmpty())
    throw core::Error("environment.empty", "the environment image has no pixels");
  repairRadiance(latitudeLongitude);
  Environment environment;
  environment.radiance = makeEnvironmentMips(std::move(latitudeLongitude));
  environment.prefiltered = prefilterEnvironment(environment.radiance, kPrefilteredLevels);
  environment.irradiance = projectIrradiance(environment.radiance);
  return environment;
}

}  // namespace catoptric::scene
