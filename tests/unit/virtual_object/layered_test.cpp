// SPDX-License-Identifier: Apache-2.0
// Layered explosion maps: K = 2 is what the 1998 method has, and how the error falls with K.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "catoptric/geometry/shapes.h"
#include "catoptric/virtual_object/layered_finder.h"
#include "catoptric/virtual_object/special_reflector.h"
#include "catoptric/virtual_object/virtual_object_solver.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kRadius = 0.5;
/// Layers, and the mean error in pixels that SOLVERS.md states for ideal maps.
constexpr struct {
  int count;
  double errorPx;
} kLayers[] = {{2, 8.7}, {3, 2.4}, {4, 1.1}, {6, 0.42}, {8, 0.20}, {12, 0.08}, {16, 0.04}};

constexpr std::array kResolutions{32, 64, 128, 256, 512};  ///< pixels across a map

TEST(Layered, TwoLayersAreTheMapsOfThe1998Method) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(kRadius, 16));
  VirtualObjectSolver solver(mesh, {0.4, 0.9, 2.6}, 6.0);
  auto owned = std::make_unique<LayeredFinder>(mesh, 2);
  const LayeredFinder& layered = *owned;
  solver.useFinder(std::move(owned));
  ASSERT_EQ(layered.layers().size(), 2u);
  const ExplosionMap* maps[] = {&solver.nearMap(), &solver.farMap()};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(layered.layers()[i].radius, maps[i]->radius, 1e-12);
    EXPECT_EQ(layered.layers()[i].ids.pixels(), maps[i]->ids.pixels());
  }
}

/// A sphere 700 px wide, the eye two radii from its centre, points from 1.1 to 15 radii, evenly in 1 / rho.
struct Setting {
  dvec3 eye{0, 0, 2 * kRadius};
  double focalPx = 350.0 / std::tan(std::asin(0.5));
  double nearRadius = 1.1 * kRadius, farRadius = 15 * kRadius;

  [[nodiscard]] double errorPx(const dvec3& a, const dvec3& b) const {
    const dvec3 u = a - eye, v = b - eye;
    return focalPx * glm::distance(dvec2(u.x, u.y) / u.z, dvec2(v.x, v.y) / v.z);
  }
  [[nodiscard]] std::vector<dvec3> makePoints(int count) const {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<dvec3> points;
    while (int(points.size()) < count) {
      const double inverse = glm::mix(1 / nearRadius, 1 / farRadius, uniform(random));
      points.push_back(randomDirection(random) / inverse);
    }
    return points;
  }
};

/// Mean error of interpolating exact reflection points between K spheres: what ideal maps would do.
double computeIdealError(const Setting& setting, int layers) {
  const SpecialReflector sphere{SpecialShape::Sphere, dvec3(0), {0, 0, 1}, kRadius, 0, false};
  double sum = 0;
  int count = 0;
  for (const dvec3& point : setting.makePoints(4000)) {
    const Reflections exact = findReflections(sphere, setting.eye, point);
    const double inverse = 1 / glm::length(point), first = 1 / setting.nearRadius,
                 last = 1 / setting.farRadius;
    const double layer = (inverse - first) / (last - first) * (layers - 1);
    const int lower = std::min(int(layer), layers - 2);
    dvec3 blend(0);
    bool isServed = exact.count == 1;
    for (int k = 0; k < 2; ++k) {
      const double at = glm::mix(first, last, double(lower + k) / (layers - 1));
      const Reflections r = findReflections(sphere, setting.eye, glm::normalize(point) / at);
      isServed = isServed && r.count == 1;
      if (isServed) blend += (k == 0 ? 1 - (layer - lower) : layer - lower) * r.all[0].position;
    }
    if (!isServed) continue;
    sum += setting.errorPx(blend, exact.all[0].position);
    ++count;
  }
  return sum / count;
}

/// The same of the solver, with maps of triangle ids on a mesh.
double computeMapError(const Setting& setting, const ReflectorMesh& mesh, int layers, int resolution) {
  const SpecialReflector sphere{SpecialShape::Sphere, dvec3(0), {0, 0, 1}, kRadius, 0, false};
  ReflectedRays rays;
  computeReflectedRays(mesh, setting.eye, rays);
  LayeredFinder finder(mesh, layers, resolution);
  finder.setEye({setting.eye, setting.nearRadius, setting.farRadius, &rays});
  double sum = 0;
  int count = 0;
  for (const dvec3& point : setting.makePoints(4000)) {
    const Reflections exact = findReflections(sphere, setting.eye, point);
    const auto found = finder.find(point);
    if (exact.count != 1 || !found || found->isPastBoundary) continue;
    sum += setting.errorPx(found->position, exact.all[0].position);
    ++count;
  }
  return sum / count;
}

TEST(Layered, ErrorFallsWithTheNumberOfLayers) {
  const Setting setting;
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(kRadius, 25));
  // scripts/layered_plot.py reads this table.
  std::printf("mean error, px, by layers and by pixels across a map\nlayers    ideal");
  for (const int resolution : kResolutions) std::printf(" %8d", resolution);
  double lastIdeal = 1e9;
  std::array<double, kResolutions.size()> last;
  last.fill(1e9);
  for (const auto& [layers, stated] : kLayers) {
    const double ideal = computeIdealError(setting, layers);
    std::printf("\n%6d %8.3f", layers, ideal);
    EXPECT_NEAR(ideal, stated, 0.2 * stated);
    EXPECT_LT(ideal, lastIdeal);
    lastIdeal = ideal;
    double coarser = 1e9;
    for (std::size_t i = 0; i < kResolutions.size(); ++i) {
      const double error = computeMapError(setting, mesh, layers, kResolutions[i]);
      std::printf(" %8.3f", error);
      EXPECT_LT(error, last[i] * 1.02) << layers << " layers of " << kResolutions[i];
      EXPECT_LT(error, coarser * 1.1) << layers << " layers of " << kResolutions[i];
      last[i] = coarser = error;
    }
  }
  std::printf("\n");
  EXPECT_LT(lastIdeal, 0.1);
}

}  // namespace
}  // namespace catoptric::virtual_object
