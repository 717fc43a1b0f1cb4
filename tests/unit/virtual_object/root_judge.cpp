// SPDX-License-Identifier: Apache-2.0
#include "root_judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "catoptric/core/widest_vectors.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kWider = 0.5;            // of a range, to both sides
constexpr int kDepth = 4;                 // of subdivision
constexpr int kNearDepth = 14;            // of it beside E and Q
constexpr int kFinest = 2 << kNearDepth;  // steps of the finest grid along a cell
constexpr int kLeaf = kFinest >> kDepth;  // of them along a cell that is cut no more
constexpr int kKept = kFinest / 8;        // and along that of which the places are kept
constexpr int kAngles = 256;              // samples of a turn
constexpr int kAngleDepth = 10;           // of subdivision there
constexpr double kDifference = 1e-7;      // of parameters
constexpr double kStationary = 1e-10;     // of the path's derivative along a unit tangent
constexpr double kSame = 1e-5;            // roots nearer are one: so near, a search will end in that

double square(double x) {
  return x * x;
}

dvec2 differentiate(const PatchPoint& p, const dvec3& eye, const dvec3& point) {
  const dvec3 gradient = glm::normalize(p.at - eye) + glm::normalize(p.at - point);
  return {glm::dot(gradient, p.alongU), glm::dot(gradient, p.alongV)};
}

/// Step 2 for one derivative; no branches, so that a loop of it runs on vectors.
template <std::size_t N>
CATOPTRIC_INLINE bool mayVanish(const std::array<double, N>& samples) {
  double least = samples[0], most = samples[0];
  for (const double s : samples) least = std::min(least, s), most = std::max(most, s);
  const double wider = kWider * (most - least);
  return bool(int(least - wider <= 0) & int(most + wider >= 0));
}

/// Of the corners and the middle.
bool mayVanish(const std::array<dvec2, 5>& s) {
  return mayVanish(std::array{s[0].x, s[1].x, s[2].x, s[3].x, s[4].x}) &&
         mayVanish(std::array{s[0].y, s[1].y, s[2].y, s[3].y, s[4].y});
}

/// differentiate() at all points of a grid, on vectors, and the nearer of E and Q, squared.
struct DifferentiateAll {
  static CATOPTRIC_INLINE void run(const GridPoints& grid, const dvec3& eye, const dvec3& point,
                                   double* alongU, double* alongV, double* nearest) {
    const double *x = grid.at[0].data(), *y = grid.at[1].data(), *z = grid.at[2].data();
    const double *ux = grid.alongU[0].data(), *uy = grid.alongU[1].data(), *uz = grid.alongU[2].data();
    const double *vx = grid.alongV[0].data(), *vy = grid.alongV[1].data(), *vz = grid.alongV[2].data();
    const double e0 = eye.x, e1 = eye.y, e2 = eye.z, q0 = point.x, q1 = point.y, q2 = point.z;
    const std::size_t count = grid.at[0].size();
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) {
      const double ex = x[i] - e0, ey = y[i] - e1, ez = z[i] - e2;
      const double qx = x[i] - q0, qy = y[i] - q1, qz = z[i] - q2;
      const double ee = ex * ex + ey * ey + ez * ez, qq = qx * qx + qy * qy + qz * qz;
      const double e = 1 / std::sqrt(ee), q = 1 / std::sqrt(qq);
      const double gx = ex * e + qx * q, gy = ey * e + qy * q, gz = ez * e + qz * q;
      alongU[i] = gx * ux[i] + gy * uy[i] + gz * uz[i];
      alongV[i] = gx * vx[i] + gy * vy[i] + gz * vz[i];
      nearest[i] = std::min(ee, qq);
    }
  }
};

/// Of the path along both parameters, at all points of a grid.
struct Slopes {
  std::vector<double> alongU, alongV, nearest;

  Slopes(const GridPoints& grid, const dvec3& eye, const dvec3& point)
      : alongU(grid.at[0].size()), alongV(alongU.size()), nearest(alongU.size()) {
    double *u = alongU.data(), *v = alongV.data(), *squared = nearest.data();
    core::runOnWidestVectors<DifferentiateAll>(grid, eye, point, u, v, squared);
  }
  [[nodiscard]] dvec2 operator[](std::size_t i) const { return {alongU[i], alongV[i]}; }
};

/// Step 2 for one derivative and a row of cells, given that in the nodes around and in the middles.
struct ClearWhereNotZero {
  static CATOPTRIC_INLINE void run(const double* nodes, const double* middles, std::size_t cells,
                                   std::uint8_t* may) {
    const double* above = nodes + cells + 1;
    for (std::size_t x = 0; x < cells; ++x)
      may[x] &=
          std::uint8_t(mayVanish(std::array{nodes[x], nodes[x + 1], above[x], above[x + 1], middles[x]}));
  }
};

void clearWhereNotZero(const double* nodes, const double* middles, std::vector<std::uint8_t>& may) {
  const std::size_t cells = may.size();
  std::uint8_t* to = may.data();
  core::runOnWidestVectors<ClearWhereNotZero>(nodes, middles, cells, to);
}

}  // namespace

void GridPoints::add(const PatchPoint& p) {
  for (int k = 0; k < 3; ++k) {
    at[std::size_t(k)].push_back(p.at[k]);
    alongU[std::size_t(k)].push_back(p.alongU[k]);
    alongV[std::size_t(k)].push_back(p.alongV[k]);
  }
}

struct SurfacePatch::Cell {
  int x, y, size;               ///< on the finest grid
  std::array<dvec2, 5> slopes;  ///< at the corners, row by row, and in the middle
  double nearest;               ///< from there to E or Q, squared
};

struct SurfacePatch::Query {
  dvec3 eye, point;
  std::vector<std::pair<int, int>> starts;  ///< of step 3, on the finest grid
  std::vector<dvec3> found;

  [[nodiscard]] bool isFound(const dvec3& at) const {
    return std::any_of(found.begin(), found.end(),
                       [&](const dvec3& other) { return glm::distance(other, at) < kSame; });
  }
};

SurfacePatch::SurfacePatch(Place place, const dvec2& lower, const dvec2& upper, int cellsU, int cellsV)
    : place_(std::move(place)),
      lower_(lower),
      upper_(upper),
      step_((upper - lower) / dvec2(cellsU * kFinest, cellsV * kFinest)),
      cellsU_(cellsU),
      cellsV_(cellsV) {
  for (int y = 0; y <= cellsV * kFinest; y += kKept)
    for (int x = 0; x <= cellsU * kFinest; x += kKept) kept_.push_back(place_(lower_ + step_ * dvec2(x, y)));
  for (int y = 0; y <= cellsV; ++y)
    for (int x = 0; x <= cellsU; ++x) {
      nodes_.add(placeAt(kFinest * x, kFinest * y));
      if (x < cellsU && y < cellsV)
        middles_.add(placeAt(kFinest * x + kFinest / 2, kFinest * y + kFinest / 2));
      if (x > 0 && y > 0)
        diagonal_ = std::max(diagonal_, glm::distance(placeAt(kFinest * x, kFinest * y).at,
                                                      placeAt(kFinest * (x - 1), kFinest * (y - 1)).at));
    }
}

PatchPoint SurfacePatch::placeAt(int x, int y) const {
  if ((x | y) % kKept != 0) return place_(lower_ + step_ * dvec2(x, y));
  return kept_[std::size_t(y / kKept) * std::size_t(cellsU_ * kFinest / kKept + 1) + std::size_t(x / kKept)];
}

std::vector<dvec3> SurfacePatch::findStationary(const dvec3& eye, const dvec3& point) const {
  Query query{eye, point, {}, {}};
  const Slopes nodes(nodes_, eye, point), middles(middles_, eye, point);
  const std::size_t cells = std::size_t(cellsU_), row = cells + 1;
  std::vector<std::uint8_t> may(cells);
  for (std::size_t y = 0; y < std::size_t(cellsV_); ++y) {
    std::fill(may.begin(), may.end(), std::uint8_t(1));
    clearWhereNotZero(&nodes.alongU[y * row], &middles.alongU[y * cells], may);
    clearWhereNotZero(&nodes.alongV[y * row], &middles.alongV[y * cells], may);
    for (std::size_t x = 0; x < cells; ++x) {
      const std::size_t at = y * row + x, middle = y * cells + x;
      if (const Cell cell{int(x) * kFinest,
                          int(y) * kFinest,
                          kFinest,
                          {nodes[at], nodes[at + 1], nodes[at + row], nodes[at + row + 1], middles[middle]},
                          middles.nearest[middle]};
          may[x] || isNear(cell))
        ask(query, cell);
    }
  }
  std::sort(query.starts.begin(), query.starts.end());  // cells side by side share corners
  query.starts.erase(std::unique(query.starts.begin(), query.starts.end()), query.starts.end());
  for (const auto& [x, y] : query.starts) polish(query, lower_ + step_ * dvec2(x, y));
  return query.found;
}

/// Are E or Q nearer than it is long?
bool SurfacePatch::isNear(const Cell& cell) const {
  return cell.nearest < square(diagonal_ * cell.size / kFinest);
}

/// Step 2 for the quarters of a cell that may hold a root.
void SurfacePatch::ask(Query& query, const Cell& cell) const {
  const int half = cell.size / 2, quarter = cell.size / 4;
  if (quarter == 0 || (cell.size <= kLeaf && !isNear(cell))) {
    query.starts.insert(query.starts.end(), {{cell.x + half, cell.y + half},
                                             {cell.x, cell.y},
                                             {cell.x + cell.size, cell.y},
                                             {cell.x, cell.y + cell.size},
                                             {cell.x + cell.size, cell.y + cell.size}});
    return;
  }
  const auto slopeAt = [&](int x, int y) {
    return differentiate(placeAt(cell.x + x, cell.y + y), query.eye, query.point);
  };
  const auto& s = cell.slopes;
  const std::array<std::array<dvec2, 3>, 3> at{{{s[0], slopeAt(half, 0), s[1]},
                                                {slopeAt(0, half), s[4], slopeAt(cell.size, half)},
                                                {s[2], slopeAt(half, cell.size), s[3]}}};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      const auto &low = at[std::size_t(y)], &high = at[std::size_t(y) + 1];
      const std::size_t left = std::size_t(x), right = left + 1;
      const PatchPoint middle = placeAt(cell.x + x * half + quarter, cell.y + y * half + quarter);
      const Cell part{
          cell.x + x * half,
          cell.y + y * half,
          half,
          {low[left], low[right], high[left], high[right], differentiate(middle, query.eye, query.point)},
          square(std::min(glm::distance(middle.at, query.eye), glm::distance(middle.at, query.point)))};
      if (mayVanish(part.slopes) || isNear(part)) ask(query, part);
    }
}

/// Step 3.
void SurfacePatch::polish(Query& query, dvec2 uv) const {
  const auto slopeAt = [&](const dvec2& place) {
    return differentiate(place_(place), query.eye, query.point);
  };
  const dvec2 cell = double(kFinest) * step_;
  for (int step = 0; step < 12; ++step) {
    const PatchPoint p = place_(uv);
    if (query.isFound(p.at)) return;
    const dvec2 here = differentiate(p, query.eye, query.point);
    if (std::max(std::abs(here.x), std::abs(here.y)) < kStationary) {
      const dvec2 inside = (uv - lower_) / (upper_ - lower_);
      if (std::min(inside.x, inside.y) < 0 || std::max(inside.x, inside.y) > 1) return;
      query.found.push_back(p.at);
      return;
    }
    const dvec2 dx = (slopeAt(uv + dvec2(kDifference, 0)) - here) / kDifference,
                dy = (slopeAt(uv + dvec2(0, kDifference)) - here) / kDifference;
    const double determinant = dx.x * dy.y - dy.x * dx.y;
    const dvec2 move{(dy.x * here.y - dy.y * here.x) / determinant,
                     (dx.y * here.x - dx.x * here.y) / determinant};
    const double length = std::max(std::abs(move.x / cell.x), std::abs(move.y / cell.y));
    if (!(length < 1e300)) return;
    uv += move * std::min(1.0, 0.5 / std::max(length, 1e-300));
  }
}

std::vector<double> findAngles(const std::function<double(double)>& function) {
  std::vector<double> found;
  const auto halve = [&](double low, double high, double atLow) {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      ((function(middle) < 0) == (atLow < 0) ? low : high) = middle;
    }
    found.push_back(0.5 * (low + high));
  };
  const std::function<void(double, double, double, double, int)> ask =
      [&](double low, double high, double atLow, double atHigh, int depth) {
        const double middle = 0.5 * (low + high), atMiddle = function(middle);
        if (!mayVanish(std::array{atLow, atMiddle, atHigh})) return;
        if (depth == 0) {
          if ((atLow < 0) != (atMiddle < 0)) halve(low, middle, atLow);
          if ((atMiddle < 0) != (atHigh < 0)) halve(middle, high, atMiddle);
          return;
        }
        ask(low, middle, atLow, atMiddle, depth - 1);
        ask(middle, high, atMiddle, atHigh, depth - 1);
      };
  constexpr double kTurn = 6.283185307179586;
  for (int i = 0; i < kAngles; ++i) {
    const double low = kTurn * i / kAngles, high = kTurn * (i + 1) / kAngles;
    ask(low, high, function(low), function(high), kAngleDepth);
  }
  return found;
}

}  // namespace catoptric::virtual_object
