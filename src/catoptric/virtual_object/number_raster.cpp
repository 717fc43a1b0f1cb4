// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/number_raster.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "catoptric/core/eight_lanes.h"
#include "catoptric/core/parallel.h"
#include "catoptric/core/seen.h"
#include "catoptric/virtual_object/clip_to_screen.h"
#include "catoptric/virtual_object/item_rasterizer.h"

namespace catoptric::virtual_object {
namespace {

using core::Eight;
using core::EightInts;
using core::kLanes;
using Corner = NumberRaster::Corner;
using Corners = std::array<Corner, 3>;
using SmallTriangle = NumberRaster::SmallTriangle;

constexpr std::size_t kTrianglesPerTask = 4096;
constexpr int kBandRows = 16;
constexpr int kSub = 256;          // of a pixel
constexpr int kLargestPx = 64;     // edge functions of wider triangles do not fit into 32 bits
constexpr float kFarthest = 1e5f;  // pixels off the picture; beyond, triangles are cut

/// 1. Rounds to nearest, as item_rasterizer.h does.
Corner toCorner(const vec3& screen, const gl::Scissor& bounds) {
  return {std::int32_t(std::lrintf(screen.x * float(kSub))) - bounds.x * kSub,
          std::int32_t(std::lrintf(screen.y * float(kSub))) - bounds.y * kSub, screen.z};
}

bool isNearScreen(const vec3& s) {
  return std::abs(s.x) < kFarthest && std::abs(s.y) < kFarthest;  // false for a NaN
}

/// Pixels whose centres may lie in a triangle.
struct PixelBox {
  int x0, y0, x1, y1;
  [[nodiscard]] bool isEmpty() const { return x1 < x0 || y1 < y0; }
};

PixelBox findPixels(const Corners& c, int width, int height) {
  const auto [left, right] = std::minmax({c[0].x, c[1].x, c[2].x});
  const auto [low, high] = std::minmax({c[0].y, c[1].y, c[2].y});
  const auto first = [](int v) { return (v + kSub / 2 - 1) >> 8; };
  return {std::max(0, first(left)), std::max(0, first(low)), std::min(width - 1, (right - kSub / 2) >> 8),
          std::min(height - 1, (high - kSub / 2) >> 8)};
}

bool isLarge(const Corners& c) {
  const auto [left, right] = std::minmax({c[0].x, c[1].x, c[2].x});
  const auto [low, high] = std::minmax({c[0].y, c[1].y, c[2].y});
  return std::max(right - left, high - low) > kLargestPx * kSub;
}

/// False if it has no area.
bool setUp(Corners c, const PixelBox& box, std::uint32_t number, SmallTriangle& t) {
  std::int32_t area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
  if (area == 0) return false;
  if (area < 0) std::swap(c[1], c[2]), area = -area;
  t.x0 = box.x0, t.y0 = box.y0, t.width = box.x1 - box.x0 + 1, t.height = box.y1 - box.y0 + 1;
  t.number = number;
  const std::int32_t px = box.x0 * kSub + kSub / 2, py = box.y0 * kSub + kSub / 2;
  for (int k = 0; k < 3; ++k) {
    const Corner &a = c[std::size_t(k + 1) % 3], &b = c[std::size_t(k + 2) % 3];
    const std::int32_t dx = b.x - a.x, dy = b.y - a.y;
    t.stepX[k] = -dy * kSub, t.stepY[k] = dx * kSub;
    const std::int32_t bias = dy < 0 || (dy == 0 && dx > 0) ? 0 : -1;  // an edge's pixels belong to one side
    t.edge[k] = dx * (py - a.y) - dy * (px - a.x) + bias;
  }
  const float scale = float(kSub) / float(area);
  const float toB = (c[1].nearness - c[0].nearness) * scale, toC = (c[2].nearness - c[0].nearness) * scale;
  t.nearX = toB * float(c[2].y - c[0].y) - toC * float(c[1].y - c[0].y);
  t.nearY = toC * float(c[1].x - c[0].x) - toB * float(c[2].x - c[0].x);
  t.nearness = c[0].nearness + (float(px - c[0].x) * t.nearX + float(py - c[0].y) * t.nearY) / float(kSub);
  t.least = std::min({c[0].nearness, c[1].nearness, c[2].nearness});
  t.most = std::max({c[0].nearness, c[1].nearness, c[2].nearness});
  return true;
}

/// Puts triangles into a chunk.
struct Binner {
  const NumberPicture& picture;
  NumberRaster::Chunk& chunk;

  void add(const Corners& c, std::uint32_t number) {
    const PixelBox box = findPixels(c, picture.bounds.width, picture.bounds.height);
    if (box.isEmpty()) return;
    std::uint32_t index;
    if (isLarge(c)) {
      index = std::uint32_t(chunk.large.size()) | NumberRaster::kLargeBit;
      chunk.large.push_back({{c[0], c[1], c[2]}, number});
    } else {
      index = std::uint32_t(chunk.small.size());
      if (!setUp(c, box, number, chunk.small.emplace_back())) return chunk.small.pop_back();
    }
    for (int band = box.y0 / kBandRows; band <= box.y1 / kBandRows; ++band)
      chunk.bands[std::size_t(band)].push_back(index);
    ++chunk.drawn;
  }

  void add(const raster::TessellatedObjects& objects, std::size_t t) {
    const std::uint32_t* v = &objects.indices[3 * t];
    const std::uint32_t number = objects.sourceTriangles[t];
    const vec3 &a = picture.screen[v[0]], &b = picture.screen[v[1]], &c = picture.screen[v[2]];
    const gl::Scissor& bounds = picture.bounds;
    if (isNearScreen(a) && isNearScreen(b) && isNearScreen(c))
      return add({toCorner(a, bounds), toCorner(b, bounds), toCorner(c, bounds)}, number);
    std::array<vec4, 3> clip;
    for (std::size_t k = 0; k < 3; ++k)
      clip[k] = picture.clipFromDraw * vec4(picture.virtualPositions[v[k]], 1.0f);
    clipToScreen(clip, picture.widthPx, picture.heightPx, [&](const std::array<vec3, 3>& s) {
      add({toCorner(s[0], bounds), toCorner(s[1], bounds), toCorner(s[2], bounds)}, number);
    });
  }
};

/// 2. Rows [begin, end) of a triangle.
CATOPTRIC_INLINE void drawSmall(const SmallTriangle& t, int begin, int end, const NumberRaster::Rows& rows) {
  const EightInts lane{0, 1, 2, 3, 4, 5, 6, 7};
  const int first = std::max(begin, t.y0), last = std::min(end, t.y0 + t.height);
  EightInts edge[3];
  for (int k = 0; k < 3; ++k) edge[k] = t.edge[k] + (first - t.y0) * t.stepY[k] + lane * t.stepX[k];
  const Eight inRow = t.nearness + t.nearX * __builtin_convertvector(lane, Eight);
  for (int y = first; y < last; ++y) {
    const std::ptrdiff_t at = std::ptrdiff_t(y) * rows.stride + t.x0;
    const Eight near = inRow + t.nearY * float(y - t.y0);
    for (int x = 0; x < t.width; x += kLanes) {
      const EightInts outside =
          (edge[0] + x * t.stepX[0]) | (edge[1] + x * t.stepX[1]) | (edge[2] + x * t.stepX[2]);
      Eight n = near + t.nearX * float(x);
      n = n < t.least ? t.least + Eight{} : n > t.most ? t.most + Eight{} : n;
      const Eight stored = core::load(rows.nearness + at + x);
      const EightInts draws = (outside >= 0) & (n > stored) & (n <= core::load(rows.limits + at + x));
      core::store(rows.nearness + at + x, draws ? n : stored);
      EightInts numbers;
      std::memcpy(&numbers, rows.numbers + at + x, sizeof numbers);
      numbers = draws ? EightInts{} + std::int32_t(t.number + 1) : numbers;
      std::memcpy(rows.numbers + at + x, &numbers, sizeof numbers);
    }
    for (int k = 0; k < 3; ++k) edge[k] += t.stepY[k];
  }
}

void drawLarge(const NumberRaster::LargeTriangle& t, int begin, int end, const NumberRaster::Rows& rows) {
  std::array<dvec2, 3> px;
  for (std::size_t k = 0; k < 3; ++k)
    px[k] = dvec2(t.corners[k].x, t.corners[k].y - begin * kSub) / double(kSub);
  rasterizeTriangle(px, rows.width, end - begin, [&](int x, int y, const dvec3& weights) {
    const float n = float(weights.x * t.corners[0].nearness + weights.y * t.corners[1].nearness +
                          weights.z * t.corners[2].nearness);
    const std::ptrdiff_t at = std::ptrdiff_t(begin + y) * rows.stride + x;
    if (n <= rows.nearness[at] || n > rows.limits[at]) return;
    rows.nearness[at] = n;
    rows.numbers[at] = t.number + 1;
  });
}

struct DrawBand {
  static CATOPTRIC_INLINE void run(const std::vector<NumberRaster::Chunk>& chunks, const int& band,
                                   const int& end, const NumberRaster::Rows& rows) {
    const int begin = band * kBandRows;
    for (const NumberRaster::Chunk& chunk : chunks)
      for (const std::uint32_t index : chunk.bands[std::size_t(band)]) {
        if ((index & NumberRaster::kLargeBit) != 0)
          drawLarge(chunk.large[index & ~NumberRaster::kLargeBit], begin, end, rows);
        else
          drawSmall(chunk.small[index], begin, end, rows);
      }
  }
};

/// From a pixel to the ray through it, and from 1 / w to depth.
struct PixelRays {
  vec3 corner, stepX, stepY;  ///< draw space, a step along the camera's axis long
  float depth, depthStep;

  explicit PixelRays(const NumberPicture& picture) {
    const dmat4 rows = glm::transpose(dmat4(picture.clipFromDraw));
    const dmat3 drawFromNdc =
        glm::inverse(glm::transpose(dmat3(dvec3(rows[0]), dvec3(rows[1]), dvec3(rows[3]))));
    const dvec2 pixel = 2.0 / dvec2(picture.widthPx, picture.heightPx);
    const dvec2 first = (dvec2(picture.bounds.x, picture.bounds.y) + 0.5) * pixel - 1.0;
    corner = vec3(drawFromNdc * dvec3(first, 1.0));
    stepX = vec3(drawFromNdc[0] * pixel.x), stepY = vec3(drawFromNdc[1] * pixel.y);
    // z = a w + b
    const double a = glm::dot(dvec3(rows[2]), dvec3(rows[3])) / glm::dot(dvec3(rows[3]), dvec3(rows[3]));
    const double b = glm::dot(rows[2], dvec4(picture.drawEye, 1.0));
    depth = float(0.5 * a + 0.5), depthStep = float(0.5 * b);
  }
  [[nodiscard]] float lengthAt(int x, int y) const {
    const vec3 d = corner + stepX * float(x) + stepY * float(y);
    return std::sqrt(glm::dot(d, d));
  }
};

}  // namespace

void NumberRaster::drawBand(const NumberPicture& picture, int band, NumberImage& image) {
  const int width = picture.bounds.width, begin = band * kBandRows;
  const int end = std::min(begin + kBandRows, picture.bounds.height);
  const PixelRays rays(picture);
  const Rows rows{nearness_.data(), limits_.data(), numbers_.data(), width + kLanes, width};
  for (int y = begin; y < end; ++y) {
    const uvec2* ids =
        picture.parentIds.data() + std::ptrdiff_t(picture.bounds.y + y) * picture.widthPx + picture.bounds.x;
    const vec4* mirror = picture.mirror.data() + std::ptrdiff_t(y) * width;
    const std::ptrdiff_t at = std::ptrdiff_t(y) * rows.stride;
    std::fill_n(rows.nearness + at, rows.stride, 0.0f);
    std::fill_n(rows.numbers + at, rows.stride, 0u);
    for (int x = 0; x < width; ++x)
      rows.limits[at + x] =
          ids[x].y == picture.parentWord ? rays.lengthAt(x, y) / (mirror[x].w * 0.99999f) : -1.0f;
    std::fill_n(rows.limits + at + width, kLanes, -1.0f);
  }
  core::runOnWidestVectors<DrawBand>(chunks_, band, end, rows);
  // 3
  for (int y = begin; y < end; ++y)
    for (int x = 0; x < width; ++x) {
      const std::ptrdiff_t from = std::ptrdiff_t(y) * rows.stride + x;
      const std::size_t to = std::size_t(y) * std::size_t(width) + std::size_t(x);
      const float n = rows.nearness[from];
      image.hits[to] =
          uvec2(rows.numbers[from],
                rows.numbers[from] == 0 ? 0u : std::bit_cast<std::uint32_t>(rays.lengthAt(x, y) / n));
      if (picture.withDepths) image.depths[to] = rays.depth + rays.depthStep * n;
    }
}

std::size_t NumberRaster::draw(const raster::TessellatedObjects& objects, const NumberPicture& picture,
                               NumberImage& image) {
  const std::size_t triangles = objects.sourceTriangles.size();
  const std::size_t bands = std::size_t((picture.bounds.height + kBandRows - 1) / kBandRows);
  chunks_.resize((triangles + kTrianglesPerTask - 1) / kTrianglesPerTask);
  core::parallelFor(chunks_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Chunk& chunk = chunks_[i];
      chunk.small.clear(), chunk.large.clear(), chunk.drawn = 0;
      if (chunk.bands.size() < bands) chunk.bands.resize(bands);
      for (auto& band : chunk.bands) band.clear();
      Binner binner{picture, chunk};
      for (std::size_t t = i * kTrianglesPerTask; t < std::min(triangles, (i + 1) * kTrianglesPerTask); ++t)
        if (picture.isKept[t] && picture.isWanted[picture.triangleParts[objects.sourceTriangles[t]]])
          binner.add(objects, t);
    }
  });
  const std::size_t pixels = std::size_t(picture.bounds.width) * std::size_t(picture.bounds.height);
  const std::size_t padded = pixels + std::size_t(kLanes) * std::size_t(picture.bounds.height);
  nearness_.resize(padded), limits_.resize(padded), numbers_.resize(padded);
  image.hits.resize(pixels), image.depths.resize(picture.withDepths ? pixels : 0);
  core::parallelFor(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) drawBand(picture, int(band), image);
  });
  std::size_t drawn = 0;
  for (const Chunk& chunk : chunks_) drawn += chunk.drawn;
  return drawn;
}

}  // namespace catoptric::virtual_object
