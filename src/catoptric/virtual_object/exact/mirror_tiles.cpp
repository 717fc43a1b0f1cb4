// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/exact/mirror_tiles.h"

#include <algorithm>

namespace catoptric::virtual_object {

void Cover::clear() {
  for (std::vector<CoverRect>* rects : {&opaque, &masked, &blended, &parts}) rects->clear();
  offeredPixels = 0;
}

void Cover::append(const Cover& other) {
  const auto add = [](std::vector<CoverRect>& to, const std::vector<CoverRect>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(opaque, other.opaque), add(masked, other.masked), add(blended, other.blended), add(parts, other.parts);
  offeredPixels += other.offeredPixels;
}

CoverRect MirrorTile::within(const CoverQuery& q) const {
  const int x0 = std::max(x, q.x), x1 = std::min(x + edge, q.x + q.width);
  const int y0 = std::max(y, q.y), y1 = std::min(y + edge, q.y + q.height);
  return {std::uint16_t(x0), std::uint16_t(y0), std::uint16_t(std::max(x1 - x0, 0)),
          std::uint16_t(std::max(y1 - y0, 0)), 0};
}

MirrorTile MirrorTile::quarter(int k) const {
  const int half = edge / 2;
  return {x + (k & 1) * half, y + (k >> 1) * half, half};
}

bool TileRays::gather(const RayImages& rays, const CoverQuery& q, const MirrorTile& tile) {
  origins.clear();
  directions.clear();
  pixels.clear();
  const CoverRect rect = tile.within(q);
  for (int y = rect.y; y < rect.y + rect.height; ++y)
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(rays.widthPx) + std::size_t(x);
      if (rays.words[i].y != q.word) continue;
      origins.push_back(rays.origins[i]);
      directions.push_back(rays.directions[i]);
      pixels.push_back(std::uint32_t((y - q.y) * q.width + (x - q.x)));
    }
  return !origins.empty();
}

void notePart(std::uint32_t part, std::vector<std::uint32_t>& parts) {
  if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(part);
}

}  // namespace catoptric::virtual_object
