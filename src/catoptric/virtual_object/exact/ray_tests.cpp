// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/exact/ray_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catoptric/core/eight_lanes.h"

namespace catoptric::virtual_object {
namespace {

using core::Eight;
using core::EightInts;
using core::kLanes;

constexpr float kMiss = std::numeric_limits<float>::infinity();
constexpr float kEdgeSlack = 1e-6f;  // as in lib/ray_triangle.glsl

/// What MeetAll works on.
struct Lanes {
  const float* numbers[RayLanes::kNumbers];
  float* distances;
  std::uint32_t* triangles;
  std::size_t padded;
};

CATOPTRIC_INLINE void cross(const Eight* a, const Eight* b, Eight* product) {
  product[0] = a[1] * b[2] - b[1] * a[2];
  product[1] = a[2] * b[0] - b[2] * a[0];
  product[2] = a[0] * b[1] - b[0] * a[1];
}

CATOPTRIC_INLINE Eight least(const Eight& a, const Eight& b) {
  return a < b ? a : b;
}

CATOPTRIC_INLINE Eight absolute(const Eight& a) {
  return a < 0.0f ? -a : a;
}

/// Eight rays against one triangle.
CATOPTRIC_INLINE void meetOne(const RayLanes::Test& test, const Eight* origin, const Eight* direction,
                              const Eight& begin, Eight& distance, EightInts& triangle) {
  Eight a[3], b[3], c[3], turned[3], sides[3];
  for (int k = 0; k < 3; ++k) {
    a[k] = test.a[k] - origin[k];
    b[k] = test.b[k] - origin[k];
    c[k] = test.c[k] - origin[k];
  }
  cross(b, c, turned);
  sides[0] = core::dot(direction, turned);
  cross(c, a, turned);
  sides[1] = core::dot(direction, turned);
  cross(a, b, turned);
  sides[2] = core::dot(direction, turned);
  const Eight n[3] = {test.normal.x + Eight{}, test.normal.y + Eight{}, test.normal.z + Eight{}};
  const Eight across = core::dot(direction, n);
  const EightInts isFront = across < 0.0f;
  const Eight sum = sides[0] + sides[1] + sides[2];
  const Eight inner = least(isFront ? -sides[0] : sides[0],
                            least(isFront ? -sides[1] : sides[1], isFront ? -sides[2] : sides[2]));
  EightInts isHit = (across != 0.0f) & (inner >= -kEdgeSlack * absolute(sum));
  if (test.isSingleSided) isHit &= isFront;
  if (core::toBits(isHit) == 0) return;
  const Eight height = core::dot(a, n);
  const Eight t = height / across;
  isHit &= (t > begin) & (t < distance);
  if (test.isOwn) isHit &= absolute(height) > 2.0f * begin * glm::length(test.normal);
  distance = isHit ? t : distance;
  triangle = isHit ? EightInts{} + std::int32_t(test.triangle) : triangle;
}

struct MeetAll {
  static CATOPTRIC_INLINE void run(const Lanes& lanes, const std::span<const RayLanes::Test>& tests,
                                   float& farthest) {
    Eight most = -kMiss + Eight{};
    for (std::size_t first = 0; first < lanes.padded; first += std::size_t(kLanes)) {
      Eight origin[3], direction[3];
      for (int k = 0; k < 3; ++k) {
        origin[k] = core::load(lanes.numbers[RayLanes::kOrigin + k] + first);
        direction[k] = core::load(lanes.numbers[RayLanes::kDirection + k] + first);
      }
      const Eight begin = core::load(lanes.numbers[RayLanes::kBegin] + first);
      Eight distance = core::load(lanes.distances + first);
      EightInts triangle;
      std::memcpy(&triangle, lanes.triangles + first, sizeof triangle);
      for (const RayLanes::Test& test : tests) meetOne(test, origin, direction, begin, distance, triangle);
      most = core::larger(most, distance);
      core::store(lanes.distances + first, distance);
      std::memcpy(lanes.triangles + first, &triangle, sizeof triangle);
    }
    for (int i = 0; i < kLanes; ++i) farthest = std::max(farthest, most[i]);
  }
};

}  // namespace

void RayLanes::assign(std::span<const vec4> origins, std::span<const vec4> directions) {
  count_ = origins.size();
  padded_ = (count_ + std::size_t(kLanes) - 1) / std::size_t(kLanes) * std::size_t(kLanes);
  for (std::vector<float>& numbers : numbers_)
    if (numbers.size() < padded_) numbers.resize(padded_);
  distances_.assign(padded_, kMiss);
  std::fill(distances_.begin() + std::ptrdiff_t(count_), distances_.end(), -kMiss);
  triangles_.assign(padded_, core::kNoId);
  for (std::size_t i = 0; i < padded_; ++i) {
    const std::size_t ray = std::min(i, count_ - 1);
    for (int k = 0; k < 3; ++k) {
      numbers_[kOrigin + k][i] = origins[ray][k];
      numbers_[kDirection + k][i] = directions[ray][k];
    }
    numbers_[kBegin][i] = directions[ray].w;
  }
}

float RayLanes::meet(std::span<const Test> tests) {
  Lanes lanes{{}, distances_.data(), triangles_.data(), padded_};
  for (std::size_t k = 0; k < kNumbers; ++k) lanes.numbers[k] = numbers_[k].data();
  float farthest = -kMiss;
  core::runOnWidestVectors<MeetAll>(lanes, tests, farthest);
  return farthest;
}

}  // namespace catoptric::virtual_object
