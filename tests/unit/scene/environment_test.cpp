// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/environment.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "catoptric/core/error.h"
#include "catoptric/core/log.h"
#include "catoptric/core/parallel.h"
#include "catoptric/scene/environment_mips.h"
#include "catoptric/scene/environment_prefilter.h"
#include "catoptric/scene/shading.h"
#include "catoptric/scene/sky.h"

namespace catoptric::scene {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// The built-in sky at a quarter of its size: what is tested of it does not depend on that.
const Environment& sky() {
  static const Environment environment = makeEnvironment(makeSkyImage(512, 256));
  return environment;
}

core::ImageRgbF makeMap(int width, int height, const std::function<vec3(const dvec3&)>& radiance) {
  core::ImageRgbF map(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      map.at(x, y) = radiance(directionFromLatLong((x + 0.5) / width, (y + 0.5) / height));
  return map;
}

vec3 irradianceOverPi(const Environment& environment, const vec3& n) {
  const auto& c = environment.irradiance;
  return glsl::evaluateIrradiance(c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], n);
}

/// Integral over the sphere of radiance times weight(direction), texel by texel.
dvec3 integrate(const core::ImageRgbF& map, const std::function<double(const dvec3&)>& weight) {
  dvec3 sum(0);
  for (int y = 0; y < map.height(); ++y) {
    const double solidAngle =
        (std::cos(kPi * y / map.height()) - std::cos(kPi * (y + 1) / map.height())) * 2.0 * kPi / map.width();
    for (int x = 0; x < map.width(); ++x) {
      const dvec3 d = directionFromLatLong((x + 0.5) / map.width(), (y + 0.5) / map.height());
      sum += dvec3(map.at(x, y)) * (weight(d) * solidAngle);
    }
  }
  return sum;
}

dvec3 integrateIrradianceOverPi(const core::ImageRgbF& map, const dvec3& n) {
  return integrate(map, [&](const dvec3& d) { return std::max(glm::dot(d, n), 0.0) / kPi; });
}

std::vector<dvec3> someDirections() {
  std::vector<dvec3> directions;
  for (int i = 0; i < 40; ++i) {  // Fibonacci sphere
    const double y = 1.0 - 2.0 * (i + 0.5) / 40, phi = i * 2.399963;
    directions.emplace_back(std::sqrt(1.0 - y * y) * std::cos(phi), y,
                            std::sqrt(1.0 - y * y) * std::sin(phi));
  }
  return directions;
}

double luminance(const dvec3& c) {
  return glm::dot(c, dvec3(0.2126, 0.7152, 0.0722));
}

/// Collects warnings while it lives.
class Warnings {
 public:
  Warnings() {
    core::setLogCallback([this](core::LogLevel level, const std::string& line) {
      if (level == core::LogLevel::Warning) text += line + "\n";
    });
  }
  ~Warnings() { core::setLogCallback({}); }
  std::string text;
};

// --- directions

RC_GTEST_PROP(LatLong, DirectionAndMapAreInverse, ()) {
  const double u = *rc::gen::inRange(1, 9999) / 10000.0, v = *rc::gen::inRange(10, 9990) / 10000.0;
  const dvec3 d = directionFromLatLong(u, v);
  RC_ASSERT(std::abs(glm::length(d) - 1.0) < 1e-12);
  const vec2 uv = glsl::latLongFromDirection(vec3(d));
  RC_ASSERT(std::abs(uv.x - u) < 2e-4 / std::sin(kPi * v) * 0.01 + 1e-6);
  RC_ASSERT(std::abs(uv.y - v) < 1e-4);
}

TEST(LatLong, KnownDirections) {
  const auto expectNear = [](const dvec3& a, const dvec3& b) { EXPECT_LT(glm::distance(a, b), 1e-12); };
  expectNear(directionFromLatLong(0.5, 0.5), {0, 0, -1});
  expectNear(directionFromLatLong(0.75, 0.5), {1, 0, 0});
  expectNear(directionFromLatLong(0.25, 0.5), {-1, 0, 0});
  expectNear(directionFromLatLong(0.0, 0.5), {0, 0, 1});
  expectNear(directionFromLatLong(0.3, 0.0), {0, 1, 0});
}

TEST(LatLong, SamplingWrapsInUAndClampsInV) {
  core::ImageRgbF map(4, 2);
  for (int i = 0; i < 8; ++i) map.data()[i] = vec3(float(i));
  EXPECT_EQ(sampleLatLong(map, 0.125f, 0.25f).r, 0.0f);
  EXPECT_EQ(sampleLatLong(map, 0.875f, 0.75f).r, 7.0f);
  EXPECT_EQ(sampleLatLong(map, 0.0f, 0.0f).r, 1.5f);  // half of the first and the last texel of row 0
  EXPECT_EQ(sampleLatLong(map, 1.0f, 0.0f).r, 1.5f);
  EXPECT_EQ(sampleLatLong(map, -0.875f, 0.25f).r, sampleLatLong(map, 0.125f, 0.25f).r);
  EXPECT_EQ(sampleLatLong(map, 3.375f, 1.0f).r, 5.0f);
}

// --- a constant environment is constant in every way

TEST(Environment, ConstantStaysConstant) {
  const vec3 c(0.2f, 1.0f, 7.5f);
  const Environment environment = makeConstantEnvironment(c);
  for (const core::ImageRgbF& level : environment.radiance)
    for (const vec3& texel : level.pixels()) EXPECT_EQ(texel, c);
  ASSERT_EQ(environment.prefiltered.size(), std::size_t(kPrefilteredLevels));
  for (const core::ImageRgbF& level : environment.prefiltered)
    for (const vec3& texel : level.pixels()) EXPECT_LT(glm::length(texel - c), 1e-4f * glm::length(c));
  for (const dvec3& n : someDirections())
    EXPECT_LT(glm::length(irradianceOverPi(environment, vec3(n)) - c), 1e-3f * glm::length(c));
  const Environment black = makeConstantEnvironment(vec3(0));
  for (const vec3& texel : black.prefiltered[3].pixels()) EXPECT_EQ(texel, vec3(0));
}

// --- mip chain

TEST(Environment, MipChainHalvesDownToOneTexelAndKeepsTheMean) {
  for (const ivec2 size :
       {ivec2(64, 32), ivec2(7, 5), ivec2(1, 1), ivec2(1, 9), ivec2(100, 50), ivec2(13, 1)}) {
    core::ImageRgbF map(size.x, size.y);
    dvec3 mean(0);
    for (std::size_t i = 0; i < map.size(); ++i) {
      map.data()[i] = vec3(float(i * 37 % 101), float(i), 1.0f);
      mean += dvec3(map.data()[i]) / double(map.size());
    }
    const std::vector<core::ImageRgbF> levels = makeEnvironmentMips(map);
    EXPECT_EQ(levels[0].pixels(), map.pixels());
    for (std::size_t i = 1; i < levels.size(); ++i) {
      EXPECT_EQ(levels[i].width(), std::max(levels[i - 1].width() / 2, 1));
      EXPECT_EQ(levels[i].height(), std::max(levels[i - 1].height() / 2, 1));
    }
    ASSERT_EQ(levels.back().size(), 1u);
    EXPECT_LT(glm::distance(dvec3(levels.back().at(0, 0)), mean), 1e-4 * (1.0 + glm::length(mean)));
  }
}

TEST(Environment, MipTexelIsTheMeanOfFour) {
  core::ImageRgbF map(4, 2);
  for (int i = 0; i < 8; ++i) map.data()[i] = vec3(float(i * i));
  EXPECT_EQ(makeEnvironmentMips(map)[1].at(1, 0), vec3((4.0f + 9.0f + 36.0f + 49.0f) / 4.0f));
}

// --- irradiance

TEST(Environment, IrradianceOfSmoothLightIsExact) {
  // Nine coefficients hold every environment of degree two exactly.
  const core::ImageRgbF map = makeMap(256, 128, [](const dvec3& d) {
    return vec3(dvec3(1.0 + 0.5 * d.y + 0.2 * d.x * d.z, 1.0 - 0.6 * d.x + 0.1 * (3 * d.z * d.z - 1),
                      1.0 + 0.3 * d.z - 0.2 * d.x * d.y + 0.1 * d.y * d.z + 0.15 * (d.x * d.x - d.y * d.y)));
  });
  const Environment environment = makeEnvironment(map);
  for (const dvec3& n : someDirections())
    EXPECT_LT(glm::distance(dvec3(irradianceOverPi(environment, vec3(n))), integrateIrradianceOverPi(map, n)),
              1e-3);
}

TEST(Environment, IrradianceOfTheSkyIsNearTheIntegral) {
  for (const dvec3& n : someDirections()) {
    const double expected = luminance(integrateIrradianceOverPi(sky().radiance[1], n));
    const double actual = luminance(dvec3(irradianceOverPi(sky(), vec3(n))));
    EXPECT_NEAR(actual / expected, 1.0, 0.05) << n.x << " " << n.y << " " << n.z;
  }
}

// --- blurred copies

/// The definition, without samples: GGX around n, viewed from n, over every texel.
dvec3 integrateLobe(const core::ImageRgbF& map, const dvec3& n, double roughness) {
  const double alpha2 = std::pow(roughness, 4.0);
  const auto weight = [&](const dvec3& d) {
    const double cosine = glm::dot(d, n);
    if (cosine <= 0.0) return 0.0;
    const double cosHalf2 = 0.5 * (1.0 + cosine), t = cosHalf2 * (alpha2 - 1.0) + 1.0;
    return cosine * alpha2 / (t * t);  // n.l times the density of l, up to a constant
  };
  static const core::ImageRgbF white(256, 128, vec3(1));
  return integrate(map, weight) / integrate(white, weight);
}

TEST(Environment, BlurredCopiesMatchTheIntegral) {
  const core::ImageRgbF& map = sky().radiance[0];  // 512x256
  for (const int level : {2, 3, 5, 7}) {
    const core::ImageRgbF& blurred = sky().prefiltered[std::size_t(level)];
    double worst = 0, sum = 0;
    int count = 0;
    for (int y = 3; y < blurred.height(); y += 14)
      for (int x = 5; x < blurred.width(); x += 37, ++count) {
        const dvec3 n = directionFromLatLong((x + 0.5) / blurred.width(), (y + 0.5) / blurred.height());
        const double expected = luminance(integrateLobe(map, n, level / double(kPrefilteredLevels - 1)));
        const double error = std::abs(luminance(dvec3(blurred.at(x, y))) / expected - 1.0);
        worst = std::max(worst, error);
        sum += error;
      }
    EXPECT_LT(worst, 0.10) << "level " << level;
    EXPECT_LT(sum / count, 0.02) << "level " << level;
  }
}

TEST(Environment, LevelZeroIsAReducedCopy) {
  const core::ImageRgbF& reduced = sky().prefiltered[0];
  ASSERT_EQ(reduced.width(), kPrefilteredWidth);
  EXPECT_EQ(reduced.pixels(), sky().radiance[2].pixels());
}

TEST(Environment, BrightSpotStaysInItsDirection) {
  for (const dvec3& n : {glm::normalize(dvec3(0.3, 0.4, -0.8)), glm::normalize(dvec3(0.1, -0.5, 0.9)),
                         glm::normalize(dvec3(-0.9, 0.1, 0.2))}) {
    const Environment environment = makeEnvironment(
        makeMap(256, 128, [&](const dvec3& d) { return vec3(glm::dot(d, n) > 0.995 ? 100.0f : 0.1f); }));
    for (std::size_t level = 0; level < environment.prefiltered.size(); ++level) {
      const core::ImageRgbF& map = environment.prefiltered[level];
      dvec3 centre(0);
      for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) {
          const dvec3 d = directionFromLatLong((x + 0.5) / map.width(), (y + 0.5) / map.height());
          centre += d * double(map.at(x, y).r - 0.1f) * std::sqrt(1.0 - d.y * d.y);
        }
      EXPECT_GT(glm::dot(glm::normalize(centre), n), 0.999) << "level " << level;
    }
    EXPECT_GT(irradianceOverPi(environment, vec3(n)).r, 5.0f * irradianceOverPi(environment, vec3(-n)).r);
  }
}

// --- the built-in sky

/// By how much the step across u = 0 exceeds the largest step between neighbours near it; worst row. `width`
/// is how much of the map is used.
float measureSeam(const core::ImageRgbF& map, int width) {
  constexpr int kNear = 12;
  float worst = -1.0f;
  for (int y = 0; y < map.height(); ++y) {
    float nearby = 0;
    for (int x = 0; x < kNear; ++x) {
      nearby = std::max(nearby, glm::distance(map.at(x, y), map.at(x + 1, y)));
      nearby = std::max(nearby, glm::distance(map.at(width - 1 - x, y), map.at(width - 2 - x, y)));
    }
    worst = std::max(worst, glm::distance(map.at(width - 1, y), map.at(0, y)) - 1.5f * nearby);
  }
  return worst;
}

TEST(Sky, HasNoSeam) {
  const core::ImageRgbF map = makeSkyImage(2048, 1024);
  EXPECT_LT(measureSeam(map, map.width()), 0.005f);
  EXPECT_GT(measureSeam(map, map.width() - 40), 0.05f);  // the measure finds one where there is one
}

TEST(Sky, ExposesAWhiteFloorWell) {
  const double floor = luminance(dvec3(irradianceOverPi(sky(), vec3(0, 1, 0))));
  EXPECT_GT(floor, 0.7);
  EXPECT_LT(floor, 0.9);
  float peak = 0;
  for (const vec3& texel : sky().radiance[0].pixels()) {
    ASSERT_TRUE(texel.r > 0 && texel.g > 0 && texel.b > 0 && std::isfinite(texel.r + texel.g + texel.b));
    peak = std::max({peak, texel.r, texel.g, texel.b});
  }
  EXPECT_LT(peak, 64.0f);
  EXPECT_GT(peak, 20.0f);
}

TEST(Sky, TheEnvironmentIsMadeOfIt) {
  const Environment environment = makeSkyEnvironment();
  EXPECT_EQ(environment.radiance[0].pixels(), makeSkyImage(2048, 1024).pixels());
  EXPECT_EQ(environment.radiance.size(), 12u);
  EXPECT_LT(
      glm::distance(irradianceOverPi(environment, vec3(0, 1, 0)), irradianceOverPi(sky(), vec3(0, 1, 0))),
      0.01f);
}

TEST(Sky, TheSunIsWhereItIsSaidToBe) {
  const core::ImageRgbF& map = sky().radiance[0];
  dvec3 brightest(0);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      if (map.at(x, y).g > 30.0f)
        brightest += directionFromLatLong((x + 0.5) / map.width(), (y + 0.5) / map.height());
  EXPECT_GT(glm::dot(glm::normalize(brightest), skySunDirection()), 0.9999);
}

TEST(Sky, IsTheSameOnAnyNumberOfThreads) {
  const core::ImageRgbF both = makeSkyImage(128, 64);
  core::setThreadCount(1);
  const core::ImageRgbF one = makeSkyImage(128, 64);
  const Environment environmentOne = makeEnvironment(one);
  core::setThreadCount(0);
  const Environment environmentBoth = makeEnvironment(both);
  EXPECT_EQ(one.pixels(), both.pixels());
  for (std::size_t i = 0; i < environmentOne.prefiltered.size(); ++i)
    EXPECT_EQ(environmentOne.prefiltered[i].pixels(), environmentBoth.prefiltered[i].pixels());
  EXPECT_EQ(environmentOne.irradiance, environmentBoth.irradiance);
}

// --- bad input

TEST(Environment, TooBrightIsCappedWithBothValuesSaid) {
  Warnings warnings;
  core::ImageRgbF map(8, 4, vec3(1));
  map.at(3, 1) = vec3(2e5f, 70000.0f, 3.0f);
  const Environment environment = makeEnvironment(map);
  EXPECT_EQ(environment.radiance[0].at(3, 1), vec3(65504.0f, 65504.0f, 3.0f));
  EXPECT_NE(warnings.text.find("200000"), std::string::npos) << warnings.text;
  EXPECT_NE(warnings.text.find("65504"), std::string::npos) << warnings.text;
}

TEST(Environment, WhatIsNoNumberBecomesBlackWithAWarning) {
  Warnings warnings;
  core::ImageRgbF map(8, 4, vec3(1));
  map.at(0, 0).g = std::numeric_limits<float>::quiet_NaN();
  map.at(1, 0).r = std::numeric_limits<float>::infinity();
  map.at(2, 0).b = -1.0f;
  const Environment environment = makeEnvironment(map);
  EXPECT_EQ(environment.radiance[0].at(0, 0), vec3(0));
  EXPECT_EQ(environment.radiance[0].at(1, 0), vec3(0));
  EXPECT_EQ(environment.radiance[0].at(2, 0), vec3(1, 1, 0));
  EXPECT_NE(warnings.text.find("2 pixels are not finite"), std::string::npos) << warnings.text;
  EXPECT_NE(warnings.text.find("1 pixels are negative"), std::string::npos) << warnings.text;
  for (const core::ImageRgbF& level : environment.prefiltered)
    for (const vec3& texel : level.pixels()) ASSERT_TRUE(std::isfinite(texel.r + texel.g + texel.b));
}

TEST(Environment, NothingIsRefused) {
  EXPECT_THROW((void)makeEnvironment(core::ImageRgbF()), core::Error);
  EXPECT_THROW((void)readEnvironment("no/such/file.hdr"), core::Error);
}

TEST(Environment, RealPanoramasStayInTheRangeOfHalfFloats) {
  const char* assets = std::getenv("CATOPTRIC_ASSETS");
  if (!assets) GTEST_SKIP() << "CATOPTRIC_ASSETS is not set";
  const std::filesystem::path file = std::filesystem::path(assets) / "env" / "venice_sunset_1k.hdr";
  const Environment environment = readEnvironment(file);
  const double up = luminance(dvec3(irradianceOverPi(environment, vec3(0, 1, 0))));
  EXPECT_NEAR(up / luminance(integrateIrradianceOverPi(environment.radiance[1], {0, 1, 0})), 1.0, 0.1);
  for (const core::ImageRgbF& level : environment.prefiltered)
    for (const vec3& texel : level.pixels()) ASSERT_TRUE(std::max({texel.r, texel.g, texel.b}) <= 65504.0f);
}

}  // namespace
}  // namespace catoptric::scene
