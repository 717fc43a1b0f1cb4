// SPDX-License-Identifier: Apache-2.0
// What a frame pays for a curved mirror: maps for a new eye, virtual vertices, choice of triangles; and what
// loading pays: the mirror's mesh and the tessellation. A sphere of 11,520 triangles, 0.5 m, in a room with
// boxes; the same for the side of a cylinder.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <memory>

#include "catoptric/geometry/shapes.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/raster/virtual_triangles.h"
#include "catoptric/virtual_object/make_point_finder.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace {

using namespace catoptric;
using namespace catoptric::raster;
using namespace catoptric::virtual_object;

void appendPart(scene::WorldGeometry& g, const geometry::Mesh& mesh, std::uint32_t reflector) {
  scene::Part part;
  part.firstIndex = std::uint32_t(g.indices.size()), part.indexCount = std::uint32_t(mesh.indices.size());
  part.firstVertex = std::uint32_t(g.positions.size()),
  part.vertexCount = std::uint32_t(mesh.positions.size());
  part.reflector = reflector;
  for (const std::uint32_t i : mesh.indices) g.indices.push_back(part.firstVertex + i);
  g.positions.insert(g.positions.end(), mesh.positions.begin(), mesh.positions.end());
  g.normals.insert(g.normals.end(), mesh.normals.begin(), mesh.normals.end());
  g.uv0.resize(g.positions.size()), g.uv1.resize(g.positions.size());
  g.tangents.resize(g.positions.size()), g.colors.resize(g.positions.size(), vec4(1));
  g.triangleParts.resize(g.indices.size() / 3, std::uint32_t(g.parts.size()));
  g.parts.push_back(part);
}

scene::WorldGeometry makeWorld(const geometry::Mesh& mirror, scene::ReflectorShape shape) {
  scene::WorldGeometry g;
  g.reflectors.emplace_back();
  g.reflectors[0].name = "mirror";
  g.reflectors[0].shape = shape;
  core::Box box;
  for (const vec3& p : mirror.positions) box.add(dvec3(p));
  g.reflectors[0].centre = box.centre();
  g.reflectors[0].radius = box.radius();
  appendPart(g, mirror, 0);
  appendPart(g, geometry::transformed(geometry::makeBox({8, 3, 8}), geometry::moveBy({0, 1.5, 0})),
             core::kNoId);
  for (const dvec3& at :
       {dvec3(0.7, 0.15, 0.4), dvec3(-0.7, 0.3, 0.2), dvec3(0.1, 0.1, 0.7), dvec3(1.5, 1.6, 1.5)})
    appendPart(g, geometry::transformed(geometry::makeBox({0.3, 0.3, 0.3}), geometry::moveBy(at)),
               core::kNoId);
  return g;
}

struct Bench {
  Bench(const geometry::Mesh& mirror, scene::ReflectorShape shape)
      : world(makeWorld(mirror, shape)),
        mesh(world, 0),
        solver(mesh, eye, 7.0),
        objects(tessellateForReflector(world, 0)) {
    positions.resize(objects.positions.size());
    points.resize(objects.positions.size());
    kinds.resize(objects.positions.size());
  }
  dvec3 eye{0.4, 0.9, 2.6};
  scene::WorldGeometry world;
  ReflectorMesh mesh;
  VirtualObjectSolver solver;
  TessellatedObjects objects;
  std::vector<vec3> positions, points;
  std::vector<VertexKind> kinds;
};

Bench& getBench(std::int64_t which) {
  static const std::unique_ptr<Bench> benches[2] = {
      std::make_unique<Bench>(
          geometry::transformed(geometry::makeIcosphere(0.5, 24), geometry::moveBy({0, 0.5, 0})),
          scene::ReflectorShape::Sphere),
      std::make_unique<Bench>(geometry::transformed(geometry::makeCylinderSide(0.3, 1.6, 96, 12, false),
                                                    geometry::moveBy({0, 0.8, 0})),
                              scene::ReflectorShape::Cylinder)};
  return *benches[which];
}

void virtualVertices(benchmark::State& state) {
  Bench& b = getBench(state.range(0));
  const auto solver = Solver(state.range(1));
  b.solver.useFinder(makePointFinder(solver, b.world, 0, false, b.mesh));
  for (auto _ : state) b.solver.compute(solver, b.objects.positions, b.positions, b.kinds, b.points);
  state.counters["vertices/s"] = benchmark::Counter(double(b.positions.size()) * double(state.iterations()),
                                                    benchmark::Counter::kIsRate);
  state.counters["vertices"] = double(b.positions.size());
  b.solver.useFinder(nullptr);
}
BENCHMARK(virtualVertices)
    ->ArgNames({"cylinder", "solver"})  // explosion, refined, analytic, layered, subdivision
    ->ArgsProduct({{0, 1}, {0, 1, 2, 3, 4}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// As frame after frame of a walking eye: a vertex begins where the frame before found it.
void verticesOfANewEye(benchmark::State& state) {
  Bench& b = getBench(state.range(0));
  LanePlaces places;
  double angle = 0;
  for (auto _ : state) {
    angle += double(state.range(1)) * 1e-3 / 2.6;
    b.solver.setEye({2.6 * std::sin(angle), 0.9, 2.6 * std::cos(angle)});
    const auto start = std::chrono::steady_clock::now();
    b.solver.compute(Solver::Refined, b.objects.positions, b.positions, b.kinds, b.points, {}, &places);
    state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  state.counters["vertices/s"] = benchmark::Counter(double(b.positions.size()) * double(state.iterations()),
                                                    benchmark::Counter::kIsRate);
  b.solver.setEye(b.eye);
}
BENCHMARK(verticesOfANewEye)
    ->ArgNames({"cylinder", "mm"})
    ->ArgsProduct({{0, 1}, {0, 10, 50}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void mapsForANewEye(benchmark::State& state) {
  Bench& b = getBench(state.range(0));
  for (auto _ : state) b.solver.setEye(b.eye);
}
BENCHMARK(mapsForANewEye)->ArgName("cylinder")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void selectTriangles(benchmark::State& state) {
  Bench& b = getBench(state.range(0));
  b.solver.compute(Solver::Refined, b.objects.positions, b.positions, b.kinds, b.points);
  VirtualTriangles out;
  for (auto _ : state) selectVirtualTriangles(b.objects, b.eye, b.positions, b.kinds, b.points, out);
  state.counters["triangles"] = double(b.objects.indices.size()) / 3;
}
BENCHMARK(selectTriangles)->ArgName("cylinder")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void tessellation(benchmark::State& state) {
  Bench& b = getBench(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(tessellateForReflector(b.world, 0));
  state.counters["triangles"] = double(b.objects.indices.size()) / 3;
}
BENCHMARK(tessellation)->ArgName("cylinder")->Arg(0)->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);

void mirrorMesh(benchmark::State& state) {
  Bench& b = getBench(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(ReflectorMesh(b.world, 0));
}
BENCHMARK(mirrorMesh)->ArgName("cylinder")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
