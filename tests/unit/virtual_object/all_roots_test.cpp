// SPDX-License-Identifier: Apache-2.0
// Analytic solvers: is every reflection found? A table, one line a shape; the judge (root_judge.h) knows
// nothing of how they work; and pairs made from a reflection need none. CATOPTRIC_PAIRS=1000000 tries that
// many pairs of eye and point on each shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/implicit_reflector.h"
#include "implicit_cases.h"
#include "special_cases.h"

namespace catoptric::virtual_object {
namespace {

constexpr std::size_t kPairsPerTask = 250;
constexpr double kGrazing = 1e-3;   // sines: flatter than this no root is expected,
constexpr double kFlattest = 1e-6;  // and the half vector, of two directions that cancel, is their rounding
constexpr double kSame = 1e-5;      // a root found this near is the one expected

std::size_t pairCount() {
  const char* text = std::getenv("CATOPTRIC_PAIRS");
  return text ? std::size_t(std::max(1, std::atoi(text))) : 1000;
}

/// A line of the table.
struct Row {
  std::size_t pairs = 0, expected = 0, missed = 0, answers = 0;
  std::size_t others = 0;  ///< answers that the judge does not know, grazing ones apart
  int most = 0;            ///< for one pair
  double worst = 0;        ///< sine between half vector and normal
  double seconds = 0;

  void add(const Row& other) {
    pairs += other.pairs, expected += other.expected, missed += other.missed, answers += other.answers;
    others += other.others;
    most = std::max(most, other.most), worst = std::max(worst, other.worst), seconds += other.seconds;
  }
  void print(const std::string& name) const {
    std::printf(
        "%-18s %8zu pairs, expected %8zu, missed %4zu; %8zu answers, %8zu others, at most %2d; sine %.1e; "
        "%7.0f/s\n",
        name.c_str(), pairs, expected, missed, answers, others, most, worst, double(pairs) / seconds);
    std::fflush(stdout);
  }
};

/// Adds what was found of a pair to a row, and what should have been. `judge`: see tryPairs().
template <class APair, class Found, class Judge>
void addPair(const APair& pair, const Found& found, const Judge& judge, Row& row) {
  const dvec3 eye = pair.eye, point = pair.point;
  row.most = std::max(row.most, found.count);
  row.answers += std::size_t(found.count);
  const auto sineOfLower = [&](const dvec3& at, const dvec3& normal) {
    return std::min(glm::dot(normal, glm::normalize(eye - at)), glm::dot(normal, glm::normalize(point - at)));
  };
  for (const Reflection& r : found)
    if (std::min(glm::distance(r.position, eye), glm::distance(r.position, point)) > 1e-6 &&
        sineOfLower(r.position, r.normal) > kFlattest)
      row.worst = std::max(row.worst, sineAt(r, eye, point));
  std::vector<dvec3> known;
  judge(pair, [&](const dvec3& at, const dvec3& normal) {
    known.push_back(at);
    if (sineOfLower(at, normal) < kGrazing) return;
    ++row.expected;
    const bool isThere = std::any_of(found.begin(), found.end(), [&](const Reflection& r) {
      return glm::distance(r.position, at) < kSame;
    });
    row.missed += isThere ? 0 : 1;
  });
  for (const Reflection& r : found)
    if (sineOfLower(r.position, r.normal) >= kGrazing &&
        std::none_of(known.begin(), known.end(),
                     [&](const dvec3& at) { return glm::distance(r.position, at) < kSame; }))
      ++row.others;
}

/// `makePair` draws a pair; `solve` answers it; `judge` calls a function with position and normal of each
/// stationary point.
template <class MakePair, class Solve, class Judge>
Row tryPairs(const MakePair& makePair, const Solve& solve, const Judge& judge) {
  Row all;
  std::mutex mutex;
  const std::size_t tasks = (pairCount() + kPairsPerTask - 1) / kPairsPerTask;
  core::parallelFor(tasks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t task = begin; task < end; ++task) {
      std::mt19937 random(unsigned(100 + task));
      std::vector<decltype(makePair(random))> pairs(kPairsPerTask);
      for (auto& pair : pairs) pair = makePair(random);
      std::vector<decltype(solve(pairs[0]))> found(pairs.size());
      const auto start = std::chrono::steady_clock::now();
      for (std::size_t i = 0; i < pairs.size(); ++i) found[i] = solve(pairs[i]);
      Row row;
      row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      row.pairs = pairs.size();
      for (std::size_t i = 0; i < pairs.size(); ++i) addPair(pairs[i], found[i], judge, row);
      const std::scoped_lock lock(mutex);
      all.add(row);
    }
  });
  return all;
}

/// All stationary points of a sphere, a cylinder or a cone, by the one angle that is left when the path along
/// the generator is straight.
template <class Add>
void judgeSpecial(const SpecialReflector& s, const Pair& pair, const Add& add) {
  const dvec3 eye = pair.eye, point = pair.point;
  const double sign = s.isInside ? -1 : 1;
  dvec3 x = glm::normalize(glm::cross(s.axis, dvec3(0.3, 0.1, 1))), y = glm::cross(s.axis, x);
  if (s.shape == SpecialShape::Sphere) {
    x = glm::normalize(eye - s.origin);
    y = glm::normalize(point - s.origin - x * glm::dot(x, point - s.origin));
  }
  const auto footAt = [&](double phi) {  // position, outward normal
    const dvec3 out = std::cos(phi) * x + std::sin(phi) * y;
    if (s.shape == SpecialShape::Sphere) return Reflection{s.origin + s.radius * out, out};
    const bool isCone = s.shape == SpecialShape::Cone;
    const double sine = std::sin(s.halfAngleRadians), cosine = std::cos(s.halfAngleRadians);
    const dvec3 base = isCone ? s.origin : s.origin + s.radius * out,
                along = isCone ? cosine * s.axis + sine * out : s.axis,
                normal = isCone ? cosine * out - sine * s.axis : out;
    const dvec3 e = eye - base, q = point - base;
    const double e0 = glm::dot(e, along), q0 = glm::dot(q, along);
    const double eh = glm::length(e - e0 * along), qh = glm::length(q - q0 * along);
    return Reflection{base + along * ((e0 * qh + q0 * eh) / (eh + qh)), normal};
  };
  const auto slopeAt = [&](double phi) {
    const dvec3 at = footAt(phi).position;
    return glm::dot(glm::normalize(at - eye) + glm::normalize(at - point),
                    std::cos(phi) * y - std::sin(phi) * x);
  };
  for (const double phi : findAngles(slopeAt)) {
    const Reflection foot = footAt(phi);
    const bool isPastApex =
        s.shape == SpecialShape::Cone && glm::dot(foot.position - s.origin, s.axis) < 1e-3;
    if (!isPastApex) add(foot.position, sign * foot.normal);
  }
}

TEST(AllRoots, OfShapesWithClosedForms) {
  for (const SpecialShape shape : {SpecialShape::Sphere, SpecialShape::Cylinder, SpecialShape::Cone})
    for (const bool isInside : {false, true}) {
      const SpecialReflector reflector = makeShape({shape, isInside});
      const Row row = tryPairs(
          [&](std::mt19937& random) {
            const dvec3 eye = randomPoint(random, reflector.origin);
            return Pair{eye, randomPoint(random, reflector.origin)};
          },
          [&](const Pair& pair) { return findReflections(reflector, pair.eye, pair.point); },
          [&](const Pair& pair, const auto& add) { judgeSpecial(reflector, pair, add); });
      row.print(testing::PrintToString(Side{shape, isInside}));
      EXPECT_EQ(row.missed, 0);
      EXPECT_LE(row.worst, 1e-9);
      EXPECT_GT(row.expected, row.pairs / 10);
      EXPECT_TRUE(!isInside || row.most > 1);
    }
}

/// The places on what was fitted to a mesh of floats: near a caustic 1e-8 beside it are 1e-4 along it.
SurfacePatch::Place placeOn(const Surface& surface, const SurfacePatch::Place& place) {
  return [=](const dvec2& uv) {
    const PatchPoint p = place(uv);
    const dvec3 at = surface->project(p.at, 1e-6), normal = glm::normalize(surface->gradient(at));
    const auto flatten = [&](const dvec3& v) { return glm::normalize(v - normal * glm::dot(normal, v)); };
    return PatchPoint{at, flatten(p.alongU), flatten(p.alongV)};
  };
}

/// All of implicit_cases.h, by name: making them takes time that no other test should wait for.
constexpr std::array kSurfaces{
    "ellipsoid outside", "ellipsoid inside", "dish",         "saddle",         "bump",
    "torus outside",     "torus near",       "torus inside", "aspheric bulge", "aspheric hollow",
    "aspheric turned"};

ImplicitCase makeCase(const std::string& name) {
  const std::vector<ImplicitCase> all = makeImplicitCases();
  EXPECT_EQ(all.size(), kSurfaces.size());
  const auto at = std::find_if(all.begin(), all.end(), [&](const ImplicitCase& c) { return c.name == name; });
  return at == all.end() ? throw std::out_of_range(name) : *at;
}

class AllRootsOf : public testing::TestWithParam<const char*> {
 protected:
  const ImplicitCase c = makeCase(GetParam());
  const Surface surface = fitSurface(c);
  const ImplicitReflector reflector{surface, c.isTurned, viewMesh(c.mesh), 0.7};

  [[nodiscard]] ImplicitReflections solve(const Pair& pair) const {
    return reflector.findReflections(pair.eye, pair.point);
  }
  void expectAll(const Row& row) const {
    row.print(c.name);
    EXPECT_EQ(row.missed, 0) << c.name;
    EXPECT_LE(row.worst, 1e-9) << c.name;
    EXPECT_GT(row.expected, row.pairs / 50) << c.name;
  }
};

TEST_P(AllRootsOf, RandomPairs) {
  const SurfacePatch patch(placeOn(surface, c.place), c.lower, c.upper, 64, 32);
  const double side = c.isTurned ? -1 : 1;
  const Row row = tryPairs([&](std::mt19937& random) { return randomPair(random, c, surface); },
                           [&](const Pair& pair) { return solve(pair); },
                           [&](const Pair& pair, const auto& add) {
                             for (const dvec3& at : patch.findStationary(pair.eye, pair.point))
                               add(at, side * glm::normalize(surface->gradient(at)));
                           });
  expectAll(row);
  // The judge misses some where E or Q is as good as on the mirror.
  EXPECT_TRUE(!c.isClosed || row.others <= row.expected / 100'000) << c.name << ": " << row.others;
}

/// With a reflection that is known, for the pair was made from it.
struct MadePair : Pair {
  Reflection known;
};

/// Any place on the mirror, an eye in front of it, and a point on the mirrored ray, near or far, so near
/// caustics and grazing as well.
MadePair makePairFrom(std::mt19937& random, const ImplicitCase& c, const Surface& surface) {
  std::uniform_real_distribution<double> uniform(0, 1);
  while (true) {
    const dvec2 uv(uniform(random), uniform(random));
    const dvec3 at = surface->project(c.place(glm::mix(c.lower, c.upper, uv)).at);
    const dvec3 normal = (c.isTurned ? -1.0 : 1.0) * glm::normalize(surface->gradient(at));
    const dvec3 eye = randomPair(random, c, surface).eye,
                out = core::reflectDirection(glm::normalize(at - eye), normal);
    if (glm::dot(out, normal) < kGrazing) continue;
    return {{eye, at + out * std::pow(10.0, 3.5 * uniform(random) - 3)}, {at, normal}};
  }
}

TEST_P(AllRootsOf, PairsMadeFromOne) {
  expectAll(
      tryPairs([&](std::mt19937& random) { return makePairFrom(random, c, surface); },
               [&](const Pair& pair) { return solve(pair); },
               [&](const MadePair& pair, const auto& add) { add(pair.known.position, pair.known.normal); }));
}

INSTANTIATE_TEST_SUITE_P(Surfaces, AllRootsOf, testing::ValuesIn(kSurfaces), [](const auto& surface) {
  std::string name = surface.param;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

}  // namespace
}  // namespace catoptric::virtual_object
