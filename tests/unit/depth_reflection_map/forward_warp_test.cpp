// SPDX-License-Identifier: Apache-2.0
// The forward warp against closed forms: identity, visibility with and without a z-buffer, threads, regions.
#include "catoptric/depth_reflection_map/forward_warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "catoptric/core/parallel.h"
#include "synthetic_scene.h"

namespace catoptric::depth_reflection_map {
namespace {

constexpr int kZexels = 512, kPixels = 320;
const Pinhole kReference = lookThroughWindow({0.2, 0.1, -2.0}, 1.2, kZexels);
const Pinhole kView = lookThroughWindow({-0.35, 0.3, -1.7}, 0.8, kPixels);
const PixelRectangle kAll{0, 0, kPixels, kPixels};

const ZexelMap& map() {
  static const ZexelMap taken = takeSyntheticMap(kReference, kZexels);
  return taken;
}

WinnerImage warpTo(const Pinhole& view, const PixelRectangle& rectangle, const WarpOptions& options) {
  ForwardWarp warp;
  WinnerImage image;
  warp.warp(map(), kReference, view, rectangle, 0, options, image);
  return image;
}

struct Judgement {
  double medianPx, uncovered, hidden, wrong;
};

/// Does the reference see what the view shows along a direction, within its picture?
bool isHidden(const Pinhole& view, const dvec3& direction) {
  const dvec3 point = view.centre + direction * castRay(view.centre, direction);
  const dvec3 h = glm::inverse(kReference.worldFromPixel) * (point - kReference.centre);
  const dvec2 zexel(h / h.z);
  if (zexel.x < 0 || zexel.y < 0 || zexel.x >= kZexels || zexel.y >= kZexels) return true;
  return castRay(kReference.centre, point - kReference.centre) < 0.999;
}

/// Displacement from the truth, and the shares of pixels without a zexel, of those that show what the
/// reference does not, and of those with a surface more than 5 % of the depth away from the true one.
Judgement judge(const WinnerImage& image, const Pinhole& view) {
  std::vector<double> displacements;
  int uncovered = 0, hidden = 0, wrong = 0;
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) {
      const std::uint32_t winner = image.at(x, y);
      hidden += isHidden(view, view.worldFromPixel * dvec3(x + 0.5, y + 0.5, 1)) ? 1 : 0;
      if (winner == 0) {
        ++uncovered;
        continue;
      }
      const dvec3 point = pointOfWinner(winner, map(), kReference);
      displacements.push_back(displacementPx(view, point, x + 0.5, y + 0.5));
      const double t = castRay(view.centre, view.worldFromPixel * dvec3(x + 0.5, y + 0.5, 1));
      const double depth = t * -view.centre.z;
      wrong += std::abs((point.z - view.centre.z) - depth) > 0.05 * depth ? 1 : 0;
    }
  std::nth_element(displacements.begin(), displacements.begin() + std::ptrdiff_t(displacements.size() / 2),
                   displacements.end());
  const double all = double(kPixels) * kPixels;
  return {displacements[displacements.size() / 2], uncovered / all, hidden / all, wrong / all};
}

TEST(ForwardWarp, ToItselfIsTheIdentity) {
  const PixelRectangle all{0, 0, kZexels, kZexels};
  for (const Splat splat : {Splat::Point, Splat::Footprint}) {
    const WinnerImage image = warpTo(kReference, all, {.splat = splat});
    int same = 0;
    for (int y = 0; y < kZexels; ++y)
      for (int x = 0; x < kZexels; ++x) same += image.at(x, y) == std::uint32_t(y * kZexels + x + 1) ? 1 : 0;
    // Footprints reach a little over the pixel of their own zexel, never over its neighbour's centre.
    EXPECT_EQ(same, kZexels * kZexels);
  }
}

TEST(ForwardWarp, ShowsWhatAViewShows) {
  const Judgement footprint = judge(warpTo(kView, kAll, {}), kView);
  EXPECT_LE(footprint.medianPx, 0.5);
  EXPECT_NEAR(footprint.uncovered, footprint.hidden, 0.005);  // exposures and nothing else
  EXPECT_LE(footprint.wrong, 0.012);                          // silhouettes
  // The twin: the same winners judged as if the eye had not moved from the reference's side.
  EXPECT_GE(judge(warpTo(kView, kAll, {}), lookThroughWindow({0.2, 0.1, -2.0}, 0.8, kPixels)).medianPx, 5.0);
  // Points leave cracks where the view is finer than the reference; splats close them.
  EXPECT_GE(judge(warpTo(kView, kAll, {.splat = Splat::Point}), kView).uncovered, footprint.uncovered);
  EXPECT_LE(judge(warpTo(kView, kAll, {.splat = Splat::Square}), kView).uncovered, footprint.uncovered);
}

TEST(ForwardWarp, OrderShowsTheSameSurfacesAsAZBuffer) {
  for (const dvec3& eye : {dvec3(-0.35, 0.3, -1.7), dvec3(0.5, -0.2, -2.6), dvec3(0.2, 0.6, -2.0)}) {
    const Pinhole view = lookThroughWindow(eye, 0.8, kPixels);
    const auto share = [&](const WarpOptions& one, const WarpOptions& other) {
      const WinnerImage a = warpTo(view, kAll, one), b = warpTo(view, kAll, other);
      int covered = 0, same = 0;
      for (int y = 0; y < kPixels; ++y)
        for (int x = 0; x < kPixels; ++x) {
          if (a.at(x, y) == 0) continue;
          ++covered;
          if (b.at(x, y) == 0) continue;
          const double za = pointOfWinner(a.at(x, y), map(), kReference).z,
                       zb = pointOfWinner(b.at(x, y), map(), kReference).z;
          same += std::abs(za - zb) <= 0.05 * za ? 1 : 0;
        }
      return double(same) / covered;
    };
    const WarpOptions ordered{}, zBuffered{.visibility = Visibility::ZBuffer};
    const double same = share(ordered, zBuffered);
    EXPECT_GE(same, 0.999) << eye.x;
    std::printf("order and z-buffer: same surface at %.3f %% of the covered pixels\n", 100 * same);
  }
}

TEST(ForwardWarp, ThreadsDoNotChangeTheResult) {
  core::setThreadCount(1);
  const WinnerImage one = warpTo(kView, kAll, {});
  for (const int threads : {2, 3, 7}) {
    core::setThreadCount(threads);
    EXPECT_EQ(warpTo(kView, kAll, {}).winners, one.winners) << threads;
  }
  core::setThreadCount(0);
}

TEST(ForwardWarp, RegionsLeftOutShowNothing) {
  const PixelRectangle part{40, 60, 50, 30};
  ForwardWarp warp;
  WinnerImage with, without;
  const auto few = warp.warp(map(), kReference, kView, part, 0, {}, with);
  const auto all = warp.warp(map(), kReference, kView, part, 0, {.skipsRegions = false}, without);
  EXPECT_EQ(all, std::uint64_t(kZexels) * kZexels);
  EXPECT_LT(few, all / 4);
  EXPECT_EQ(with.winners, without.winners);
}

TEST(ForwardWarp, CoarserLevelsWarpAQuarterEach) {
  const Pinhole small = lookThroughWindow({-0.35, 0.3, -1.7}, 0.8, kPixels / 4);
  ForwardWarp warp;
  WinnerImage image;
  const PixelRectangle all{0, 0, kPixels / 4, kPixels / 4};
  const auto fine = warp.warp(map(), kReference, small, all, 0, {}, image);
  const auto coarse = warp.warp(map(), kReference, small, all, 0, {.level = 2}, image);
  EXPECT_NEAR(double(fine) / double(coarse), 16.0, 3.0);
  double worst = 0;
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x)
      if (const std::uint32_t winner = image.at(x, y))
        worst = std::max(worst,
                         displacementPx(small, pointOfWinner(winner, map(), kReference), x + 0.5, y + 0.5));
  EXPECT_LE(worst, 2.5);
}

TEST(ForwardWarp, SecondReferenceFillsExposures) {
  const Pinhole other = lookThroughWindow({-0.9, 0.4, -1.9}, 1.2, kZexels);
  const ZexelMap second = takeSyntheticMap(other, kZexels);
  WinnerImage image = warpTo(kView, kAll, {});
  const double before = judge(image, kView).uncovered;
  ForwardWarp warp;
  WinnerImage more;
  warp.warp(second, other, kView, kAll, 1, {}, more);
  fillExposures(more, image);
  int uncovered = 0;
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) uncovered += image.at(x, y) == 0 ? 1 : 0;
  EXPECT_GT(before, 0.01);
  EXPECT_LE(double(uncovered) / (kPixels * kPixels), 0.2 * before);
}

TEST(ForwardWarp, EmptyAndDegenerateInput) {
  const std::vector<float> sky(16, 0.0f);
  const ZexelMap tiny = makeZexelMap(4, 4, sky), one = makeZexelMap(1, 1, std::span(sky).first(1));
  ForwardWarp warp;
  WinnerImage image;
  const Pinhole reference = lookThroughWindow({0, 0, -1}, 1, 4);
  warp.warp(tiny, reference, reference, {0, 0, 4, 4}, 0, {}, image);
  EXPECT_EQ(image.at(2, 1), 7u);
  warp.warp(one, lookThroughWindow({0, 0, -1}, 1, 1), reference, {0, 0, 4, 4}, 0, {}, image);
  EXPECT_NE(image.at(2, 2), 0u);
  // A view that looks the other way shows nothing of it.
  Pinhole away = reference;
  away.worldFromPixel[2] = dvec3(-1, -1, -1);
  warp.warp(tiny, reference, away, {0, 0, 4, 4}, 0, {}, image);
  EXPECT_EQ(std::count(image.winners.begin(), image.winners.end(), 0u), std::ptrdiff_t(image.winners.size()));
}

}  // namespace
}  // namespace catoptric::depth_reflection_map
