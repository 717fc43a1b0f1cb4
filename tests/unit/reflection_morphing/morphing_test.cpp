// SPDX-License-Identifier: Apache-2.0
// Maps, octrees, look-ups and morphing against rays of which everything is known.
#include "catoptric/reflection_morphing/morphing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "catoptric/core/parallel.h"
#include "catoptric/reflection_morphing/find_ray.h"
#include "mirror_world.h"

namespace catoptric::reflection_morphing {
namespace {

using namespace test;

const dvec3 kEye(0.4, 0.3, 2.1);

struct Quantiles {
  double median = 0, p95 = 0;
};

Quantiles summarise(std::vector<double> values, const char* name) {
  if (values.empty()) return {1e9, 1e9};
  std::sort(values.begin(), values.end());
  const Quantiles q{values[values.size() / 2], values[values.size() * 95 / 100]};
  std::printf("%-28s %6zu points: median %.4f p95 %.4f largest %.3f px\n", name, values.size(), q.median,
              q.p95, values.back());
  return q;
}

const OctreeRay& findNearest(const SampledTrace& trace, const dvec3& q) {
  return findNearestRay(trace.octree, trace.octree.findLeaf(vec3(q)), vec3(q));
}

FoundRay lookUp(const SampledTrace& trace, const dvec3& q) {
  const OctreeRay& ray = findNearest(trace, q);
  return findRay(trace.table, vec3(q), {ray.x, ray.y});
}

TEST(RayMap, raysObeyTheMirrorLaw) {
  const scene::WorldGeometry world = makeSphereWorld();
  const auto maps = traceRayMaps(MirrorRays(world), kEye, {64, 1});
  ASSERT_EQ(maps.size(), 1u);
  EXPECT_EQ(maps[0].trace, Trace{0});
  for (std::size_t i = 0; i < maps[0].texels.size(); ++i) {
    if (maps[0].states[i] != TexelState::Ray) continue;
    const RayTexel& texel = maps[0].texels[i];
    const dvec3 normal = glm::normalize(dvec3(texel.origin)),
                view = glm::normalize(dvec3(texel.origin) - kEye);
    EXPECT_NEAR(glm::length(texel.origin), 0.5f, 1e-3f);  // facets
    EXPECT_LT(glm::length(dvec3(texel.direction) - core::reflectDirection(view, normal)), 5e-3);
  }
  EXPECT_GT(maps[0].countRays(), 64u * 64u * 6 / 10);  // the window fits the disc
}

TEST(RayMap, nothingIsSeenFromInsideAMirrorOrWithoutMirrors) {
  const scene::WorldGeometry world = makeSphereWorld(), empty = makeMirrorWorld({});
  EXPECT_TRUE(makeLocation(MirrorRays(world), dvec3(0.1, 0, 0), makeOptions(world, 32))->traces.empty());
  EXPECT_TRUE(makeLocation(MirrorRays(empty), kEye, makeOptions(empty, 32))->traces.empty());
}

TEST(RayOctree, everyPointFindsARayAndLeavesAreModest) {
  const scene::WorldGeometry world = makeSphereWorld();
  const auto location = makeLocation(MirrorRays(world), kEye, makeOptions(world));
  ASSERT_EQ(location->traces.size(), 1u);
  const RayOctree& octree = location->traces[0].octree;
  EXPECT_GT(measure(octree).leaves, 1000u);
  EXPECT_LE(measure(octree).mostRays, 12u);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-5, 5);  // also outside of the box
  for (int i = 0; i < 1000; ++i)
    EXPECT_GE(octree.findLeaf({uniform(random), uniform(random), uniform(random)}).size(), 1u);
}

TEST(FindRay, findsTheRayThatPassesThroughAPoint) {
  const scene::WorldGeometry world = makeSphereWorld();
  const MirrorRays rays(world);
  const auto location = makeLocation(rays, kEye, makeOptions(world));
  const SampledTrace& trace = location->traces.at(0);
  std::vector<double> errors, nearest;
  std::size_t inside = 0, wrongLengths = 0;
  const auto points = makeKnownPoints(rays, kEye, {0}, 3000, 7);
  for (const KnownPoint& known : points) {
    const FoundRay found = lookUp(trace, known.scenePoint);
    inside += found.isInside ? 1 : 0;
    errors.push_back(measurePixels(kEye, dvec3(found.mirrorPoint), known.mirrorPoint, world.reflectors[0]));
    const double length = glm::length(dvec3(found.mirrorPoint) - kEye) + double(found.rest);
    wrongLengths += std::abs(length - known.pathLength) > 0.002 ? 1 : 0;
    nearest.push_back(measurePixels(kEye, dvec3(findNearest(trace, known.scenePoint).origin),
                                    known.mirrorPoint, world.reflectors[0]));
  }
  const Quantiles q = summarise(errors, "one location");
  EXPECT_LT(q.median, 0.05);
  EXPECT_LT(q.p95, 0.5);
  EXPECT_GT(inside, points.size() * 97 / 100);
  EXPECT_LT(wrongLengths, points.size() / 100);
  // The twin that must fail: the nearest ray of the leaf, as published.
  EXPECT_GT(summarise(nearest, "nearest ray, as published").median, 1.0);
}

TEST(FindRay, aSeedNearbyGivesTheSameRay) {
  const scene::WorldGeometry world = makeSphereWorld();
  const MirrorRays rays(world);
  const auto location = makeLocation(rays, kEye, makeOptions(world, 128));
  const SampledTrace& trace = location->traces.at(0);
  std::size_t seeds = 0, same = 0;
  for (const KnownPoint& known : makeKnownPoints(rays, kEye, {0}, 200, 3)) {
    const vec3 q(known.scenePoint);
    const FoundRay first = lookUp(trace, known.scenePoint);
    if (!first.isInside) continue;
    const OctreeRay& nearest = findNearest(trace, known.scenePoint);
    for (const vec2& offset : {vec2(3, 0), vec2(-3, 0), vec2(0, 3), vec2(0, -3)}) {
      const vec2 seed = vec2(nearest.x, nearest.y) + offset;
      if (!trace.table.isFilled(seed)) continue;
      ++seeds;
      same += glm::length(findRay(trace.table, q, seed).mirrorPoint - first.mirrorPoint) < 1e-3f ? 1 : 0;
    }
  }
  EXPECT_GT(seeds, 500u);
  EXPECT_GE(same, seeds * 98 / 100);  // from the very rim the first step may be too long
}

TEST(FindRay, pointsInTheShadowAreNotReflected) {
  const scene::WorldGeometry world = makeSphereWorld();
  const auto location = makeLocation(MirrorRays(world), kEye, makeOptions(world));
  for (const double behind : {0.8, 1.2, 2.0})
    EXPECT_FALSE(lookUp(location->traces.at(0), -behind * glm::normalize(kEye)).isInside);
}

TEST(FindRay, overTwoMirrors) {
  const scene::WorldGeometry world = makeTwoSpheres();
  const MirrorRays rays(world);
  const auto location = makeLocation(rays, kEye, makeOptions(world, 256, 5, 2));
  for (const Trace& trace : {Trace{0, 1}, Trace{1, 0}}) {
    const SampledTrace* sampled = location->findTrace(trace);
    ASSERT_NE(sampled, nullptr);
    std::vector<double> errors;
    for (const KnownPoint& known : makeKnownPoints(rays, kEye, trace, 1000, 5))
      errors.push_back(measurePixels(kEye, dvec3(lookUp(*sampled, known.scenePoint).mirrorPoint),
                                     known.mirrorPoint, world.reflectors[trace[0]]));
    EXPECT_LT(summarise(errors, "two mirrors").median, 0.1);
  }
}

/// What is seen in a ball of glass of 0.4 m, as far as it lies behind the focus.
TEST(FindRay, throughABallOfGlass) {
  scene::WorldGeometry world = makeMirrorWorld({makeSphereAt(dvec3(0), 0.4)});
  world.reflectors[0].ior = 1.5f;
  EXPECT_EQ(listMapped(world), std::vector<std::uint32_t>{0});  // unless it is asked for
  world.reflectors[0].morphed = true;
  EXPECT_TRUE(listMapped(world).empty());
  const MirrorRays rays(world);
  // Snell's law once: along the axis nothing bends, and the paraxial focus lies at n R / (2 (n - 1)).
  const Trace through{0, 0};
  for (const double offset : {0.0, 0.01}) {
    std::size_t seen = 0;
    rays.follow({offset, 0, 2}, {0, 0, -1}, 1, 64, [&](const ReflectedRay& ray) {
      ++seen;
      EXPECT_EQ(ray.trace, through);
      EXPECT_NEAR(ray.between, 0.8, 1e-3);
      if (offset > 0) {
        EXPECT_NEAR(ray.origin.z + ray.direction.z * ray.origin.x / -ray.direction.x, -0.6, 0.01);
      }
    });
    EXPECT_EQ(seen, 1u);
  }
  const auto location = makeLocation(rays, kEye, makeOptions(world));
  ASSERT_EQ(location->traces.size(), 1u);
  const SampledTrace* sampled = location->findTrace(through);
  ASSERT_NE(sampled, nullptr);
  std::vector<double> errors;
  for (const KnownPoint& known : makeKnownPoints(rays, kEye, through, 2000, 5))
    if (glm::length(known.scenePoint) > 1)
      errors.push_back(measurePixels(kEye, dvec3(lookUp(*sampled, known.scenePoint).mirrorPoint),
                                     known.mirrorPoint, world.reflectors[0]));
  EXPECT_GT(errors.size(), 500u);
  EXPECT_LT(summarise(errors, "through a ball of glass").median, 0.1);
}

/// Cells around the eye.
struct Cells {
  Cells(const MirrorRays& rays, const glm::uvec3& counts, double edge, const BakeOptions& options) {
    const dvec3 lower = kEye - 0.37 * edge;
    grid = {{lower, lower + edge * dvec3(counts - 1u)}, counts};
    for (std::uint32_t i = 0; i < grid.locationCount(); ++i)
      locations.push_back(makeLocation(rays, grid.location(i), options));
  }
  struct Morphed {
    std::vector<vec3> drawn;
    std::vector<raster::VertexKind> kinds;
  };
  /// Virtual vertices for an eye with the weights of `cell`.
  [[nodiscard]] Morphed morph(const SamplingCell& cell, const dvec3& eye,
                              const std::vector<vec3>& points) const {
    CellTrace trace{};
    for (std::size_t k = 0; k < 8; ++k) trace[k] = locations[cell.locations[k]]->findTrace({0});
    CornerPoints corners;
    lookUpCorners(trace, points, {}, corners);
    std::vector<vec3> drawn(points.size()), mirror(points.size());
    morphVertices(vec3(eye), weighTrace(trace, cell.weights), corners, drawn, mirror);
    return {drawn, corners.kinds};
  }
  SamplingGrid grid;
  std::vector<std::shared_ptr<const SamplingLocation>> locations;
};

TEST(Morphing, insideACellAndContinuousAcrossItsSides) {
  const scene::WorldGeometry world = makeSphereWorld();
  const MirrorRays rays(world);
  const Cells cells(rays, {3, 2, 2}, 0.15, makeOptions(world));
  const auto known = makeKnownPoints(rays, kEye, {0}, 2000, 11);
  std::vector<vec3> points;
  points.reserve(known.size());
  for (const KnownPoint& k : known) points.emplace_back(k.scenePoint);
  const auto cell = cells.grid.findCell(kEye);
  ASSERT_TRUE(cell);
  const auto drawn = cells.morph(*cell, kEye, points).drawn;
  std::vector<double> errors;
  for (std::size_t i = 0; i < known.size(); ++i)
    errors.push_back(measurePixels(kEye, dvec3(drawn[i]), known[i].mirrorPoint, world.reflectors[0]));
  const Quantiles q = summarise(errors, "inside a cell of 0.15 m");
  EXPECT_LT(q.median, 0.25);
  EXPECT_LT(q.p95, 2.0);

  // The side that two cells share: weights of one cell or of the other, the same picture.
  const dvec3 onSide(cells.grid.location(1).x, kEye.y, kEye.z);
  const SamplingCell left = *cells.grid.findCell(onSide - dvec3(1e-9, 0, 0)),
                     right = *cells.grid.findCell(onSide + dvec3(1e-9, 0, 0));
  EXPECT_NE(left.locations, right.locations);
  const auto a = cells.morph(left, onSide, points), b = cells.morph(right, onSide, points);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (a.kinds[i] != raster::VertexKind::Reflected || b.kinds[i] != raster::VertexKind::Reflected) continue;
    ++compared;
    EXPECT_LT(glm::length(a.drawn[i] - b.drawn[i]), 1e-4f);
  }
  EXPECT_GT(compared, points.size() * 99 / 100);
}

TEST(Morphing, onlyCornersOfReflectedTrianglesArePlaced) {
  const scene::WorldGeometry world = makeSphereWorld();
  const MirrorRays rays(world);
  const Cells cells(rays, {2, 2, 2}, 0.15, makeOptions(world, 128));
  CellTrace trace{};
  for (std::size_t k = 0; k < 8; ++k) trace[k] = cells.locations[k]->findTrace({0});
  // In front of the mirror, beside its shadow, and two in the shadow.
  const dvec3 behind = -glm::normalize(kEye);
  const std::vector<vec3> points{vec3(0.6f, 0.5f, 0.8f), vec3(-0.9f, 0.6f, 0.2f), vec3(1.5 * behind),
                                 vec3(1.7 * behind)};
  using enum raster::VertexKind;
  CornerPoints corners;
  lookUpCorners(trace, points, {}, corners);
  EXPECT_EQ(corners.kinds, (std::vector{Reflected, Reflected, None, None}));
  const std::vector<std::uint32_t> indices{0, 1, 2, 2, 3, 2};
  lookUpCorners(trace, points, indices, corners);
  EXPECT_EQ(corners.kinds, (std::vector{Reflected, Reflected, DoublyVirtual, None}));
  lookUpCorners({}, points, indices, corners);
  EXPECT_EQ(corners.kinds, (std::vector{None, None, None, None}));
}

TEST(Morphing, whatLocationsSeeAllAroundTheRimIsDropped) {
  const scene::WorldGeometry world = makeSphereWorld();
  const MirrorRays rays(world);
  const Cells cells(rays, {2, 2, 2}, 1.4,
                    makeOptions(world, 128));  // coarse: each location has its own shadow
  CellTrace trace{};
  dvec3 middle(0);
  for (std::size_t k = 0; k < 8; ++k) {
    trace[k] = cells.locations[k]->findTrace({0});
    middle += 0.125 * cells.locations[k]->position;
  }
  const vec3 behind(-3.5 * glm::normalize(middle)), beside(-behind.z, 0, behind.x);
  // A triangle with a corner that is reflected: the others are placed where they can be.
  CornerPoints corners;
  const std::vector<std::uint32_t> indices{0, 1, 1};
  lookUpCorners(trace, std::vector{behind, beside}, indices, corners);
  EXPECT_EQ(corners.kinds[0], raster::VertexKind::None);
  EXPECT_EQ(corners.kinds[1], raster::VertexKind::Reflected);
}

TEST(Morphing, doesNotDependOnTheNumberOfThreads) {
  const scene::WorldGeometry world = makeSphereWorld();
  const MirrorRays rays(world);
  const Cells cells(rays, {2, 2, 2}, 0.15, makeOptions(world, 64));
  std::vector<vec3> points;
  for (const KnownPoint& k : makeKnownPoints(rays, kEye, {0}, 5000, 13)) points.emplace_back(k.scenePoint);
  const auto cell = cells.grid.findCell(kEye);
  core::setThreadCount(1);
  const auto one = cells.morph(*cell, kEye, points);
  core::setThreadCount(3);
  const auto three = cells.morph(*cell, kEye, points);
  core::setThreadCount(0);
  EXPECT_EQ(one.kinds, three.kinds);
  EXPECT_EQ(one.drawn, three.drawn);
}

TEST(Morphing, aTraceThatFewLocationsSeeHasNoWeight) {
  const SampledTrace sampled;
  std::array<float, 8> even{};
  even.fill(0.125f);
  CellTrace trace{};
  trace[3] = &sampled;
  EXPECT_EQ(weighTrace(trace, even)[3], 0.0f);
  trace[4] = &sampled;
  EXPECT_FLOAT_EQ(weighTrace(trace, even)[3], 0.5f);
}

TEST(SamplingGrid, isAsFineAsTheErrorAsks) {
  const scene::WorldGeometry world = makeSphereWorld();
  const core::Box far{dvec3(-1, 0, 2), dvec3(1, 1, 3)}, around{dvec3(-1), dvec3(1)};
  const double spacing = findSpacing(world, far, 0.5);
  EXPECT_NEAR(spacing, 2 * std::sqrt(0.5 / 33), 1e-9);  // the box is 2 m away
  EXPECT_NEAR(findSpacing(world, far, 0.125), 0.5 * spacing, 1e-9);
  EXPECT_NEAR(findSpacing(world, around, 0.5), spacing * world.reflectors[0].radius / 2, 1e-9);  // no nearer
  EXPECT_EQ(findSpacing(makeMirrorWorld({}), far, 0.5), 0);
  EXPECT_EQ(makeGrid(far, 0.3, 64).counts, glm::uvec3(8, 5, 5));
  EXPECT_EQ(makeGrid(far, 0.3, 4).counts, glm::uvec3(5));
  EXPECT_EQ(makeGrid(far, 0, 64).counts, glm::uvec3(2));
  for (const dvec3& eye : {dvec3(0.4, 0.3, 2.1), dvec3(-700, 3, 80), dvec3(0)}) {
    const SamplingGrid grid = makePlanAround(world, eye).grid;
    EXPECT_TRUE(grid.findCell(eye));
    EXPECT_LE(grid.spacing().x, findSpacing(world, {eye, eye}, 0.5));
    EXPECT_LT(grid.locationCount(), std::uint64_t(1) << 32);
  }
}

TEST(SamplingGrid, weightsAddUpAndEndAtTheBox) {
  const SamplingGrid grid{{dvec3(-1), dvec3(1)}, {3, 4, 5}};
  for (const dvec3& eye : {dvec3(-1), dvec3(1), dvec3(0.3, -0.2, 0.9), dvec3(0)}) {
    const auto cell = grid.findCell(eye);
    ASSERT_TRUE(cell);
    dvec3 at(0);
    for (std::size_t k = 0; k < 8; ++k) at += double(cell->weights[k]) * grid.location(cell->locations[k]);
    EXPECT_LT(glm::length(at - eye), 1e-6);
  }
  EXPECT_FALSE(grid.findCell({1.001, 0, 0}));
  EXPECT_FALSE(grid.findCell({std::nan(""), 0, 0}));
}

}  // namespace
}  // namespace catoptric::reflection_morphing
