// SPDX-License-Identifier: Apache-2.0
#include "implicit_cases.h"

#include <gtest/gtest.h>

#include "catoptric/geometry/aspheric_mirror.h"
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/geometry/torus.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kHalfTurn = 3.141592653589793, kPole = 1e-6;

using Height = std::function<geometry::HeightSample(dvec2)>;

/// z = height(x, y) over a square.
ImplicitCase makeGraph(const char* name, double half, const Height& height, bool isTurned = false,
                       Family family = Family::Quadric) {
  ImplicitCase c{name,
                 geometry::makeHeightField(
                     24, 24, [=](dvec2 at) { return half * at; }, height),
                 {},
                 dvec2(-half),
                 dvec2(half)};
  c.place = [=](const dvec2& at) {
    const geometry::HeightSample h = height(at);
    return PatchPoint{{at, h.z}, glm::normalize(dvec3(1, 0, h.dzdx)), glm::normalize(dvec3(0, 1, h.dzdy))};
  };
  c.isTurned = isTurned;
  c.family = family;
  return c;
}

ImplicitCase makeDish(const char* name, double curvatureX, double curvatureY) {  // z = cx x^2 + cy y^2
  return makeGraph(name, 0.6, [=](dvec2 at) {
    return geometry::HeightSample{curvatureX * at.x * at.x + curvatureY * at.y * at.y, 2 * curvatureX * at.x,
                                  2 * curvatureY * at.y};
  });
}

/// z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + a4 r^4 + a6 r^6 within r = 0.6, by the textbook's formula.
ImplicitCase makeAspheric(const char* name, double c, double k, double a4, double a6, bool isTurned = false) {
  const Height height = [=](dvec2 at) {
    const double u = glm::dot(at, at), root = std::sqrt(1 - (1 + k) * c * c * u);
    const double slope = c / root + 4 * a4 * u + 6 * a6 * u * u;  // over r
    return geometry::HeightSample{c * u / (1 + root) + u * u * (a4 + a6 * u), slope * at.x, slope * at.y};
  };
  return makeGraph(name, 0.42, height, isTurned, Family::Aspheric);
}

ImplicitCase makeBall(const char* name, const dvec3& half, bool isTurned, double reach) {
  ImplicitCase c{name,
                 stretch(geometry::makeIcosphere(1, 12), half),
                 {},
                 {0, kPole},
                 {2 * kHalfTurn, kHalfTurn - kPole}};
  c.place = [=](const dvec2& at) {
    const double s = std::sin(at.y), t = std::cos(at.y), cosine = std::cos(at.x), sine = std::sin(at.x);
    return PatchPoint{half * dvec3(s * cosine, s * sine, t), glm::normalize(half * dvec3(-sine, cosine, 0)),
                      glm::normalize(half * dvec3(t * cosine, t * sine, -s))};
  };
  c.isTurned = isTurned;
  c.isClosed = true;
  c.reach = reach;
  return c;
}

ImplicitCase makeRing(const char* name, bool isTurned, double reach) {
  constexpr double kMajor = 0.5, kMinor = 0.2;  // around y
  ImplicitCase c{name, geometry::makeTorus(kMajor, kMinor, 64, 32), {}, dvec2(0), dvec2(2 * kHalfTurn)};
  c.place = [=](const dvec2& at) {
    const dvec3 out(std::cos(at.x), 0, std::sin(at.x)), up(0, 1, 0);
    const double cosine = std::cos(at.y), sine = std::sin(at.y);
    return PatchPoint{(kMajor + kMinor * cosine) * out + kMinor * sine * up,
                      {-std::sin(at.x), 0, std::cos(at.x)},
                      -sine * out + cosine * up};
  };
  c.isTurned = isTurned;
  c.isClosed = true;
  c.isWithin = isTurned;
  c.reach = reach;
  c.family = Family::Torus;
  return c;
}

}  // namespace

std::vector<ImplicitCase> makeImplicitCases() {
  return {makeBall("ellipsoid outside", {0.7, 0.5, 0.4}, false, 4),
          makeBall("ellipsoid inside", {0.7, 0.5, 0.4}, true, 0.38),
          makeDish("dish", 0.5, 0.35),
          makeDish("saddle", 0.4, -0.3),
          makeDish("bump", -0.5, -0.2),
          makeRing("torus outside", false, 4),
          makeRing("torus near", false, 1),
          makeRing("torus inside", true, 0.7),
          makeAspheric("aspheric bulge", -0.8, 0.4, -0.3, -0.25),
          makeAspheric("aspheric hollow", 0.8, -0.5, 0.25, -0.2),
          makeAspheric("aspheric turned", -0.8, 0.4, -0.3, -0.25, true)};
}

Surface fitSurface(const ImplicitCase& c) {
  const geometry::MeshView mesh{c.mesh.positions, c.mesh.normals, c.mesh.indices};
  const auto keep = [&](const auto& found, auto member) -> Surface {
    EXPECT_TRUE(found.has_value()) << c.name;
    EXPECT_LT(found->deviation.distance, 1e-6) << c.name;
    using Found = std::remove_cvref_t<decltype((*found).*member)>;
    return std::make_shared<Found>((*found).*member);
  };
  if (c.family == Family::Torus) return keep(geometry::fitTorus(mesh), &geometry::TorusFit::torus);
  if (c.family == Family::Aspheric)
    return keep(geometry::fitAsphericMirror(mesh), &geometry::AsphericFit::mirror);
  return keep(geometry::fitQuadric(mesh), &geometry::QuadricFit::quadric);
}

Pair randomPair(std::mt19937& random, const ImplicitCase& c, const Surface& surface) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto place = [&] {
    while (true) {
      const dvec3 at = c.reach * std::cbrt(uniform(random)) * randomDirection(random);
      if (!c.isWithin || surface->value(at) < 0) return at;
    }
  };
  const dvec3 eye = place();
  return {eye, place()};
}

geometry::Quadric makeEllipsoid(const dvec3& half) {
  geometry::Quadric q;
  for (int k = 0; k < 3; ++k) q.a[k][k] = 1 / (half[k] * half[k]);
  q.c = -1;
  return q;
}

geometry::Mesh stretch(geometry::Mesh mesh, const dvec3& half) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.positions[i] *= vec3(half);
    mesh.normals[i] = glm::normalize(mesh.normals[i] / vec3(half));
  }
  return mesh;
}

}  // namespace catoptric::virtual_object
