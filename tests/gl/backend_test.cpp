// SPDX-License-Identifier: Apache-2.0
// Virtual vertices of the vertex shader against those of the processor: the same places to a small part of a
// pixel, the same kinds, the same pictures.
//
// Tolerances: pixels of a picture in which the mirror is 700 wide. A map's pixel decides on a triangle; where
// a point lies on the border of two pixels float and double decide differently, which moves it by the maps'
// own error, so that a share of the vertices is allowed to differ by more.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "catoptric/core/error.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/gl/program.h"
#include "catoptric/renderer/raster_frame.h"
#include "catoptric/virtual_object/layered_finder.h"
#include "catoptric/virtual_object/mirror_textures.h"
#include "gl_test_support.h"
#include "traced_scene.h"

namespace catoptric::gl::test {
namespace {

using namespace virtual_object;
using Backend = GlTest;

constexpr int kEdge = 64, kPoints = kEdge * kEdge;

struct Placed {
  std::vector<vec3> positions;
  std::vector<VertexKind> kinds;
};

std::vector<vec3> makePoints(const ReflectorMesh& mesh, double farthest) {
  std::mt19937 random(23);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<vec3> points(kPoints);
  for (vec3& point : points) {
    const dvec3 direction = glm::normalize(dvec3(gauss(random), gauss(random), gauss(random)));
    point =
        vec3(mesh.centre() + direction / glm::mix(1 / (1.05 * mesh.radius()), 1 / farthest, uniform(random)));
  }
  return points;
}

Placed placeOnCpu(VirtualObjectSolver& solver, Solver which, const std::vector<vec3>& points) {
  Placed placed{std::vector<vec3>(points.size()), std::vector<VertexKind>(points.size())};
  if (which == Solver::Layered) solver.useFinder(std::make_unique<LayeredFinder>(solver.mesh()));
  solver.compute(which, points, placed.positions, placed.kinds);
  return placed;
}

Placed placeOnGpu(const VirtualObjectSolver& solver, Solver which, const std::vector<vec3>& points) {
  const EyeView view = solver.eyeView();
  LayeredFinder finder(solver.mesh(), which == Solver::Refined ? 4 : kDefaultLayers);
  finder.setEye(view);
  std::vector<const ExplosionMap*> maps{&solver.nearMap(), &solver.farMap()};
  if (which != Solver::Explosion) {
    maps.clear();
    for (const ExplosionMap& map : finder.layers()) maps.push_back(&map);
  }
  MirrorTextures textures(solver.mesh(), int(maps.size()));
  textures.setEye(view, maps, solver.hiddenMap());

  Program program("virtual_object/vertex_probe.vert", "virtual_object/vertex_probe.frag",
                  vertexShaderDefines(which));
  Buffer positions(BufferKind::Vertex);
  positions.upload(std::span<const vec3>(points));
  VertexArray array;
  array.setAttribute(0, positions, 3);
  const FloatTarget target(kEdge, kEdge);
  target.framebuffer.bind();
  setDrawState({.depthTest = false, .depthWrite = false});
  program.use();
  textures.bind(program);
  program.set("u_targetSizePx", vec2(float(kEdge)));
  array.bind();
  drawPoints(kPoints);
  Placed placed;
  for (const vec4& texel : target.read()) {
    placed.positions.emplace_back(texel);
    placed.kinds.push_back(VertexKind(int(texel.w)));
  }
  return placed;
}

struct Agreement {
  double bothReflected = 0, sameKind = 0;  ///< shares: agree on whether it is reflected, on the kind
  double within = 0, medianPx = 0;         ///< of reflected vertices: share within 0.1 px
};

/// Far past an open boundary the one may give up where the other goes on.
VertexKind withoutBoundary(VertexKind kind) {
  return kind == VertexKind::PastBoundary ? VertexKind::DoublyVirtual : kind;
}

Agreement compare(const VirtualObjectSolver& solver, const Placed& cpu, const Placed& gpu) {
  const double pixelsPerRadian =
      700 * glm::length(solver.eye() - solver.mesh().centre()) / (2 * solver.mesh().bodyRadius());
  std::vector<double> errors;
  std::size_t same = 0, sameKind = 0;
  for (std::size_t i = 0; i < cpu.kinds.size(); ++i) {
    sameKind += withoutBoundary(cpu.kinds[i]) == withoutBoundary(gpu.kinds[i]) ? 1 : 0;
    const bool isReflected = cpu.kinds[i] == VertexKind::Reflected;
    if (isReflected != (gpu.kinds[i] == VertexKind::Reflected)) continue;
    ++same;
    if (!isReflected) continue;
    const dvec3 a = dvec3(cpu.positions[i]) - solver.eye(), b = dvec3(gpu.positions[i]) - solver.eye();
    const double px = pixelsPerRadian * std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    const double deeper = std::abs(glm::length(b) / glm::length(a) - 1);
    errors.push_back(std::max(px, 100 * deeper));  // a thousandth of the depth counts as a tenth of a pixel
  }
  std::sort(errors.begin(), errors.end());
  Agreement agreement;
  agreement.bothReflected = double(same) / double(cpu.kinds.size());
  agreement.sameKind = double(sameKind) / double(cpu.kinds.size());
  if (errors.empty()) return agreement;
  agreement.medianPx = errors[errors.size() / 2];
  agreement.within =
      double(std::lower_bound(errors.begin(), errors.end(), 0.1) - errors.begin()) / double(errors.size());
  return agreement;
}

ReflectorMesh meshOf(const geometry::Mesh& mesh) {
  return ReflectorMesh(mesh.positions, mesh.normals, mesh.indices);
}

constexpr std::array kSolvers{Solver::Explosion, Solver::Layered, Solver::Refined};
constexpr std::array kNames{"explosion", "layered", "refined"};

void expectParity(const char* name, const ReflectorMesh& mesh, const dvec3& eye) {
  const std::vector<vec3> points = makePoints(mesh, 15 * mesh.radius());
  for (std::size_t i = 0; i < kSolvers.size(); ++i) {
    VirtualObjectSolver solver(mesh, eye, 15 * mesh.radius());
    ASSERT_TRUE(solver.canReflect());
    const Placed gpu = placeOnGpu(solver, kSolvers[i], points);
    const Agreement a = compare(solver, placeOnCpu(solver, kSolvers[i], points), gpu);
    std::printf(
        "%-10s %-10s reflected in both or neither %.4f, same kind %.4f, within 0.1 px %.4f, median %.1e px\n",
        name, kNames[i], a.bothReflected, a.sameKind, a.within, a.medianPx);
    EXPECT_GE(a.bothReflected, 0.999) << name << ", " << kNames[i];
    // Far past the edge of an open mirror, where nothing is drawn, searches end where rounding leads them.
    EXPECT_GE(a.sameKind, 0.98) << name << ", " << kNames[i];
    EXPECT_GE(a.within, 0.999) << name << ", " << kNames[i];
    EXPECT_LE(a.medianPx, 0.01) << name << ", " << kNames[i];
  }
}

TEST_F(Backend, theVertexShaderFindsWhatTheProcessorFinds) {
  expectParity("sphere", meshOf(geometry::makeIcosphere(0.5, 20)), {0.4, 0.9, 2.6});
  expectParity("cylinder", meshOf(geometry::makeCylinderSide(0.3, 1.2, 96, 24, false)), {0.5, 0.4, 2});
}

TEST_F(Backend, anotherEyeDoesNotPass) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 12));
  const std::vector<vec3> points = makePoints(mesh, 8);
  for (const Solver which : kSolvers) {
    VirtualObjectSolver solver(mesh, {0.4, 0.9, 2.6}, 8);
    const VirtualObjectSolver other(mesh, {0.42, 0.9, 2.6}, 8);
    const Placed gpu = placeOnGpu(other, which, points);
    EXPECT_LT(compare(solver, placeOnCpu(solver, which, points), gpu).within, 0.2);
  }
}

/// A ball and a flat mirror on a floor, with a board and a sheet of glass.
reference::TracedTestScene makeScene() {
  using namespace reference;
  TracedTestScene t;
  t.camera.eye = {0.6, 1.1, 3.2};
  t.camera.target = {0, 0.5, 0};
  t.camera.fovYRadians = 0.7;
  t.add(makeBall(64, 48), makeMirror(), "ball",
        glm::translate(dmat4(1.0), dvec3(-0.3, 0.5, 0)) * glm::scale(dmat4(1.0), dvec3(0.5)));
  t.add(makeQuad({0.7f, 0, -0.6f}, {0.6f, 0, 0.7f}, {0, 1.2f, 0}), makeMirror(vec3(0.8f, 1, 0.8f)), "flat");
  t.add(makeQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), makeUnlit(vec3(0.3f, 0.2f, 0.1f)), "floor");
  t.add(makeQuad({-1.2f, 0, 1.4f}, {0, 0, -0.8f}, {0, 0.9f, 0}), makeUnlit(vec3(0.2f, 0.4f, 1)), "board");
  scene::Material glass = makeUnlit(vec3(1, 1, 0));
  glass.baseColor.a = 0.5f;
  glass.alphaMode = scene::AlphaMode::Blend;
  glass.doubleSided = true;
  t.add(makeQuad({0.4f, 0.1f, 1.2f}, {0.5f, 0, -0.2f}, {0, 0.6f, 0}), glass, "glass");
  t.finish();
  return t;
}

TEST_F(Backend, picturesAreTheSame) {
  constexpr int kSizePx = 160;
  const reference::TracedTestScene t = makeScene();
  renderer::RasterFrame raster(GlTest::context(), t.scene, t.world, t.environment);
  for (const renderer::Solver which :
       {renderer::Solver::Explosion, renderer::Solver::Layered, renderer::Solver::Refined}) {
    renderer::FrameOptions options;
    options.method = renderer::Method::Virtual;
    options.solver = which;
    options.widthPx = options.heightPx = kSizePx;
    options.bounces = 3;
    options.backend = renderer::Backend::Cpu;
    const renderer::Frame cpu = raster.render(t.frame(kSizePx, kSizePx), options);
    options.backend = renderer::Backend::Gpu;
    const renderer::Frame gpu = raster.render(t.frame(kSizePx, kSizePx), options);
    std::size_t mirrors = 0, different = 0;
    for (std::size_t i = 0; i < cpu.seen.size(); ++i) {
      const core::SeenPixel &p = cpu.seen.pixels()[i], &q = gpu.seen.pixels()[i];
      if (p.bounces == 0) continue;
      ++mirrors;
      const vec4 change = glm::abs(cpu.radiance.pixels()[i] - gpu.radiance.pixels()[i]);
      const bool isSame = p.object == q.object && p.bounces == q.bounces &&
                          std::max({change.r, change.g, change.b}) < 2.0f / 255.0f;
      different += isSame ? 0 : 1;
    }
    std::printf("%-10s %zu of %zu mirror pixels differ\n", std::string(renderer::solverName(which)).c_str(),
                different, mirrors);
    EXPECT_GT(mirrors, 2000u);
    EXPECT_LE(different, mirrors / 100) << renderer::solverName(which);  // pixels at edges
  }
}

/// Both round corners to 1/256 of a pixel; what is left are pixels whose centres lie on an edge so rounded,
/// or where two surfaces are equally near: a sliver.
void checkThatTheProcessorDrawsAsGl(gl::Context& context, renderer::Solver solver) {
  constexpr int kSizePx = 240;
  const reference::TracedTestScene t = makeScene();
  renderer::RasterFrame raster(context, t.scene, t.world, t.environment);
  renderer::FrameOptions options;
  options.method = renderer::Method::Virtual;
  options.solver = solver;
  options.widthPx = options.heightPx = kSizePx;
  options.bounces = 3;
  const auto countDifferent = [&](const renderer::Frame& a, const renderer::Frame& b, std::size_t& mirrors) {
    std::size_t different = 0;
    mirrors = 0;
    for (std::size_t i = 0; i < a.seen.size(); ++i) {
      const core::SeenPixel &p = a.seen.pixels()[i], &q = b.seen.pixels()[i];
      if (p.bounces == 0) continue;
      ++mirrors;
      const vec4 change = glm::abs(a.radiance.pixels()[i] - b.radiance.pixels()[i]);
      const bool isSame = p.object == q.object && p.bounces == q.bounces &&
                          std::max({change.r, change.g, change.b}) < 2.0f / 255.0f;
      different += isSame ? 0 : 1;
    }
    return different;
  };
  const scene::CameraFrame camera = t.frame(kSizePx, kSizePx);
  raster.drawNumbersByGl(true);
  const renderer::Frame byGl = raster.render(camera, options);
  raster.drawNumbersByGl(false);
  const renderer::Frame here = raster.render(camera, options);
  std::size_t mirrors = 0;
  const std::size_t different = countDifferent(byGl, here, mirrors);
  std::printf("numbers of GL and of the processor: %zu of %zu mirror pixels differ\n", different, mirrors);
  EXPECT_GT(mirrors, 5000u);
  EXPECT_LE(different, mirrors / 500);
  // A tenth of a pixel off is told.
  scene::Camera turned = t.camera;
  turned.target.x += 0.1 * 2 * std::tan(0.5 * t.camera.fovYRadians) * 3.2 / kSizePx;
  const renderer::Frame off = raster.render(scene::makeCameraFrame(turned, kSizePx, kSizePx), options);
  EXPECT_GT(countDifferent(byGl, off, mirrors), mirrors / 500);
}

TEST_F(Backend, theProcessorDrawsTheNumbersThatGlDraws) {
  checkThatTheProcessorDrawsAsGl(GlTest::context(), renderer::Solver::Refined);
}

TEST_F(Backend, theProcessorMeetsTheTrianglesThatGlMeets) {
  checkThatTheProcessorDrawsAsGl(GlTest::context(), renderer::Solver::Exact);
}

TEST_F(Backend, aSolverWithoutAVertexShaderIsRefused) {
  const reference::TracedTestScene t = makeScene();
  renderer::RasterFrame raster(GlTest::context(), t.scene, t.world, t.environment);
  renderer::FrameOptions options;
  options.method = renderer::Method::Virtual;
  options.solver = renderer::Solver::Analytic;
  options.backend = renderer::Backend::Gpu;
  options.widthPx = options.heightPx = 16;
  EXPECT_THROW(static_cast<void>(raster.render(t.frame(16, 16), options)), core::Error);
}

TEST_F(Backend, softwareIsKnownByItsName) {
  EXPECT_TRUE(isSoftwareRenderer("llvmpipe (LLVM 15.0.6, 256 bits)"));
  EXPECT_TRUE(isSoftwareRenderer("softpipe"));
  EXPECT_TRUE(isSoftwareRenderer("Google SwiftShader"));
  EXPECT_FALSE(isSoftwareRenderer("Mesa Intel(R) UHD Graphics 620 (KBL GT2)"));
  EXPECT_FALSE(isSoftwareRenderer("NVIDIA GeForce RTX 3060/PCIe/SSE2"));
}

}  // namespace
}  // namespace catoptric::gl::test
