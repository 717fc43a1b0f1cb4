// SPDX-License-Identifier: Apache-2.0
// Mirrors that bend more than one way: focal distances, the cut into parts, the forecast, and the check of a
// pixel's ray.
#include "catoptric/virtual_object/mixed/mirror_parts.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>

#include "catoptric/geometry/nearest_hit.h"
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/virtual_object/mixed/part_pixels.h"
#include "catoptric/virtual_object/mixed/view_forecast.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

/// z = (a x^2 + b y^2) / 2 over a square around the origin, bright side +z: positive is hollow.
ReflectorMesh makeDish(double a, double b, double half) {
  return meshOf(geometry::makeHeightField(
      41, 41, [half](dvec2 s) { return half * s; },
      [a, b](dvec2 p) {
        return geometry::HeightSample{0.5 * (a * p.x * p.x + b * p.y * p.y), a * p.x, b * p.y};
      }));
}

/// The triangle nearest to the origin.
const MirrorTriangle& middleOf(const ReflectorMesh& mesh) {
  std::size_t best = 0;
  for (std::size_t t = 0; t < mesh.ordinaryCount(); ++t)
    if (glm::length(mesh.triangles()[t].position(1.0 / 3, 1.0 / 3)) <
        glm::length(mesh.triangles()[best].position(1.0 / 3, 1.0 / 3)))
      best = t;
  return mesh.triangles()[best];
}

TEST(FocalDistances, keepTheMirrorEquation) {
  // 1 / eye + 1 / focus = 2 curvature, along each principal direction.
  const dvec3 eye(0, 0, 3);
  const auto expected = [](double curvature) {
    const double inverse = 2 * curvature - 1.0 / 3;
    return inverse > 0 ? 1 / inverse : std::numeric_limits<double>::infinity();
  };
  for (const dvec2 c :
       {dvec2(0.5, 0.5), dvec2(0.9, 0.4), dvec2(-0.5, -0.7), dvec2(-0.6, 0.8), dvec2(0.1, 0.9)}) {
    const auto found = findFocalDistances(middleOf(makeDish(c.x, c.y, 0.1)), eye);
    const double first = std::min(expected(c.x), expected(c.y)),
                 second = std::max(expected(c.x), expected(c.y));
    for (const auto& [value, wanted] : {std::pair(found[0], first), std::pair(found[1], second)}) {
      if (std::isinf(wanted))
        EXPECT_TRUE(std::isinf(value)) << c.x << ' ' << c.y;
      else
        EXPECT_NEAR(value, wanted, 0.02 * wanted) << c.x << ' ' << c.y;
    }
  }
}

TEST(MirrorParts, curvaturesAreThoseOfTheSurface) {
  const auto k = computeCurvatures(middleOf(makeDish(-0.6, 0.8, 0.1)));
  EXPECT_NEAR(k[0], 0.6, 0.01);
  EXPECT_NEAR(k[1], -0.8, 0.01);
}

TEST(MirrorParts, whatBendsOneWayIsOnePart) {
  const std::pair<dvec2, Bend> cases[] = {
      {{-0.5, -0.7}, Bend::Convex}, {{0.5, 0.7}, Bend::Hollow}, {{0.6, -0.8}, Bend::Saddle}};
  for (const auto& [c, bend] : cases) {
    const ReflectorMesh mesh = makeDish(c.x, c.y, 0.3);
    const CutMirror cut = cutIntoParts(mesh);
    ASSERT_EQ(cut.parts.size(), 1u);
    EXPECT_EQ(cut.parts[0].bend, bend);
    EXPECT_EQ(cut.parts[0].mesh->ordinaryCount(), mesh.ordinaryCount());
    EXPECT_TRUE(cut.leftOut.empty());
  }
  EXPECT_TRUE(cutIntoParts(meshOf(geometry::Mesh{})).parts.empty());
}

TEST(MirrorParts, everyTriangleOfAWaveIsInOneOfThem) {
  const ReflectorMesh mesh = meshOf(geometry::makeHeightField(
      60, 20, [](dvec2 s) { return s; },
      [](dvec2 p) {
        const double k = 6;
        return geometry::HeightSample{0.02 * std::sin(k * p.x) * (1 - 0.5 * p.y * p.y),
                                      0.02 * k * std::cos(k * p.x) * (1 - 0.5 * p.y * p.y),
                                      -0.02 * std::sin(k * p.x) * p.y};
      }));
  const CutMirror cut = cutIntoParts(mesh);
  std::size_t triangles = cut.leftOut.size() / 3;
  std::set<Bend> bends;
  for (const MirrorPart& part : cut.parts) {
    triangles += part.corners.size() / 3;
    bends.insert(part.bend);
    if (part.bend == Bend::Convex) {
      EXPECT_TRUE(part.mesh->isConvex());
    }
  }
  EXPECT_EQ(triangles, mesh.ordinaryCount());
  EXPECT_GT(cut.parts.size(), 3u);
  EXPECT_TRUE(bends.contains(Bend::Convex) && bends.size() > 1);
}

/// A wall across the way of the rays of a hollow dish of focal length 1 for an eye at 3.
PartForecast forecastWall(double distance) {
  const float z = float(distance), w = 20;
  const geometry::TriangleHierarchy wall(std::vector<geometry::HierarchyTriangle>{
      {{-w, -w, z}, {w, -w, z}, {0, w, z}, 0, 0, geometry::kTwoSided}});
  const ReflectorMesh mesh = makeDish(2.0 / 3, 2.0 / 3, 0.3);
  const CutMirror cut = cutIntoParts(mesh);
  const std::vector<const MirrorPart*> parts{&cut.parts.at(0)};
  const std::vector<std::uint32_t> partOf{0};
  return forecastView(parts, {wall, partOf, 7}, {0, 0, 3}, 500).at(0);
}

TEST(ViewForecast, tellsWhereThingsLieAtAFocus) {
  EXPECT_GT(forecastWall(0.4).shares[0], 0.99);
  EXPECT_GT(forecastWall(4).shares[2], 0.99);
  EXPECT_TRUE(forecastWall(4).shows(2) && !forecastWall(4).shows(0));
  EXPECT_EQ(forecastWall(4).notFound, 0);
  EXPECT_GT(forecastWall(1).nearFocus, 0.99);
  EXPECT_EQ(forecastWall(1).oneToOne(), 0);
  // A square of 0.6 at 3, 500 pixels for a tangent of 1.
  EXPECT_NEAR(forecastWall(4).pixels, 100.0 * 100.0, 500);
}

TEST(ViewForecast, choosesWhatIsFasterTogether) {
  const ReflectorMesh mesh = makeDish(-0.5, -0.5, 0.3);
  const CutMirror cut = cutIntoParts(mesh);
  const std::vector<const MirrorPart*> parts{&cut.parts.at(0), &cut.parts.at(0)};
  const auto forecast = [](double pixels) { return PartForecast{.pixels = pixels, .shares = {1, 0, 0}}; };
  const auto choose = [&](double first, double second, bool all) {
    return chooseParts(parts, std::vector{forecast(first), forecast(second)}, 10000, all);
  };
  using Chosen = std::vector<std::uint8_t>;
  EXPECT_EQ(choose(1e6, 10, false), (Chosen{1, 0}));  // the second is too small
  EXPECT_EQ(choose(1e6, 10, true), (Chosen{1, 1}));
  const double little = (expectCosts(forecast(0), Bend::Convex, 10000).virtualMs + 4) /
                        expectCosts(forecast(1), Bend::Convex, 10000).boundMs;
  EXPECT_EQ(choose(little, little, false), (Chosen{1, 1}));
  EXPECT_EQ(choose(little, 0, false), (Chosen{0, 0}));  // faster, but not by what parts cost
  PartForecast hidden = forecast(1e6);
  hidden.notFound = 0.2;
  EXPECT_EQ(chooseParts(parts, std::vector{hidden, forecast(1e6)}, 10000, true), (Chosen{0, 1}));
}

TEST(PartPixels, holdEachRayAgainstItsTriangle) {
  // Parallel rays along z, a hundredth apart; one triangle covers x + y < 0.05.
  scene::WorldGeometry world;
  world.positions = {{-1, -1, 2}, {1.05f, -1, 2}, {-1, 1.05f, 2},
                     {-1, -1, 3}, {-0.9f, -1, 3}, {-1, -0.9f, 3}};
  world.indices = {0, 1, 2, 3, 4, 5};
  RayImages rays;
  rays.widthPx = rays.heightPx = 10;
  for (int i = 0; i < 100; ++i) {
    const int column = i % 10, row = i / 10;
    rays.origins.emplace_back(0.01f * float(column), 0.01f * float(row), 0, 0);
    rays.directions.emplace_back(0, 0, 1, 0);
    rays.words.emplace_back(0, i % 10 == 0 ? 1 : 2);
  }
  const auto length = [](float path) { return std::bit_cast<std::uint32_t>(path); };
  NumberImage image{std::vector<uvec2>(100, uvec2(1, length(2))), std::vector<float>(100, 0.5f), {}};
  image.hits[2 * 10 + 2].x = 0;  // nothing drawn
  image.hits[1 * 10 + 1].x = 2;  // a triangle far beside the ray
  std::vector<uvec2> parts(100, uvec2(5, 0));
  parts[3 * 10 + 1].x = 4;  // another part
  MirrorPixels pixels{{0, 0, 10, 10}, 2, parts, {std::vector<uvec2>(100), std::vector<float>(100), {}}};
  pixels.confirmed.hits[0 * 10 + 4] = {9, length(1)};  // nearer
  pixels.confirmed.hits[0 * 10 + 3] = {9, length(3)};  // farther
  confirmPixels(world, rays, {{0, 0, 10, 10}, image, 5}, pixels);
  for (int i = 0; i < 100; ++i) {
    const int x = i % 10, y = i / 10;
    const bool isMirror = x > 0, isDrawn = !(x == 2 && y == 2), isOther = x == 1 && (y == 1 || y == 3),
               isBehind = x == 4 && y == 0;
    const std::uint32_t number = pixels.confirmed.hits[std::size_t(i)].x;
    if (x + y <= 5) {
      EXPECT_EQ(number == 1, isMirror && isDrawn && !isOther && !isBehind) << x << ' ' << y;
    }
    if (x + y >= 8) {
      EXPECT_EQ(number, 0u) << x << ' ' << y;
    }
  }
  EXPECT_EQ(pixels.confirmed.hits[4].x, 9u);
}

}  // namespace
}  // namespace catoptric::virtual_object
