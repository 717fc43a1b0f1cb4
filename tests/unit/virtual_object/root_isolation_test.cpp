// SPDX-License-Identifier: Apache-2.0
// What the isolation of reflections stands on: patches leave no place of a mirror out, at any size, and how
// fast their bends change is bounded as they say; and pairs with a whole curve of reflections.
#include "catoptric/virtual_object/root_isolation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "catoptric/virtual_object/implicit_reflector.h"
#include "implicit_cases.h"
#include "special_cases.h"

namespace catoptric::virtual_object {
namespace {

MongePatches coverCase(const ImplicitCase& c, const Surface& surface) {
  return {surface, c.isTurned ? -1.0 : 1.0, 0.7, c.mesh.positions, c.mesh.indices};
}

dvec3 placeAtRandom(std::mt19937& random, const ImplicitCase& c, const Surface& surface) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const dvec2 share(uniform(random), uniform(random));
  return surface->project(c.place(glm::mix(c.lower, c.upper, share)).at);
}

bool holds(const MongePatches& patches, const MongePatch& patch, const dvec3& at) {
  const dvec3 local = patches.frameOf(patch).toLocal(at);
  const dvec2 off = glm::abs(dvec2(local) - patch.middle);
  if (off.x > patch.half.x * (1 + 1e-9) || off.y > patch.half.y * (1 + 1e-9)) return false;
  const auto there = patches.move(patch, dvec2(local), patch.half);
  return there && std::abs(there->height - local.z) < 1e-9;  // not the other side of a tube
}

std::vector<MongePatch> splitOnce(const MongePatches& patches, std::span<const MongePatch> all) {
  std::vector<MongePatch> parts;
  for (const MongePatch& patch : all) patches.split(patch, parts);
  return parts;
}

TEST(MongePatches, LeaveNoPlaceOut) {
  for (const ImplicitCase& c : makeImplicitCases()) {
    const Surface surface = fitSurface(c);
    const MongePatches patches = coverCase(c, surface);
    std::mt19937 random(4);
    for (int i = 0; i < 200; ++i) {
      const dvec3 at = placeAtRandom(random, c, surface);
      std::vector<MongePatch> around(patches.largest().begin(), patches.largest().end());
      for (int level = 0; level < 14; ++level) {
        std::erase_if(around, [&](const MongePatch& patch) { return !holds(patches, patch, at); });
        ASSERT_FALSE(around.empty()) << c.name << " level " << level;
        around = splitOnce(patches, around);
      }
    }
  }
}

/// K in units of the half sides; the off-diagonal element counts twice in its norm.
dvec3 scaledBend(const MongePatch& p, const dvec2& half) {
  return {half.x * half.x * p.bendXx, glm::root_two<double>() * half.x * half.y * p.bendXy,
          half.y * half.y * p.bendYy};
}

TEST(MongePatches, BoundHowFastTheyBend) {
  constexpr double kStep = 0.02;  // of a half side
  std::uniform_real_distribution<double> inside(-1, 1 - kStep);
  for (const ImplicitCase& c : makeImplicitCases()) {
    const Surface surface = fitSurface(c);
    const MongePatches patches = coverCase(c, surface);
    std::mt19937 random(5);
    std::vector<MongePatch> all(patches.largest().begin(), patches.largest().end());
    for (int level = 0; level < 10; ++level) {
      std::shuffle(all.begin(), all.end(), random);
      all.resize(std::min<std::size_t>(all.size(), 200));
      for (const MongePatch& patch : all)
        for (int axis = 0; axis < 2; ++axis) {
          const dvec2 from = patch.middle + patch.half * dvec2(inside(random), inside(random));
          dvec2 to = from;
          to[axis] += kStep * patch.half[axis];
          const auto a = patches.move(patch, from, patch.half), b = patches.move(patch, to, patch.half);
          if (!a || !b) continue;
          const double change = glm::length(scaledBend(*b, patch.half) - scaledBend(*a, patch.half));
          EXPECT_LE(change, patch.third[axis] * (to[axis] - from[axis]) + 1e-9) << c.name << " " << level;
        }
      all = splitOnce(patches, all);
    }
  }
}

TEST(RootIsolation, ACurveOfReflectionsEnds) {
  const std::vector<ImplicitCase> cases = makeImplicitCases();
  const auto ring = std::find_if(cases.begin(), cases.end(), [](const ImplicitCase& c) {
    return std::string(c.name) == "torus outside";
  });
  const ImplicitReflector reflector(fitSurface(*ring), false, viewMesh(ring->mesh), 0.7);
  for (const double beside : {0.0, 1e-12, 1e-4}) {  // the axis; from there on two
    const dvec3 eye(0, 3, 0), point(beside, 1, 0);
    const ImplicitReflections found = reflector.findReflections(eye, point);
    EXPECT_GT(found.count, 1);
    for (const Reflection& r : found) EXPECT_LE(sineAt(r, eye, point), 1e-9);
  }
}

TEST(RootIsolation, AtTheCentreOfABallEveryPlaceMirrors) {
  const ImplicitReflector reflector(std::make_shared<geometry::Quadric>(makeEllipsoid(dvec3(0.7))), true,
                                    viewMesh(stretch(makeImplicitCases()[0].mesh, dvec3(1))), 0.7);
  EXPECT_GT(reflector.findReflections(dvec3(0), dvec3(0)).count, 0);
}

}  // namespace
}  // namespace catoptric::virtual_object
