// SPDX-License-Identifier: Apache-2.0
// Rays per second of the ray tracer, primary and mirrored, shading included. Four mirror balls over a
// checkered floor before a flat mirror, 960 x 720.
#include <benchmark/benchmark.h>

#include <cmath>

#include "catoptric/core/parallel.h"
#include "catoptric/reference/ray_tracer.h"

namespace {

using namespace catoptric;

scene::MeshPrimitive makeQuad(const vec3& corner, const vec3& u, const vec3& v, float repeat, int material) {
  scene::MeshPrimitive mesh;
  for (const vec2 c : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) {
    mesh.positions.push_back(corner + c.x * u + c.y * v);
    mesh.normals.push_back(glm::normalize(glm::cross(u, v)));
    mesh.uv[0].push_back(repeat * c);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.material = material;
  return mesh;
}

scene::MeshPrimitive makeBall(int slices, int stacks, int material) {
  constexpr double kPi = 3.14159265358979323846;
  scene::MeshPrimitive mesh;
  mesh.material = material;
  for (int j = 0; j <= stacks; ++j)
    for (int i = 0; i <= slices; ++i) {
      const double theta = kPi * j / stacks, phi = 2 * kPi * i / slices;
      const dvec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(vec3(n));
      mesh.normals.push_back(vec3(n));
    }
  const auto at = [&](int i, int j) { return std::uint32_t(j * (slices + 1) + i); };
  for (int j = 0; j < stacks; ++j)
    for (int i = 0; i < slices; ++i) {
      if (j > 0) mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      if (j < stacks - 1) mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return mesh;
}

struct BenchScene {
  scene::Scene scene;
  scene::WorldGeometry world;
  scene::Environment environment = scene::makeConstantEnvironment(vec3(0.4f, 0.6f, 0.9f));
  scene::CameraFrame frame;

  BenchScene() {
    scene::Texture checker;
    checker.image = core::ImageRgba8(128, 128);
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 128; ++x)
        checker.image.at(x, y) = (x / 16 + y / 16) % 2 ? glm::u8vec4(230) : glm::u8vec4(40, 40, 40, 255);
    scene.textures.push_back(checker);
    scene.materials.resize(3);
    scene.materials[0].metallic = 0;
    scene.materials[0].baseColorTexture.texture = 0;
    scene.materials[1].roughness = 0;
    scene.meshes = {{"floor", {makeQuad({-20, 0, 20}, {40, 0, 0}, {0, 0, -40}, 10, 0)}},
                    {"ball", {makeBall(256, 128, 1)}},
                    {"wall", {makeQuad({-4, 0, -5}, {8, 0, 0}, {0, 4, 0}, 1, 1)}}};
    scene.instances.push_back({"floor", 0, dmat4(1), {}});
    scene.instances.push_back({"wall", 2, dmat4(1), {}});
    for (int i = 0; i < 4; ++i) {
      const double a = 1.57 * i + 0.3;
      scene.instances.push_back(
          {"ball", 1, glm::translate(dmat4(1), dvec3(2 * std::cos(a), 1, 2 * std::sin(a))), {}});
    }
    world = scene::makeWorldGeometry(scene);
    scene::Camera camera;
    camera.eye = {1.5, 3, 8};
    camera.target = {0, 0.8, 0};
    frame = scene::makeCameraFrame(camera, 960, 720);
  }
};

/// Argument: bounces; 0 measures primary rays.
void traceFrame(benchmark::State& state) {
  static const BenchScene bench;
  static const reference::RayTracer tracer(bench.scene, bench.world, bench.environment);
  const reference::TraceOptions options{.bounces = int(state.range(0))};
  std::uint64_t rays = 0;
  reference::TraceResult result;
  for (auto _ : state) {
    tracer.trace(bench.frame, options, result);
    rays += result.rays;
  }
  state.counters["rays_per_second"] = benchmark::Counter(double(rays), benchmark::Counter::kIsRate);
  state.SetLabel(tracer.describe());
}
BENCHMARK(traceFrame)->Arg(0)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond)->UseRealTime();

void buildTracer(benchmark::State& state) {
  static const BenchScene bench;
  for (auto _ : state) reference::RayTracer tracer(bench.scene, bench.world, bench.environment);
  state.counters["triangles"] = double(bench.world.triangleCount());
}
BENCHMARK(buildTracer)->Unit(benchmark::kMillisecond)->UseRealTime();

void buildWorldGeometry(benchmark::State& state) {
  static const BenchScene bench;
  for (auto _ : state) benchmark::DoNotOptimize(scene::makeWorldGeometry(bench.scene));
  state.counters["triangles"] = double(bench.world.triangleCount());
}
BENCHMARK(buildWorldGeometry)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
