// SPDX-License-Identifier: Apache-2.0
// Where is each vertex of a batch seen from seven locations of a cell, if it is known for the eighth?
//
// In: one trace at eight locations, up to 64 vertices (world, metres), where they are seen from one of them,
// the base. Out: for each vertex and location the mirror point and the path from there to the vertex (2004,
// section 6, MORPH_VERTEX).
//   1. At another location the ray is expected at the same place of the chart or, once three neighbours of
//      the location are known, where they continue to.
//   2. How far it is off changes slowly over the mirror. Eight vertices, spread over the batch, are searched
//      first; an affine function of the place at the base is fitted to what they were off.
//   3. All start from the place that it gives, and mostly are there at once.
//   4. Where a search ends outside of the trace, the octree of the location itself is asked.
//   5. Where that fails too, and at another edge of the map, the search starts from the place at another
//      location that sees the vertex.
//   6. Just behind a closed mirror the locations see a vertex all around the rim. What lies between these
//      points is no reflection of it: the vertex is dropped, or its triangles would sweep across the mirror.
//
// Departures from 2004: eight octree look-ups a vertex are one and seven short searches. It takes a fraction
// of the time, and where several rays of a trace pass through a vertex (behind a focus) the locations agree
// on one. Source: Martin & Popescu 2004, section 6.
#include "catoptric/reflection_morphing/corner_batch.h"

#include "catoptric/reflection_morphing/mirror_normals.h"
#include "catoptric/reflection_morphing/octree_searches.h"

namespace catoptric::reflection_morphing {
namespace {

constexpr std::size_t kSamples = 8;
constexpr float kSamePlace = 8;  // texels; twice the distance of the octree's rays
/// Length of the mean of eight unit normals; normals about 45 degrees from their mean.
constexpr float kLeastAgreement = 0.7f;

}  // namespace

void CornerBatch::take(std::uint32_t vertex, const RayBatch& found, std::size_t i, bool isInside) {
  const RayTable& table = trace_[base_]->table;
  vertices_[count_] = vertex;
  for (int axis = 0; axis < 3; ++axis) batch_.point[axis][count_] = found.point[axis][i];
  chartX_[base_][count_] = table.lower.x + found.x[i] * table.step.x;
  chartY_[base_][count_] = table.lower.y + found.y[i] * table.step.y;
  corners_.points[vertex][base_] =
      vec4(found.mirror[0][i], found.mirror[1][i], found.mirror[2][i], found.rest[i]);
  seen_[base_] |= SearchSet(isInside ? 1 : 0) << count_;
  if (++count_ == kMostSearches) run();
}

void CornerBatch::run() {
  if (count_ == 0) return;
  all_ = firstSearches(count_);
  for (std::size_t other = 1; other < 8; ++other)
    if (trace_[base_ ^ other] != nullptr) lookUpAt(base_ ^ other);
  for (std::size_t k = 0; k < 8; ++k)
    if (trace_[k] != nullptr) searchFromOthers(k);
  SearchSet seen = 0;
  for (const SearchSet one : seen_) seen |= one;
  const SearchSet agreeing = findAgreeing();
  for (std::size_t i = 0; i < count_; ++i)
    corners_.kinds[vertices_[i]] = (agreeing >> i & 1) == 0 ? raster::VertexKind::None
                                   : (seen >> i & 1) != 0   ? raster::VertexKind::Reflected
                                                            : raster::VertexKind::DoublyVirtual;
  seen_.fill(0), doubtful_.fill(0);
  count_ = 0;
}

/// Step 1: sets expectedX_ and expectedY_. Returns the vertices that are seen from where they are made of.
SearchSet CornerBatch::expect(std::size_t k) {
  const RayTable& table = trace_[k]->table;
  const vec2 perStep = 1.0f / table.step;
  std::size_t a = base_, b = base_, c = base_;
  const std::size_t axes = k ^ base_;  // from the base to k
  const std::size_t low = axes & (~axes + 1), middle = (axes & ~low) & (~(axes & ~low) + 1);
  if (axes != low && trace_[k ^ low] && trace_[k ^ middle] && trace_[k ^ low ^ middle])
    a = k ^ low, b = k ^ middle, c = k ^ low ^ middle;
  const auto put = [](const Floats& placeA, const Floats& placeB, const Floats& placeC, float lower,
                      float scale, Floats& expected) {
    for (std::size_t i = 0; i < kMostSearches; ++i)
      expected[i] = (placeA[i] + placeB[i] - placeC[i] - lower) * scale;
  };
  put(chartX_[a], chartX_[b], chartX_[c], table.lower.x, perStep.x, expectedX_);
  put(chartY_[a], chartY_[b], chartY_[c], table.lower.y, perStep.y, expectedY_);
  return seen_[base_] & seen_[a] & seen_[b] & seen_[c];
}

/// Step 2.
CornerBatch::Drift CornerBatch::measureDrift(std::size_t location, SearchSet expected) {
  const RayTable& table = trace_[location]->table;
  std::array<std::size_t, kSamples> which;
  SearchSet wanted = 0;
  for (std::size_t s = 0; s < kSamples; ++s) {
    const std::size_t i = which[s] = s * count_ / kSamples;
    for (int axis = 0; axis < 3; ++axis) samples_.point[axis][s] = batch_.point[axis][i];
    samples_.x[s] = expectedX_[i], samples_.y[s] = expectedY_[i];
    wanted |= (expected >> i & 1) << s;
  }
  const SearchSet found = findRays(table, findFilled(table, wanted, samples_), 0, samples_);
  Drift drift;
  if (found == 0) return drift;
  vec2 place[kSamples], off[kSamples];
  const float perCount = 1 / float(std::popcount(found));
  forEachSearch(found, [&](std::size_t s) {
    place[s] = vec2(chartX_[base_][which[s]], chartY_[base_][which[s]]);
    off[s] = vec2(samples_.x[s] - expectedX_[which[s]], samples_.y[s] - expectedY_[which[s]]);
    drift.middle += perCount * place[s];
    drift.mean += perCount * off[s];
  });
  float xx = 0, xy = 0, yy = 0;
  vec2 offX(0), offY(0);
  forEachSearch(found, [&](std::size_t s) {
    const vec2 p = place[s] - drift.middle, o = off[s] - drift.mean;
    xx += p.x * p.x, xy += p.x * p.y, yy += p.y * p.y;
    offX += o * p.x, offY += o * p.y;
  });
  // A little damping: places may lie on a line.
  const float damping = 0.01f * (xx + yy) + 1e-12f;
  xx += damping, yy += damping;
  const float perDeterminant = 1 / (xx * yy - xy * xy);
  drift.perX = (yy * offX - xy * offY) * perDeterminant;
  drift.perY = (xx * offY - xy * offX) * perDeterminant;
  return drift;
}

/// Step 3: where the searches begin.
void CornerBatch::start(std::size_t location, SearchSet expected, const Drift& drift) {
  const RayTable& table = trace_[location]->table;
  const Floats &placeX = chartX_[base_], &placeY = chartY_[base_];
  for (std::size_t i = 0; i < kMostSearches; ++i) {
    const float x = placeX[i] - drift.middle.x, y = placeY[i] - drift.middle.y;
    batch_.x[i] = expectedX_[i] + drift.mean.x + drift.perX.x * x + drift.perY.x * y;
    batch_.y[i] = expectedY_[i] + drift.mean.y + drift.perX.y * x + drift.perY.y * y;
  }
  forEachSearch(all_ & ~expected, [&](std::size_t i) {
    batch_.x[i] = (placeX[i] - table.lower.x) / table.step.x;
    batch_.y[i] = (placeY[i] - table.lower.y) / table.step.y;
  });
}

void CornerBatch::lookUpAt(std::size_t location) {
  const SampledTrace& trace = *trace_[location];
  const SearchSet expected = expect(location) & all_;
  start(location, expected, measureDrift(location, expected));
  SearchSet inside = findRays(trace.table, findFilled(trace.table, seen_[base_], batch_), 0, batch_);
  // 4
  const Floats triedX = batch_.x, triedY = batch_.y;
  inside |= searchFromOctree(trace, all_ & ~inside, OctreeSearch::FromNearest, batch_);
  seen_[location] = inside;
  doubtful_[location] = all_ & ~inside & ~seen_[base_];
  forEachSearch(all_ & ~inside & seen_[base_], [&](std::size_t i) {
    const float x = batch_.x[i] - triedX[i], y = batch_.y[i] - triedY[i];
    doubtful_[location] |= SearchSet(x * x + y * y > kSamePlace * kSamePlace ? 1 : 0) << i;
  });
  keep(location, all_);
}

void CornerBatch::keep(std::size_t location, SearchSet which) {
  const RayTable& table = trace_[location]->table;
  for (std::size_t i = 0; i < kMostSearches; ++i) {
    if ((which >> i & 1) == 0) continue;
    chartX_[location][i] = table.lower.x + batch_.x[i] * table.step.x;
    chartY_[location][i] = table.lower.y + batch_.y[i] * table.step.y;
    corners_.points[vertices_[i]][location] =
        vec4(batch_.mirror[0][i], batch_.mirror[1][i], batch_.mirror[2][i], batch_.rest[i]);
  }
}

/// Step 5.
void CornerBatch::searchFromOthers(std::size_t location) {
  const RayTable& table = trace_[location]->table;
  SearchSet again = 0;
  for (std::size_t other = 0; other < 8; ++other)
    forEachSearch(seen_[other] & doubtful_[location], [&](std::size_t i) {
      batch_.x[i] = (chartX_[other][i] - table.lower.x) / table.step.x;
      batch_.y[i] = (chartY_[other][i] - table.lower.y) / table.step.y;
      again |= SearchSet(1) << i;
    });
  if (again == 0) return;
  const SearchSet found = findRays(table, findFilled(table, again, batch_), kMostShortened, batch_);
  seen_[location] |= found;
  keep(location, found);
}

/// Step 6.
SearchSet CornerBatch::findAgreeing() const {
  if (!trace_[base_]->table.origins.empty()) return all_;
  std::array<Floats, 3> sum{};
  float least = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    if (trace_[k] == nullptr) continue;
    addNormals(trace_[k]->table, chartX_[k], chartY_[k], sum);
    least += kLeastAgreement;
  }
  SearchSet agreeing = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const float squared = sum[0][i] * sum[0][i] + sum[1][i] * sum[1][i] + sum[2][i] * sum[2][i];
    agreeing |= SearchSet(squared >= least * least ? 1 : 0) << i;
  }
  return agreeing;
}

}  // namespace catoptric::reflection_morphing
