// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/exposures.h"

#include <algorithm>
#include <vector>

namespace catoptric::depth_reflection_map {
namespace {

constexpr int kReachPx = 12;  ///< surfaces are continued as far as this

/// The farthest of the winners that are the first ones in eight directions; 0 if there is none.
std::uint32_t findFarthestNeighbour(const WinnerImage& image, int x, int y,
                                    const std::function<double(std::uint32_t)>& distance) {
  std::uint32_t best = 0;
  double farthest = 0;
  for (int direction = 0; direction < 9; ++direction) {
    const int dx = direction % 3 - 1, dy = direction / 3 - 1;
    for (int step = 1; step <= kReachPx && (dx != 0 || dy != 0); ++step) {
      const int atX = x + step * dx, atY = y + step * dy;
      if (atX < 0 || atY < 0 || atX >= image.rectangle.width || atY >= image.rectangle.height) break;
      const std::uint32_t winner = image.at(atX, atY);
      if (winner == 0) continue;
      const double d = distance(winner);
      if (d > farthest) farthest = d, best = winner;
      break;
    }
  }
  return best;
}

}  // namespace

Coverage measureCoverage(const WinnerImage& image, const MirrorPixels& mirror) {
  const PixelRectangle& r = image.rectangle;
  Coverage coverage;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      if (!mirror.contains(r.x + x, r.y + y)) continue;
      ++coverage.pixels;
      coverage.uncovered += image.at(x, y) == 0 ? 1 : 0;
    }
  return coverage;
}

void markExposures(const MirrorPixels& mirror, WinnerImage& image) {
  const PixelRectangle& r = image.rectangle;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x)
      if (image.at(x, y) == 0 && mirror.contains(r.x + x, r.y + y)) image.at(x, y) = kExposed;
}

void keepLastFrame(const WinnerImage& last, const std::array<std::uint32_t, 4>& tags, WinnerImage& image) {
  const PixelRectangle &now = image.rectangle, &before = last.rectangle;
  const int x0 = std::max(now.x, before.x), x1 = std::min(now.x + now.width, before.x + before.width);
  const int y0 = std::max(now.y, before.y), y1 = std::min(now.y + now.height, before.y + before.height);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      std::uint32_t& winner = image.at(x - now.x, y - now.y);
      if (winner != 0) continue;
      const std::uint32_t kept = last.at(x - before.x, y - before.y);
      const std::uint32_t tag = tags[kept >> kWinnerTagShift];
      if (kept != 0 && tag != kNoTag) winner = (kept & kWinnerIndexMask) | (tag << kWinnerTagShift);
    }
}

void continueSurfaces(const MirrorPixels& mirror, WinnerImage& image,
                      const std::function<double(std::uint32_t)>& distance) {
  struct Found {
    int x, y;
    std::uint32_t winner;
  };
  std::vector<Found> found;  // written afterwards: a surface is not continued from where it was continued to
  const PixelRectangle& r = image.rectangle;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x)
      if (image.at(x, y) == 0 && mirror.contains(r.x + x, r.y + y))
        if (const std::uint32_t winner = findFarthestNeighbour(image, x, y, distance))
          found.push_back({x, y, winner});
  for (const Found& f : found) image.at(f.x, f.y) = f.winner;
}

}  // namespace catoptric::depth_reflection_map
