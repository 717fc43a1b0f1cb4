// SPDX-License-Identifier: Apache-2.0
// Forward warp alone: 512x512 zexels to 640x480 pixels (Bastos & Stuerzlinger 1998, figure 6). Arguments:
// splat (0 point, 1 square, 2 footprint), z-buffer (0, 1), threads.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "catoptric/core/parallel.h"
#include "catoptric/depth_reflection_map/forward_warp.h"

namespace {

using namespace catoptric;
using namespace catoptric::depth_reflection_map;

constexpr int kZexels = 512;

Pinhole lookThroughWindow(const dvec3& centre, double halfX, double halfY, int width, int height) {
  return {centre, dmat3(dvec3(2 * halfX / width, 0, 0), dvec3(0, 2 * halfY / height, 0),
                        dvec3(-halfX, -halfY, 0) - centre)};
}

/// A wavy wall 4 m behind the window with a ball before it.
ZexelMap makeMap(const Pinhole& reference) {
  std::vector<float> disparities;
  for (int y = 0; y < kZexels; ++y)
    for (int x = 0; x < kZexels; ++x) {
      const dvec2 p(x / double(kZexels) - 0.5, y / double(kZexels) - 0.5);
      const double z = glm::length(p) < 0.2 ? 1.5 + 3 * glm::dot(p, p) : 4.0 + 0.3 * std::sin(20 * p.x);
      disparities.push_back(float(-reference.centre.z / (z - reference.centre.z)));
    }
  return makeZexelMap(kZexels, kZexels, disparities);
}

void warpToMovedEye(benchmark::State& state) {
  core::setThreadCount(int(state.range(2)));
  const Pinhole reference = lookThroughWindow({0.2, 0.1, -2}, 1, 1, kZexels, kZexels);
  const Pinhole view = lookThroughWindow({-0.1, 0.25, -1.9}, 1, 1, 640, 480);
  const ZexelMap map = makeMap(reference);
  WarpOptions options;
  options.splat = Splat(state.range(0));
  options.visibility = Visibility(state.range(1));
  ForwardWarp warp;
  WinnerImage image;
  std::uint64_t zexels = 0;
  for (auto _ : state) zexels += warp.warp(map, reference, view, {0, 0, 640, 480}, 0, options, image);
  state.SetItemsProcessed(std::int64_t(zexels));
  core::setThreadCount(0);
}

BENCHMARK(warpToMovedEye)
    ->ArgNames({"splat", "zbuffer", "threads"})
    ->ArgsProduct({{0, 1, 2}, {0, 1}, {1, 2}})
    ->UseRealTime()
    ->MeasureProcessCPUTime();

double medianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// One core and two in turn, ten frames each, so that whatever else the machine does meets both.
void printScaling() {
  constexpr int kRounds = 40, kFrames = 10;
  const Pinhole reference = lookThroughWindow({0.2, 0.1, -2}, 1, 1, kZexels, kZexels);
  const Pinhole view = lookThroughWindow({-0.1, 0.25, -1.9}, 1, 1, 640, 480);
  const ZexelMap map = makeMap(reference);
  ForwardWarp warp;
  WinnerImage image;
  std::vector<double> rates[2];
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    double rate[2];
    for (int i = 0; i < 2; ++i) {
      core::setThreadCount(i + 1);
      std::vector<double> frames;
      for (int frame = -2; frame < kFrames; ++frame) {  // threads start in the first two
        const auto start = std::chrono::steady_clock::now();
        const std::uint64_t zexels = warp.warp(map, reference, view, {0, 0, 640, 480}, 0, {}, image);
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
        if (frame >= 0) frames.push_back(double(zexels) / spent.count());
      }
      rates[i].push_back(rate[i] = medianOf(frames));
    }
    ratios.push_back(rate[1] / rate[0]);
  }
  core::setThreadCount(0);
  std::printf(
      "million zexels a second, 512x512 to 640x480: one core %.0f, two %.0f, ratio %.2f (medians of %d "
      "rounds)\n",
      1e-6 * medianOf(rates[0]), 1e-6 * medianOf(rates[1]), medianOf(ratios), kRounds);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  printScaling();
}
