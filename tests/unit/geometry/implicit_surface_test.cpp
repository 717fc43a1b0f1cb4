// SPDX-License-Identifier: Apache-2.0
// Surfaces by equations: derivatives are those of the value, and tori and aspheric mirrors are found in
// meshes that were turned and moved, whole or in pieces, with normals as exporters write them.
#include "catoptric/geometry/implicit_surface.h"

#include <gtest/gtest.h>

#include <random>

#include "catoptric/geometry/aspheric_mirror.h"
#include "catoptric/geometry/quadric.h"
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/geometry/torus.h"

namespace catoptric::geometry {
namespace {

MeshView view(const Mesh& mesh) {
  return {mesh.positions, mesh.normals, mesh.indices};
}

dmat4 somewhere() {
  return moveBy({3, -2, 1}) * turnAround(glm::normalize(dvec3(1, 2, -1)), 1.1);
}

struct Profile {
  double c, k, a4, a6;

  [[nodiscard]] HeightSample at(dvec2 p) const {  // by the textbook's formula
    const double u = glm::dot(p, p), root = std::sqrt(1 - (1 + k) * c * c * u);
    const double slope = c / root + 4 * a4 * u + 6 * a6 * u * u;
    return {c * u / (1 + root) + u * u * (a4 + a6 * u), slope * p.x, slope * p.y};
  }
};

/// The square of this half width around a point beside the axis, front towards +z.
Mesh makeAspheric(const Profile& profile, double half, dvec2 middle = dvec2(0)) {
  return makeHeightField(
      20, 20, [=](dvec2 at) { return middle + half * at; }, [=](dvec2 p) { return profile.at(p); });
}

/// Turned by about so many radians.
void roughenNormals(Mesh& mesh, float angle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (vec3& n : mesh.normals)
    n = glm::normalize(n + angle * vec3(uniform(random), uniform(random), uniform(random)));
}

void checkDerivatives(const ImplicitSurface& surface, const dvec3& p) {
  for (int k = 0; k < 3; ++k) {
    dvec3 step(0);
    step[k] = 1e-5;
    const double slope = (surface.value(p + step) - surface.value(p - step)) / 2e-5;
    EXPECT_NEAR(slope, surface.gradient(p)[k], 1e-7);
    const dvec3 bend = (surface.gradient(p + step) - surface.gradient(p - step)) / 2e-5;
    EXPECT_LT(glm::distance(bend, surface.hessian(p)[k]), 1e-6);
  }
}

TEST(ImplicitSurface, DerivativesAreThoseOfTheValue) {
  AsphericMirror aspheric;
  aspheric.frame = AxisFrame{}.moved({0.2, -0.3}, {0.1, 0.2, -0.1});
  aspheric.scale = 0.8, aspheric.curvature = -0.7, aspheric.conic = -0.4, aspheric.a4 = 0.2,
  aspheric.a6 = -0.1;
  Torus torus;
  torus.frame = aspheric.frame;
  Torus hollow = torus;
  hollow.isInside = true;
  Quadric quadric;
  quadric.a = dmat3(1, 0.2, 0.1, 0.2, -0.5, 0.3, 0.1, 0.3, 2), quadric.b = {0.3, 0.1, -1}, quadric.c = 0.2;
  const std::vector<const ImplicitSurface*> surfaces{&aspheric, &torus, &hollow, &quadric};
  for (const ImplicitSurface* surface : surfaces)
    for (const dvec3& p : {dvec3(0.3, 0.2, -0.4), dvec3(-0.5, 0.6, 0.1)}) checkDerivatives(*surface, p);
}

TEST(ImplicitSurface, ProjectsAlongTheGradient) {
  Torus torus;
  const dvec3 on = torus.project({0.9, 0.8, 0.15});
  EXPECT_NEAR(torus.value(on), 0, 1e-13);
  EXPECT_NEAR(std::hypot(std::hypot(on.x, on.y) - 1, on.z), 0.25, 1e-12);
}

TEST(AsphericFit, FindsWholeMirrorsRingsAndPieces) {
  // The wing mirror, a deep bulge, a hollow mirror, a Schmidt plate without a sphere in it.
  const Profile profiles[] = {
      {-0.77, -3, -1, -10}, {-1.5, 0.3, 0.2, 0.1}, {0.8, -0.5, 0.25, -0.2}, {0, 0, 0.3, 0.05}};
  for (const Profile& profile : profiles)
    for (const dvec2& middle : {dvec2(0), dvec2(0.2, 0.1)}) {
      const double half = profile.c == -0.77 ? 0.14 : 0.22;
      const Mesh mesh = transformed(makeAspheric(profile, half, middle), somewhere());
      const auto found = fitAsphericMirror(view(mesh));
      ASSERT_TRUE(found) << profile.c;
      EXPECT_LT(found->deviation.distance, 3e-6) << profile.c << " at " << middle.x;
      EXPECT_LT(found->deviation.angleRadians, 1e-3) << profile.c << " at " << middle.x;
    }
}

TEST(AsphericFit, FindsTheAxisAndTheCoefficients) {
  const Profile profile{-1.5, 0.3, 0.2, 0.1};
  const auto found = fitAsphericMirror(view(transformed(makeAspheric(profile, 0.37), somewhere())));
  ASSERT_TRUE(found);
  const AsphericMirror& m = found->mirror;
  EXPECT_LT(glm::distance(m.frame.origin, dvec3(somewhere()[3])), 1e-5);
  EXPECT_LT(glm::distance(m.frame.axes[2], dvec3(somewhere()[2])), 1e-5);
  EXPECT_NEAR(m.curvature / m.scale, profile.c, 1e-4);
  EXPECT_NEAR(m.conic, profile.k, 1e-3);
  EXPECT_NEAR(m.a4 / std::pow(m.scale, 3), profile.a4, 1e-3);
  EXPECT_NEAR(m.a6 / std::pow(m.scale, 5), profile.a6, 1e-2);
}

TEST(AsphericFit, ForgivesNormalsComputedFromFacets) {
  Mesh mesh = makeAspheric({-0.77, -3, -1, -10}, 0.14);
  roughenNormals(mesh, 5e-3f);
  const auto found = fitAsphericMirror(view(mesh));
  ASSERT_TRUE(found);
  EXPECT_LT(found->deviation.distance, 3e-6);
  EXPECT_LT(found->deviation.angleRadians, 1.2e-2);
}

TEST(AsphericFit, IsAbsentOrFarOffElsewhere) {
  const auto wave = fitAsphericMirror(view(makeHeightField(
      20, 20, [](dvec2 at) { return at; },
      [](dvec2 at) {
        return HeightSample{0.1 * std::sin(3 * at.x), 0.3 * std::cos(3 * at.x), 0};
      })));
  EXPECT_TRUE(!wave || wave->deviation.distance > 0.01);
  const auto ellipsoid = fitAsphericMirror(view(makeHeightField(
      20, 20, [](dvec2 at) { return 0.5 * at; },
      [](dvec2 at) {
        return HeightSample{-0.5 * at.x * at.x - 0.3 * at.y * at.y, -at.x, -0.6 * at.y};
      })));
  EXPECT_TRUE(!ellipsoid || ellipsoid->deviation.distance > 0.005);
  EXPECT_FALSE(fitAsphericMirror(view(makePlane(1, 1, 1, 1))));  // four vertices
  EXPECT_FALSE(fitAsphericMirror({}));
}

/// The part of a torus around y whose angle around the axis is below a limit.
Mesh cutRing(const Mesh& ring, double angle) {
  Mesh piece = ring;
  piece.indices.clear();
  for (std::size_t i = 0; i < ring.indices.size(); i += 3) {
    const vec3& p = ring.positions[ring.indices[i]];
    if (std::abs(std::atan2(p.z, p.x)) < angle)
      piece.indices.insert(piece.indices.end(), ring.indices.begin() + i, ring.indices.begin() + i + 3);
  }
  Mesh tight;
  for (const std::uint32_t i : piece.indices) {
    tight.indices.push_back(std::uint32_t(tight.positions.size()));
    tight.positions.push_back(ring.positions[i]);
    tight.normals.push_back(ring.normals[i]);
  }
  return tight;
}

TEST(TorusFit, FindsRingsAndPiecesOfThem) {
  const Mesh ring = makeTorus(0.5, 0.2, 48, 24);
  for (const Mesh& mesh : {ring, cutRing(ring, 0.6)}) {
    const Mesh placed = transformed(mesh, somewhere());
    const auto found = fitTorus(view(placed));
    ASSERT_TRUE(found);
    EXPECT_LT(found->deviation.distance, 1e-6);
    EXPECT_LT(found->deviation.angleRadians, 1e-4);
    EXPECT_NEAR(found->torus.majorRadius, 0.5, 1e-5);
    EXPECT_NEAR(found->torus.minorRadius, 0.2, 1e-5);
    EXPECT_FALSE(found->torus.isInside);
    EXPECT_NEAR(std::abs(glm::dot(found->torus.frame.axes[2], dvec3(somewhere()[1]))), 1, 1e-9);
  }
}

TEST(TorusFit, FindsBarrelsAndHollowSides) {
  // A mirror of two radii: 0.4 around the axis in the middle, 1.1 along it. The circle reaches across the
  // axis.
  const auto bulge = [](double y) {
    const double s = y - 0.3, root = std::sqrt(1.21 - s * s);
    return RadiusSample{0.4 - 1.1 + root, -s / root};
  };
  Mesh barrel = makeRevolvedSide(0.6, 48, 16, bulge);
  for (const bool isTurned : {false, true}) {
    if (isTurned)
      for (vec3& n : barrel.normals) n = -n;
    const auto found = fitTorus(view(barrel));
    ASSERT_TRUE(found);
    EXPECT_LT(found->deviation.distance, 1e-6);
    EXPECT_LT(found->deviation.angleRadians, 1e-4);
    EXPECT_TRUE(found->torus.isSpindle);
    EXPECT_TRUE(found->torus.isOnSheet({0.4, 0.3, 0}));
    EXPECT_FALSE(found->torus.isOnSheet({1.8, 0.3, 0}));
    EXPECT_NEAR(found->torus.majorRadius, 0.7, 1e-5);
    EXPECT_NEAR(found->torus.minorRadius, 1.1, 1e-5);
  }
}

TEST(TorusFit, IsAbsentOrFarOffElsewhere) {
  const auto aspheric = fitTorus(view(makeAspheric({-0.8, 0.4, -0.3, -0.25}, 0.42)));
  EXPECT_TRUE(!aspheric || aspheric->deviation.distance > 1e-3);
  EXPECT_FALSE(fitTorus(view(makePlane(1, 1, 4, 4))));
  EXPECT_FALSE(fitTorus({}));
}

}  // namespace
}  // namespace catoptric::geometry
