// SPDX-License-Identifier: Apache-2.0
// What reflection morphing costs on one core: baking a location, loading one, looking vertices up, morphing
// them. A sphere of 11,520 triangles, 0.5 m, 20,000 vertices of a floor under it and a wall.
#include <benchmark/benchmark.h>

#include "catoptric/core/parallel.h"
#include "catoptric/reflection_morphing/morphing.h"
#include "reflection_morphing/mirror_world.h"

namespace {

using namespace catoptric;
using namespace catoptric::reflection_morphing;

struct Bench {
  Bench() : world(test::makeSphereWorld()), rays(world), options(test::makeOptions(world)) {
    core::setThreadCount(1);
    for (std::size_t k = 0; k < 8; ++k) {
      const dvec3 at = dvec3(0.4, 0.3, 2.1) + 0.15 * dvec3(k & 1, (k >> 1) & 1, k >> 2);
      bytes = bakeLocation(rays, at, options);
      locations[k] = unpackLocation(bytes, options.octree.box);
      trace[k] = locations[k]->findTrace({0});
    }
    for (int y = 0; y < 100;
         ++y)  // a floor and a wall, row by row, as the vertices of a mesh follow each other
      for (int x = 0; x < 100; ++x) points.emplace_back(0.06f * float(x - 50), -0.5f, 0.06f * float(y - 50));
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 100; ++x)
        points.emplace_back(0.06f * float(x - 50), -0.5f + 0.03f * float(y), 3.0f);
  }
  scene::WorldGeometry world;
  MirrorRays rays;
  BakeOptions options;
  std::vector<std::byte> bytes;
  std::array<std::shared_ptr<const SamplingLocation>, 8> locations;
  CellTrace trace{};
  std::vector<vec3> points;
};

Bench& get() {
  static Bench bench;
  return bench;
}

void bakeOne(benchmark::State& state) {
  Bench& b = get();
  for (auto _ : state) benchmark::DoNotOptimize(bakeLocation(b.rays, {0.4, 0.3, 2.1}, b.options));
  state.counters["bytes"] = double(b.bytes.size());
}
void loadOne(benchmark::State& state) {
  Bench& b = get();
  for (auto _ : state) benchmark::DoNotOptimize(unpackLocation(b.bytes, b.options.octree.box));
}
void lookUp(benchmark::State& state) {
  Bench& b = get();
  CornerPoints corners;
  for (auto _ : state) lookUpCorners(b.trace, b.points, {}, corners);
  state.SetItemsProcessed(std::int64_t(state.iterations()) * std::int64_t(b.points.size()));
}
void morph(benchmark::State& state) {
  Bench& b = get();
  CornerPoints corners;
  lookUpCorners(b.trace, b.points, {}, corners);
  std::vector<vec3> drawn(b.points.size()), mirror(b.points.size());
  std::array<float, 8> weights{};
  weights.fill(0.125f);
  for (auto _ : state) morphVertices(vec3(0.45f, 0.35f, 2.15f), weights, corners, drawn, mirror);
  state.SetItemsProcessed(std::int64_t(state.iterations()) * std::int64_t(b.points.size()));
}

BENCHMARK(bakeOne)->Unit(benchmark::kMillisecond);
BENCHMARK(loadOne)->Unit(benchmark::kMillisecond);
BENCHMARK(lookUp)->Unit(benchmark::kMillisecond);
BENCHMARK(morph)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
