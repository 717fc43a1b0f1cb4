// SPDX-License-Identifier: Apache-2.0
#include "root_judge.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::virtual_object {
namespace {

constexpr double kWider = 0.5;         // of a range, to both sides
constexpr int kDepth = 4;              // of subdivision
constexpr int kAngles = 256;           // samples of a turn
constexpr int kAngleDepth = 10;        // of subdivision there
constexpr double kDifference = 1e-7;   // of parameters
constexpr double kStationary = 1e-10;  // of the path's derivative along a unit tangent
constexpr double kSame = 1e-6;         // roots nearer are one

dvec2 differentiate(const PatchPoint& p, const dvec3& eye, const dvec3& point) {
  const dvec3 gradient = glm::normalize(p.at - eye) + glm::normalize(p.at - point);
  return {glm::dot(gradient, p.alongU), glm::dot(gradient, p.alongV)};
}

template <std::size_t N>
bool mayVanish(const std::array<double, N>& samples) {
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  const double wider = kWider * (*most - *least);
  return *least - wider <= 0 && *most + wider >= 0;
}

/// Step 2; the middle last.
bool mayVanish(const std::array<dvec2, 5>& s) {
  return mayVanish(std::array{s[0].x, s[1].x, s[2].x, s[3].x, s[4].x}) &&
         mayVanish(std::array{s[0].y, s[1].y, s[2].y, s[3].y, s[4].y});
}

}  // namespace

struct SurfacePatch::Query {
  dvec3 eye, point;
  std::vector<dvec3> found;
};

SurfacePatch::SurfacePatch(Place place, const dvec2& lower, const dvec2& upper, int cellsU, int cellsV)
    : place_(std::move(place)),
      lower_(lower),
      cell_((upper - lower) / dvec2(cellsU, cellsV)),
      cellsU_(cellsU),
      cellsV_(cellsV) {
  for (int y = 0; y <= cellsV; ++y)
    for (int x = 0; x <= cellsU; ++x) {
      nodes_.push_back(place_(lower_ + cell_ * dvec2(x, y)));
      if (x < cellsU && y < cellsV) middles_.push_back(place_(lower_ + cell_ * (dvec2(x, y) + 0.5)));
    }
}

std::vector<dvec3> SurfacePatch::findStationary(const dvec3& eye, const dvec3& point) const {
  Query query{eye, point, {}};
  std::vector<dvec2> at(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) at[i] = differentiate(nodes_[i], eye, point);
  const std::size_t row = std::size_t(cellsU_) + 1;
  for (int y = 0; y < cellsV_; ++y)
    for (int x = 0; x < cellsU_; ++x) {
      const dvec2* corner = &at[std::size_t(y) * row + std::size_t(x)];
      const dvec2 middle =
          differentiate(middles_[std::size_t(y) * std::size_t(cellsU_) + std::size_t(x)], eye, point);
      if (mayVanish({corner[0], corner[1], corner[row], corner[row + 1], middle}))
        ask(query, lower_ + cell_ * dvec2(x, y), cell_, kDepth);
    }
  return query.found;
}

/// Steps 2 and 3 for a cell that may hold a root.
void SurfacePatch::ask(Query& query, const dvec2& lower, const dvec2& size, int depth) const {
  if (depth == 0) {
    for (const dvec2& share : {dvec2(0.5), dvec2(0), dvec2(1, 0), dvec2(0, 1), dvec2(1)})
      polish(query, lower + size * share);
    return;
  }
  std::array<std::array<dvec2, 5>, 5> at;  // by row and column
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x)
      if (x % 2 == y % 2)
        at[std::size_t(y)][std::size_t(x)] =
            differentiate(place_(lower + size * (0.25 * dvec2(x, y))), query.eye, query.point);
  for (std::size_t y = 0; y < 4; y += 2)
    for (std::size_t x = 0; x < 4; x += 2)
      if (mayVanish({at[y][x], at[y][x + 2], at[y + 2][x], at[y + 2][x + 2], at[y + 1][x + 1]}))
        ask(query, lower + size * (0.25 * dvec2(double(x), double(y))), 0.5 * size, depth - 1);
}

void SurfacePatch::polish(Query& query, dvec2 uv) const {
  const auto slopeAt = [&](const dvec2& place) {
    return differentiate(place_(place), query.eye, query.point);
  };
  for (int step = 0; step < 12; ++step) {
    const dvec2 here = slopeAt(uv);
    if (std::max(std::abs(here.x), std::abs(here.y)) < kStationary) {
      const dvec2 inside = (uv - lower_) / (cell_ * dvec2(cellsU_, cellsV_));
      if (std::min(inside.x, inside.y) < 0 || std::max(inside.x, inside.y) > 1) return;
      const dvec3 at = place_(uv).at;
      for (const dvec3& other : query.found)
        if (glm::distance(other, at) < kSame) return;
      query.found.push_back(at);
      return;
    }
    const dvec2 dx = (slopeAt(uv + dvec2(kDifference, 0)) - here) / kDifference,
                dy = (slopeAt(uv + dvec2(0, kDifference)) - here) / kDifference;
    const double determinant = dx.x * dy.y - dy.x * dx.y;
    const dvec2 move{(dy.x * here.y - dy.y * here.x) / determinant,
                     (dx.y * here.x - dx.x * here.y) / determinant};
    const double length = std::max(std::abs(move.x / cell_.x), std::abs(move.y / cell_.y));
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
