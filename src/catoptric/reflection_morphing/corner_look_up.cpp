// SPDX-License-Identifier: Apache-2.0
// Where is each vertex of a batch seen from the eight locations of a cell?
//
// In: one trace at eight locations, up to 64 vertices (world, metres). Out: for each vertex and location the
// mirror point and the path from there to the vertex (2004, section 6, MORPH_VERTEX).
//   1. At the first location that has the trace, the leaf of the octree that holds the vertex gives rays that
//      pass near; from the nearest of them the table is searched for the ray that passes through the vertex
//      (find_ray.cpp). A vertex that is seen neither from there nor from the last location is dropped.
//   2. At another location the ray is expected at the same place of the chart or, once three neighbours of
//      the location are known, where they continue to.
//   3. How far it is off changes slowly over the mirror. Eight vertices, spread over the batch, are searched
//      first; an affine function of the place at the first location is fitted to what they were off.
//   4. The others start from the place that it gives, and mostly are there at once.
//   5. Where a search ends outside of the trace, the octree of the location itself is asked.
//   6. Where that fails too, the search starts from the place at another location that sees the vertex.
//   7. Just behind a closed mirror the locations see a vertex all around the rim. What lies between these
//      points is no reflection of it: the vertex is dropped, or its triangles would sweep across the mirror.
//
// Departures from 2004: eight octree look-ups a vertex are two and seven short searches. It takes a quarter
// of the time, and where several rays of a trace pass through a vertex (behind a focus) the locations agree
// on one. Cost: 0.6 us a vertex and core. Source: Martin & Popescu 2004, section 6.
#include "catoptric/reflection_morphing/corner_look_up.h"

#include <algorithm>
#include <bit>

namespace catoptric::reflection_morphing {
namespace {

constexpr std::size_t kSampleStride = 8;  // of the vertices of a batch
/// Length of the mean of eight unit normals; normals about 45 degrees from their mean.
constexpr float kLeastAgreement = 0.7f;

/// The ray of the leaf that is nearest to the middle of the map.
const OctreeRay& findInnermostRay(const RayTable& table, const RayOctree& octree,
                                  std::span<const std::uint32_t> leaf) {
  const float middle = 0.5f * float(table.size);
  const auto distance = [&](std::uint32_t ray) {
    const float x = octree.rays[ray].x - middle, y = octree.rays[ray].y - middle;
    return x * x + y * y;
  };
  return octree.rays[*std::min_element(
      leaf.begin(), leaf.end(), [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); })];
}

void setPlace(RayBatch& batch, std::size_t i, const OctreeRay& ray) {
  batch.x[i] = ray.x;
  batch.y[i] = ray.y;
}

vec3 pointOf(const RayBatch& batch, std::size_t i) {
  return {batch.point[0][i], batch.point[1][i], batch.point[2][i]};
}

void copyPoint(const RayBatch& from, std::size_t i, RayBatch& to) {
  for (int axis = 0; axis < 3; ++axis) to.point[axis][i] = from.point[axis][i];
}

void copyFound(const RayBatch& from, std::size_t i, RayBatch& to) {
  to.x[i] = from.x[i], to.y[i] = from.y[i];
  for (int axis = 0; axis < 3; ++axis) to.mirror[axis][i] = from.mirror[axis][i];
  to.rest[i] = from.rest[i];
  to.isInside[i] = from.isInside[i];
}

}  // namespace

void OctreeSearches::run(const SampledTrace& trace, RayBatch& batch) {
  if (count_ == 0) return;
  begin(trace, batch);
  findRays(trace.table, std::span(which_).first(count_), batch);
  tryInnerRays(trace, batch);
  count_ = 0;
}

void OctreeSearches::begin(const SampledTrace& trace, RayBatch& batch) {
  for (std::size_t k = 0; k < count_; ++k) {
    leaves_[k] = trace.octree.findLeaf(pointOf(batch, which_[k]));
    __builtin_prefetch(leaves_[k].data());
  }
  for (std::size_t k = 0; k < count_; ++k)
    setPlace(batch, which_[k], findNearestRay(trace.octree, leaves_[k], pointOf(batch, which_[k])));
}

/// A ray at the very rim may be the nearest and yet lead nowhere: directions turn fast there.
void OctreeSearches::tryInnerRays(const SampledTrace& trace, RayBatch& batch) {
  std::array<std::uint8_t, kMostSearches> again;
  std::size_t count = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    const std::uint8_t i = which_[k];
    if (batch.isInside[i] != 0 || leaves_[k].size() == 1) continue;
    again[count++] = i;
    copyPoint(batch, i, other_);
    setPlace(other_, i, findInnermostRay(trace.table, trace.octree, leaves_[k]));
  }
  findRays(trace.table, std::span(again).first(count), other_);
  for (const std::uint8_t i : std::span(again).first(count)) {
    if (other_.isInside[i] != 0) copyFound(other_, i, batch);
  }
}

CornerLookUp::CornerLookUp(const CellTrace& trace, std::span<const vec3> points, CornerPoints& corners)
    : trace_(trace), points_(points), corners_(corners) {
  for (std::size_t k = 0; k < 8; ++k)
    if (trace[k] != nullptr) present_ |= 1u << k;
  first_ = std::size_t(std::countr_zero(present_));
  last_ = std::size_t(std::bit_width(present_)) - 1;
}

void CornerLookUp::add(std::uint32_t vertex) {
  vertices_[count_] = vertex;
  for (int axis = 0; axis < 3; ++axis) batch_.point[axis][count_] = points_[vertex][axis];
  ++count_;
}

void CornerLookUp::run(bool all) {
  if (count_ == 0) return;
  for (std::size_t i = 0; i < count_; ++i) searches_.add(i);
  searches_.run(*trace_[first_], batch_);
  if (!all) keepSeen();
  std::fill_n(isInside_.begin(), count_, std::uint8_t(0));
  keep(first_);
  for (std::size_t k = first_ + 1; k < 8 && count_ > 0; ++k)
    if (trace_[k] != nullptr) lookUpAt(k);
  for (std::size_t k = 0; k < 8; ++k)
    if (trace_[k] != nullptr) searchFromOthers(k);
  for (std::size_t i = 0; i < count_; ++i)
    corners_.kinds[vertices_[i]] = !agree(i)           ? raster::VertexKind::None
                                   : isInside_[i] != 0 ? raster::VertexKind::Reflected
                                                       : raster::VertexKind::DoublyVirtual;
  count_ = 0;
}

/// Step 1: drops the vertices that are seen neither from the first nor from the last location.
void CornerLookUp::keepSeen() {
  for (std::size_t i = 0; i < count_; ++i) {
    other_.isInside[i] = 0;
    if (last_ == first_ || batch_.isInside[i] != 0) continue;
    copyPoint(batch_, i, other_);
    searches_.add(i);
  }
  searches_.run(*trace_[last_], other_);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (batch_.isInside[i] == 0 && other_.isInside[i] == 0) continue;
    vertices_[kept] = vertices_[i];
    for (Floats* numbers : {&batch_.point[0], &batch_.point[1], &batch_.point[2], &batch_.x, &batch_.y,
                            &batch_.mirror[0], &batch_.mirror[1], &batch_.mirror[2], &batch_.rest})
      (*numbers)[kept] = (*numbers)[i];
    batch_.isInside[kept++] = batch_.isInside[i];
  }
  count_ = kept;
}

void CornerLookUp::keep(std::size_t location) {
  for (std::size_t i = 0; i < count_; ++i) keepOne(location, i);
}

void CornerLookUp::keepOne(std::size_t location, std::size_t i) {
  const RayTable& table = trace_[location]->table;
  chartX_[location][i] = table.lower.x + batch_.x[i] * table.step.x;
  chartY_[location][i] = table.lower.y + batch_.y[i] * table.step.y;
  corners_.points[vertices_[i]][location] =
      vec4(batch_.mirror[0][i], batch_.mirror[1][i], batch_.mirror[2][i], batch_.rest[i]);
  isInside_[i] = std::uint8_t(isInside_[i] | unsigned(batch_.isInside[i]) << location);
}

/// Step 2.
void CornerLookUp::expect(std::size_t k) {
  const RayTable& table = trace_[k]->table;
  const vec2 perStep = 1.0f / table.step;
  // The place at a, or a + b - c.
  const auto put = [&](const Floats& a, const Floats& b, const Floats& c, float lower, float scale,
                       Floats& expected) {
    for (std::size_t i = 0; i < count_; ++i) expected[i] = (a[i] + b[i] - c[i] - lower) * scale;
  };
  std::size_t a = first_, b = first_, c = first_;
  if (present_ == 0xffu && std::popcount(k) > 1) {
    const std::size_t low = k & (~k + 1);  // one of its axes; the others lead to c
    a = k ^ low, b = std::popcount(k) == 3 ? (k & 1u) | (k & 2u) : low, c = a & b;
  }
  needed_ = std::uint8_t(1u << first_ | 1u << a | 1u << b | 1u << c);
  put(chartX_[a], chartX_[b], chartX_[c], table.lower.x, perStep.x, expectedX_);
  put(chartY_[a], chartY_[b], chartY_[c], table.lower.y, perStep.y, expectedY_);
}

/// Step 3: from the samples, which have been searched.
CornerLookUp::Drift CornerLookUp::fitDrift() const {
  Drift drift;
  vec2 place[kMostSearches / kSampleStride], off[kMostSearches / kSampleStride];
  std::size_t count = 0;
  for (std::size_t i = 0; i < count_; i += kSampleStride) {
    if ((isInside_[i] & needed_) != needed_ || batch_.isInside[i] == 0) continue;
    place[count] = vec2(chartX_[first_][i], chartY_[first_][i]);
    off[count] = vec2(batch_.x[i] - expectedX_[i], batch_.y[i] - expectedY_[i]);
    drift.middle += place[count];
    drift.mean += off[count++];
  }
  if (count == 0) return drift;
  drift.middle /= float(count);
  drift.mean /= float(count);
  float xx = 0, xy = 0, yy = 0;
  vec2 offX(0), offY(0);
  for (std::size_t k = 0; k < count; ++k) {
    const vec2 p = place[k] - drift.middle, o = off[k] - drift.mean;
    xx += p.x * p.x, xy += p.x * p.y, yy += p.y * p.y;
    offX += o * p.x, offY += o * p.y;
  }
  // A little damping: places may lie on a line.
  const float damping = 0.01f * (xx + yy) + 1e-12f;
  xx += damping, yy += damping;
  const float perDeterminant = 1 / (xx * yy - xy * xy);
  drift.perX = (yy * offX - xy * offY) * perDeterminant;
  drift.perY = (xx * offY - xy * offX) * perDeterminant;
  return drift;
}

void CornerLookUp::lookUpAt(std::size_t location) {
  const SampledTrace& trace = *trace_[location];
  expect(location);
  std::bitset<kMostSearches> asked;
  std::size_t count = 0;
  const auto start = [&](std::size_t i, vec2 place) {
    if ((isInside_[i] & needed_) != needed_)
      place = (vec2(chartX_[first_][i], chartY_[first_][i]) - trace.table.lower) / trace.table.step;
    if (isInside(first_, i) && trace.table.isFilled(place)) {
      batch_.x[i] = place.x;
      batch_.y[i] = place.y;
      which_[count++] = std::uint8_t(i);
    } else {
      searches_.add(i);
      asked.set(i);
    }
  };
  const auto run = [&] {
    findRays(trace.table, std::span(which_).first(count), batch_);
    searches_.run(trace, batch_);
    count = 0;
  };
  // 3
  for (std::size_t i = 0; i < count_; i += kSampleStride) start(i, vec2(expectedX_[i], expectedY_[i]));
  run();
  const Drift drift = fitDrift();
  // 4
  for (std::size_t i = 0; i < count_; ++i) {
    if (i % kSampleStride == 0) continue;
    const vec2 p = vec2(chartX_[first_][i], chartY_[first_][i]) - drift.middle;
    start(i, vec2(expectedX_[i], expectedY_[i]) + drift.mean + drift.perX * p.x + drift.perY * p.y);
  }
  run();
  // 5
  for (std::size_t i = 0; i < count_; ++i)
    if (batch_.isInside[i] == 0 && !asked[i]) searches_.add(i);
  searches_.run(trace, batch_);
  keep(location);
}

/// Step 7: a mirror's normal bisects the angle between the ray that comes and the one that leaves.
bool CornerLookUp::agree(std::size_t i) const {
  vec3 sum(0);
  float count = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    if (trace_[k] == nullptr) continue;
    const RayTable& table = trace_[k]->table;
    if (!table.origins.empty()) return true;
    const vec2 chart(chartX_[k][i], chartY_[k][i]);
    const ivec2 texel =
        glm::clamp(ivec2((chart - table.lower) / table.step + 0.5f), ivec2(0), ivec2(table.size - 1));
    const vec4& leaving = table.leaving[table.at(texel.x, texel.y)];
    const vec3 direction =
        leaving.x * table.chart.right + leaving.y * table.chart.up + leaving.z * table.chart.axis;
    sum += glm::normalize(direction - table.chart.directionAt(chart));
    ++count;
  }
  return glm::dot(sum, sum) >= kLeastAgreement * kLeastAgreement * count * count;
}

/// Step 6.
void CornerLookUp::searchFromOthers(std::size_t location) {
  const RayTable& table = trace_[location]->table;
  std::size_t count = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (isInside(location, i) || isInside_[i] == 0) continue;
    const auto other = std::size_t(std::bit_width(unsigned(isInside_[i]))) - 1;
    const vec2 place = (vec2(chartX_[other][i], chartY_[other][i]) - table.lower) / table.step;
    if (!table.isFilled(place)) continue;
    batch_.x[i] = place.x;
    batch_.y[i] = place.y;
    which_[count++] = std::uint8_t(i);
  }
  findRays(table, std::span(which_).first(count), batch_);
  for (const std::uint8_t i : std::span(which_).first(count))
    if (batch_.isInside[i] != 0) keepOne(location, i);
}

}  // namespace catoptric::reflection_morphing
