// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/epipolar_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::depth_reflection_map {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kPieces = 8;  // of the whole image, about

/// ceil(value) within [low, high]; the library's is a call.
int ceilWithin(double value, int low, int high) {
  if (!(value > low)) return low;
  if (value >= high) return high;
  const int whole = int(value);  // towards 0
  return double(whole) < value ? whole + 1 : whole;
}

}  // namespace

/// The part of the image on one side of the epipole's row and column. Slopes are distance in x over distance
/// in y from the epipole.
struct EpipolarOrder::Quadrant {
  dvec2 epipole;
  int columnBegin, columnEnd, rowBegin, rowEnd;
  bool isLeft, isBelow;  // of the epipole
  bool towards;          // nearer surfaces lie towards the epipole

  [[nodiscard]] std::uint64_t size() const {
    return std::uint64_t(columnEnd - columnBegin) * std::uint64_t(rowEnd - rowBegin);
  }
  /// How many zexels of a row have a slope below the given one; they are those next to the epipole.
  [[nodiscard]] int countBelow(int row, double slope) const {
    if (slope == kInfinity) return columnEnd - columnBegin;
    const double reach = slope * std::abs(row + 0.5 - epipole.y);
    return isLeft ? columnEnd - ceilWithin(epipole.x - reach - 0.5, columnBegin, columnEnd)
                  : ceilWithin(epipole.x + reach - 0.5, columnBegin, columnEnd) - columnBegin;
  }
};

/// The slope below which about a share of the quadrant lies, from every 16th row.
double EpipolarOrder::findSlope(const Quadrant& q, double share) {
  const double nearX = q.isLeft ? q.epipole.x - q.columnEnd : q.columnBegin - q.epipole.x;
  const double nearY = q.isBelow ? q.epipole.y - q.rowEnd : q.rowBegin - q.epipole.y;
  const double farX = nearX + (q.columnEnd - q.columnBegin), farY = nearY + (q.rowEnd - q.rowBegin);
  double low = std::atan2(std::max(nearX, 0.0), farY), high = std::atan2(farX, std::max(nearY, 0.0));
  for (int step = 0; step < 12; ++step) {
    const double slope = std::tan(0.5 * (low + high));
    double below = 0, all = 0;
    for (int row = q.rowBegin; row < q.rowEnd; row += 16) {
      below += q.countBelow(row, slope);
      all += q.columnEnd - q.columnBegin;
    }
    (below < share * all ? low : high) = 0.5 * (low + high);
  }
  return std::tan(0.5 * (low + high));
}

void EpipolarOrder::addWedge(const Quadrant& q, double fromSlope, double toSlope) {
  Sheet sheet;
  sheet.firstRun = std::uint32_t(runs_.size());
  // 2
  const bool upwards = q.isBelow == q.towards;
  sheet.leftToRight = q.isLeft == q.towards;
  for (int i = 0; i < q.rowEnd - q.rowBegin; ++i) {
    const int row = upwards ? q.rowBegin + i : q.rowEnd - 1 - i;
    const int from = fromSlope > 0 ? q.countBelow(row, fromSlope) : 0, to = q.countBelow(row, toSlope);
    if (from >= to) continue;
    runs_.push_back(q.isLeft ? ZexelRun{row, q.columnEnd - to, q.columnEnd - from}
                             : ZexelRun{row, q.columnBegin + from, q.columnBegin + to});
    sheet.zexels += std::uint64_t(to - from);
  }
  sheet.runCount = std::uint32_t(runs_.size()) - sheet.firstRun;
  if (sheet.runCount > 0) sheets_.push_back(sheet);
}

void EpipolarOrder::compute(int width, int height, const dvec3& homogeneous) {
  sheets_.clear();
  runs_.clear();
  // 1. An epipole farther away than this many image sizes is as good as at infinity.
  constexpr double kFar = 1e6;
  const double length = std::max(std::abs(homogeneous.x), std::abs(homogeneous.y));
  const double leastW = length / (kFar * std::max(width, height));
  const bool towards = homogeneous.z >= 0.0;
  const double w = std::max(std::abs(homogeneous.z), std::max(leastW, 1e-300)) * (towards ? 1.0 : -1.0);
  const dvec2 epipole(homogeneous.x / w, homogeneous.y / w);
  const int column = int(std::clamp(std::ceil(epipole.x - 0.5), 0.0, double(width)));
  const int row = int(std::clamp(std::ceil(epipole.y - 0.5), 0.0, double(height)));

  for (int corner = 0; corner < 4; ++corner) {
    const bool isLeft = corner % 2 == 0, isBelow = corner < 2;
    const Quadrant quadrant{epipole,
                            isLeft ? 0 : column,
                            isLeft ? column : width,
                            isBelow ? 0 : row,
                            isBelow ? row : height,
                            isLeft,
                            isBelow,
                            towards};
    if (quadrant.size() == 0) continue;
    // 3
    const double share = double(quadrant.size()) / (double(width) * height);
    const int pieces = std::max(1, int(std::lround(share * kPieces)));
    double from = 0;
    for (int piece = 1; piece <= pieces; ++piece) {
      const double to = piece == pieces ? kInfinity : findSlope(quadrant, double(piece) / pieces);
      addWedge(quadrant, from, to);
      from = to;
    }
  }
}

}  // namespace catoptric::depth_reflection_map
