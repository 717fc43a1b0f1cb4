// SPDX-License-Identifier: Apache-2.0
// Displacement on made-up views whose answer is known: a smooth surface seen through a mirror that fills the
// picture.
#include "catoptric/metrics/displacement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace catoptric::metrics {
namespace {

constexpr int kWidth = 96, kHeight = 80;

struct View {
  core::SeenImage seen{kWidth, kHeight};
  core::FootprintImage footprints{kWidth, kHeight};
};

/// The world point that is seen at image position (x, y); smooth.
using Surface = std::function<dvec3(double x, double y)>;

dvec3 bentSurface(double x, double y) {
  return {0.02 * x + 0.0001 * y * y, 0.03 * y, 5.0 + 0.3 * std::sin(0.05 * x) + 0.0002 * x * y};
}

View makeView(const Surface& surface, double shiftX = 0, double shiftY = 0) {
  View view;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double u = x - shiftX, v = y - shiftY;  // content moves by +shift
      core::SeenPixel& pixel = view.seen.at(x, y);
      pixel.point = vec3(surface(u, v));
      pixel.object = 3;
      pixel.triangle = 0;
      pixel.firstReflector = 0;
      pixel.bounces = 1;
      const double h = 1e-3;
      view.footprints.at(x, y) = {vec3((surface(u + h, v) - surface(u - h, v)) / (2 * h)),
                                  vec3((surface(u, v + h) - surface(u, v - h)) / (2 * h))};
    }
  return view;
}

/// Displacement where the picture's border is far enough away.
float atCentre(const DisplacementResult& result) {
  return result.displacementPx.at(kWidth / 2, kHeight / 2);
}

TEST(Displacement, IdenticalViewsGiveZeroEverywhere) {
  const View truth = makeView(bentSurface);
  const auto result = computeDisplacement(truth.seen, truth.seen, truth.footprints);
  for (const float value : result.displacementPx.pixels()) EXPECT_EQ(value, 0.0f);
  EXPECT_EQ(result.mirrorPixels.pixels, std::uint64_t(kWidth * kHeight));
  EXPECT_EQ(result.objectPixels.pixels, std::uint64_t(kWidth * kHeight));
  EXPECT_EQ(result.mirrorPixels.medianPx, 0);
  EXPECT_EQ(result.mirrorPixels.p95Px, 0);
  EXPECT_EQ(result.mirrorPixels.shareWithin1Px, 1);
  EXPECT_EQ(result.mirrorPixels.shareLost, 0);
}

TEST(Displacement, ShiftByWholePixels) {
  const View truth = makeView(bentSurface);
  for (const int shift : {1, 2, 3, 7, 15, 23}) {
    const View moved = makeView(bentSurface, shift, 0);
    const auto result = computeDisplacement(moved.seen, truth.seen, truth.footprints);
    for (int y = 0; y < kHeight; ++y)
      for (int x = shift; x < kWidth; ++x)
        ASSERT_NEAR(result.displacementPx.at(x, y), shift, 1e-3) << x << "," << y;
    EXPECT_NEAR(atCentre(result), shift, 1e-3);
  }
}

TEST(Displacement, ShiftByFractionsOfAPixelInBothDirections) {
  const View truth = makeView(bentSurface);
  for (const dvec2 shift :
       {dvec2(0.1, 0), dvec2(0.5, 0.5), dvec2(-0.25, 0.4), dvec2(3.3, -4.6), dvec2(0, 10.5)}) {
    const View moved = makeView(bentSurface, shift.x, shift.y);
    const auto result = computeDisplacement(moved.seen, truth.seen, truth.footprints);
    EXPECT_NEAR(atCentre(result), glm::length(shift), 0.01) << shift.x << "," << shift.y;
  }
}

TEST(Displacement, WhatIsFartherThan24PixelsIsLost) {
  const View truth = makeView(bentSurface);
  const View moved = makeView(bentSurface, 25, 0);
  const auto result = computeDisplacement(moved.seen, truth.seen, truth.footprints);
  EXPECT_EQ(atCentre(result), kLostPx);
  EXPECT_EQ(result.mirrorPixels.shareLost, 1);
  EXPECT_EQ(result.mirrorPixels.medianPx, kLostPx);
}

TEST(Displacement, SamePointOfAnotherObjectIsLost) {
  const View truth = makeView(bentSurface);
  View other = truth;
  for (auto& pixel : other.seen.pixels()) pixel.object = 4;
  const auto result = computeDisplacement(other.seen, truth.seen, truth.footprints);
  EXPECT_EQ(result.mirrorPixels.shareLost, 1);
}

TEST(Displacement, PointOffTheSurfaceIsLost) {
  const View truth = makeView(bentSurface);
  View lifted = truth;
  for (auto& pixel : lifted.seen.pixels()) pixel.point.z += 0.5f;  // a footprint is 0.02 to 0.03
  EXPECT_EQ(computeDisplacement(lifted.seen, truth.seen, truth.footprints).mirrorPixels.shareLost, 1);
}

TEST(Displacement, TruthPixelsThatAreNoMirrorDoNotCount) {
  View truth = makeView(bentSurface);
  const View method = truth;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth / 2; ++x) truth.seen.at(x, y).firstReflector = core::kNoId;
  const auto result = computeDisplacement(method.seen, truth.seen, truth.footprints);
  EXPECT_EQ(result.displacementPx.at(10, 10), kLostPx);
  EXPECT_EQ(result.displacementPx.at(kWidth - 10, 10), 0);
}

TEST(Displacement, PixelsOfTheMethodThatAreNoMirrorAreLeftOut) {
  const View truth = makeView(bentSurface);
  View method = truth;
  method.seen.at(5, 6).firstReflector = core::kNoId;
  const auto result = computeDisplacement(method.seen, truth.seen, truth.footprints);
  EXPECT_EQ(result.displacementPx.at(5, 6), -1.0f);
  EXPECT_EQ(result.mirrorPixels.pixels, std::uint64_t(kWidth * kHeight - 1));
}

TEST(Displacement, SkyIsComparedByDirection) {
  const Surface sky = [](double x, double y) { return glm::normalize(dvec3(0.002 * x, 0.002 * y, -1)); };
  View truth = makeView(sky);
  View moved = makeView(sky, 2.5, 0);
  for (View* view : {&truth, &moved})
    for (auto& pixel : view->seen.pixels()) {
      pixel.object = core::kNoId;
      pixel.pathLength = std::numeric_limits<float>::infinity();
    }
  EXPECT_NEAR(atCentre(computeDisplacement(moved.seen, truth.seen, truth.footprints)), 2.5, 0.01);
  for (auto& pixel : moved.seen.pixels()) pixel.object = 3;  // an object at the same numbers is not the sky
  EXPECT_EQ(atCentre(computeDisplacement(moved.seen, truth.seen, truth.footprints)), kLostPx);
}

TEST(Displacement, FootprintsWithoutLengthAreFilledUpToThePrecisionOfAPoint) {
  const Surface point = [](double, double) { return dvec3(10, 20, 30); };
  const View truth = makeView(point);
  View method = truth;
  for (auto& pixel : method.seen.pixels()) pixel.point.z = std::nextafter(pixel.point.z, 100.0f);
  EXPECT_LT(atCentre(computeDisplacement(method.seen, truth.seen, truth.footprints)), 0.5f);
  for (auto& pixel : method.seen.pixels()) pixel.point.z = 30.001f;
  EXPECT_EQ(atCentre(computeDisplacement(method.seen, truth.seen, truth.footprints)), kLostPx);
}

TEST(Displacement, ParallelFootprintAxesStillMeasure) {  // a floor seen edge-on
  const Surface line = [](double x, double y) { return dvec3(0.02 * x + 0.001 * y, 0, 5); };
  const View truth = makeView(line);
  const View moved = makeView(line, 1.5, 0);
  const float value = atCentre(computeDisplacement(moved.seen, truth.seen, truth.footprints));
  EXPECT_LE(value, 1.51f);  // moving up also moves along the line, a little
  EXPECT_GT(value, 1.0f);
}

TEST(Displacement, NumbersThatAreNotFiniteMatchNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  const View truth = makeView(bentSurface);
  View broken = truth;
  for (auto& pixel : broken.seen.pixels()) pixel.point.x = nan;
  EXPECT_EQ(computeDisplacement(broken.seen, truth.seen, truth.footprints).mirrorPixels.shareLost, 1);
  for (const float bad : {nan, infinity}) {
    View badTruth = truth;
    for (auto& footprint : badTruth.footprints.pixels()) footprint.dPdx.x = bad;
    EXPECT_EQ(computeDisplacement(truth.seen, badTruth.seen, badTruth.footprints).mirrorPixels.shareLost, 1);
  }
}

TEST(Displacement, EmptyPicturesHaveEmptyStatistics) {
  const auto nothing = computeDisplacement({}, {}, {});
  EXPECT_EQ(nothing.mirrorPixels.pixels, 0u);
  View blank = makeView(bentSurface);
  for (auto& pixel : blank.seen.pixels()) pixel.firstReflector = core::kNoId;
  const auto result = computeDisplacement(blank.seen, blank.seen, blank.footprints);
  EXPECT_EQ(result.mirrorPixels.pixels, 0u);
  EXPECT_EQ(result.falseCoverage, 0);
}

TEST(Displacement, ObjectPixelsAndCoverage) {
  View truth = makeView(bentSurface);
  for (auto& pixel : truth.seen.pixels()) pixel.shell = 1;
  View method = truth;
  for (int x = 0; x < 10; ++x) method.seen.at(x, 0).shell = 0;  // the method shows objects on ten wall pixels
  for (int x = 0; x < 30; ++x) truth.seen.at(x, 1).shell = 0;   // and misses thirty
  for (int x = 40; x < 45; ++x) method.seen.at(x, 2).shell = truth.seen.at(x, 2).shell = 0;
  const auto result = computeDisplacement(method.seen, truth.seen, truth.footprints);
  EXPECT_EQ(result.objectPixels.pixels, 45u);
  EXPECT_DOUBLE_EQ(result.falseCoverage, 10.0 / (kWidth * kHeight));
  EXPECT_DOUBLE_EQ(result.missedCoverage, 30.0 / (kWidth * kHeight));
}

TEST(Displacement, QuantilesOfAMixture) {
  const View truth = makeView(bentSurface);
  View method = truth;
  const View moved = makeView(bentSurface, 3, 0);
  for (int y = 0; y < kHeight; ++y)  // the right-hand quarter is 3 px off
    for (int x = kWidth * 3 / 4; x < kWidth; ++x) method.seen.at(x, y) = moved.seen.at(x, y);
  const auto statistics = computeDisplacement(method.seen, truth.seen, truth.footprints).mirrorPixels;
  EXPECT_EQ(statistics.medianPx, 0);
  EXPECT_NEAR(statistics.p95Px, 3, 1e-3);
  EXPECT_NEAR(statistics.meanPx, 0.75, 1e-3);
  EXPECT_DOUBLE_EQ(statistics.shareWithin1Px, 0.75);
  EXPECT_DOUBLE_EQ(statistics.shareWithin2Px, 0.75);
}

// A disc before a wall, shifted by less than a quarter of a pixel: pixels that just became covered by the
// disc show points of it that lie almost a pixel away from the truth's nearest pixel on the disc.
TEST(Displacement, SilhouettesOfASlightlyShiftedPictureAreNotLost) {
  const auto makeDisc = [](double shiftX, double shiftY) {
    View view = makeView([](double x, double y) { return dvec3(0.1 * x, 0.1 * y, 9); }, shiftX, shiftY);
    const View disc =
        makeView([](double x, double y) { return dvec3(0.05 * x, 0.05 * y, 4); }, shiftX, shiftY);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (std::hypot(x - shiftX - 48, y - shiftY - 40) < 20.3) {
          view.seen.at(x, y) = disc.seen.at(x, y);
          view.seen.at(x, y).object = 9;
          view.footprints.at(x, y) = disc.footprints.at(x, y);
        }
    return view;
  };
  const View truth = makeDisc(0, 0), moved = makeDisc(0.12, 0.05);
  const auto result = computeDisplacement(moved.seen, truth.seen, truth.footprints);
  EXPECT_NEAR(result.mirrorPixels.p95Px, 0.13, 1e-3);
  EXPECT_LT(result.mirrorPixels.shareLost,
            2e-4);  // a corner of the disc's outline may be seen by one of them only
}

/// The definition, written down a second time without tiles.
double findPlainly(const core::SeenPixel& shown, int px, int py, const View& truth) {
  double best = kLostPx, widest = kLostPx;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const core::SeenPixel& pixel = truth.seen.at(x, y);
      if (pixel.object != shown.object || !pixel.isMirror()) continue;
      const dvec3 u(truth.footprints.at(x, y).dPdx), v(truth.footprints.at(x, y).dPdy);
      const dvec3 d = dvec3(shown.point) - dvec3(pixel.point);
      // Dual basis of the two axes: a = u* . d, b = v* . d.
      const dvec3 n = glm::cross(u, v);
      const double a = glm::dot(glm::cross(v, n), d) / glm::dot(n, n);
      const double b = glm::dot(glm::cross(n, u), d) / glm::dot(n, n);
      const double off = std::abs(glm::dot(n, d)) / glm::length(n);
      if (std::abs(a) > 1 || std::abs(b) > 1 || off > 0.75 * std::sqrt(glm::length(n))) continue;
      widest = std::min(widest, std::hypot(x + a - px, y + b - py));
      if (std::abs(a) <= 0.75 && std::abs(b) <= 0.75)
        best = std::min(best, std::hypot(x + a - px, y + b - py));
    }
  return best < kLostPx ? best : widest;
}

TEST(Displacement, TilesChangeNothing) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 1);
  const View truth = makeView(bentSurface);
  View method = truth;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      method.seen.at(x, y).point = vec3(bentSurface(x + 8 * noise(random), y + 8 * noise(random)));
  const auto result = computeDisplacement(method.seen, truth.seen, truth.footprints);
  for (int y = 0; y < kHeight; y += 3)
    for (int x = 0; x < kWidth; x += 3)
      ASSERT_NEAR(result.displacementPx.at(x, y), findPlainly(method.seen.at(x, y), x, y, truth), 1e-3)
          << x << "," << y;
}

}  // namespace
}  // namespace catoptric::metrics
