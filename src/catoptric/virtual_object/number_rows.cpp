// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/number_rows.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "catoptric/core/eight_lanes.h"

namespace catoptric::virtual_object {
namespace {

using core::Eight;
using core::EightInts;
using core::kLanes;

/// How far it is along the rays of eight pixels of a row to where a step along the camera's axis ends.
CATOPTRIC_INLINE Eight findLengths(const PixelRays& rays, int x, int y) {
  const Eight column = Eight{0, 1, 2, 3, 4, 5, 6, 7} + float(x);
  Eight d[3];
  for (int k = 0; k < 3; ++k) d[k] = rays.corner[k] + rays.stepX[k] * column + rays.stepY[k] * float(y);
  return core::squareRoot(core::dot(d, d));
}

struct BeginRows {
  static CATOPTRIC_INLINE void run(const NumberPicture& picture, const PixelRays& rays, int& begin, int& end,
                                   const NumberRaster::Rows& rows) {
    const int width = picture.bounds.width;
    for (int y = begin; y < end; ++y) {
      const uvec2* ids = picture.parentIds.data() + std::ptrdiff_t(picture.bounds.y + y) * picture.widthPx +
                         picture.bounds.x;
      const vec4* mirror = picture.mirror.data() + std::ptrdiff_t(y) * width;
      const std::ptrdiff_t at = std::ptrdiff_t(y) * rows.stride;
      std::fill_n(rows.nearness + at, rows.stride, 0.0f);
      std::fill_n(rows.numbers + at, rows.stride, 0u);
      if (rows.rivalNearness != nullptr) {
        std::fill_n(rows.rivalNearness + at, rows.stride, 0.0f);
        std::fill_n(rows.rivals + at, rows.stride, 0u);
      }
      for (int x = 0; x < width; x += kLanes) {
        const int count = std::min(width - x, kLanes);
        Eight path{};
        EightInts isMirror{};
        for (int i = 0; i < count; ++i) {
          path[i] = mirror[x + i].w;
          isMirror[i] = ids[x + i].y == picture.parentWord ? -1 : 0;
        }
        const Eight limits = findLengths(rays, x, y) / (path * 0.99999f);
        core::store(rows.limits + at + x, isMirror ? limits : Eight{} - 1.0f);
      }
      std::fill_n(rows.limits + at + width, kLanes, -1.0f);
    }
  }
};

struct FinishRows {
  static CATOPTRIC_INLINE void run(const NumberPicture& picture, const PixelRays& rays, int& begin, int& end,
                                   const NumberRaster::Rows& rows, NumberImage& image) {
    const int width = picture.bounds.width;
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < width; x += kLanes) {
        const std::ptrdiff_t from = std::ptrdiff_t(y) * rows.stride + x;
        const std::size_t to = std::size_t(y) * std::size_t(width) + std::size_t(x),
                          count = std::size_t(std::min(width - x, kLanes));
        const Eight n = core::load(rows.nearness + from), lengths = findLengths(rays, x, y) / n;
        EightInts numbers, bits;
        std::memcpy(&numbers, rows.numbers + from, sizeof numbers);
        std::memcpy(&bits, &lengths, sizeof bits);
        bits = numbers == 0 ? EightInts{} : bits;
        const EightInts hits[2] = {__builtin_shufflevector(numbers, bits, 0, 8, 1, 9, 2, 10, 3, 11),
                                   __builtin_shufflevector(numbers, bits, 4, 12, 5, 13, 6, 14, 7, 15)};
        std::memcpy(&image.hits[to], hits, count * sizeof(uvec2));
        const Eight depths = rays.depth + rays.depthStep * n;
        if (picture.withDepths) std::memcpy(&image.depths[to], &depths, count * sizeof(float));
      }
  }
};

struct FindRivals {
  static CATOPTRIC_INLINE void run(int& begin, int& end, const NumberRaster::Rows& rows,
                                   std::span<const uvec2>& hits, std::span<const float>& depths,
                                   std::vector<Rival>& found) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < rows.width; x += kLanes) {
        const std::ptrdiff_t from = std::ptrdiff_t(y) * rows.stride + x;
        const Eight n = core::load(rows.nearness + from), rival = core::load(rows.rivalNearness + from);
        for (unsigned lanes = core::toBits((rival > 0.0f) & (rival >= kAboutAsNear * n)); lanes != 0;
             lanes &= lanes - 1) {
          const int i = std::countr_zero(lanes);
          const auto pixel = std::uint32_t(y * rows.width + x + i);
          const float length = std::bit_cast<float>(hits[pixel].y);
          found.push_back({pixel, rows.rivals[from + i], length * n[i] / rival[i],
                           depths.empty() ? 0.0f : depths[pixel]});
        }
      }
  }
};

}  // namespace

PixelRays::PixelRays(const NumberPicture& picture) {
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

void beginRows(const NumberPicture& picture, const PixelRays& rays, int begin, int end,
               const NumberRaster::Rows& rows) {
  core::runOnWidestVectors<BeginRows>(picture, rays, begin, end, rows);
}

void finishRows(const NumberPicture& picture, const PixelRays& rays, int begin, int end,
                const NumberRaster::Rows& rows, NumberImage& image) {
  core::runOnWidestVectors<FinishRows>(picture, rays, begin, end, rows, image);
}

void findRivals(int begin, int end, const NumberRaster::Rows& rows, std::span<const uvec2> hits,
                std::span<const float> depths, std::vector<Rival>& found) {
  found.clear();
  core::runOnWidestVectors<FindRivals>(begin, end, rows, hits, depths, found);
}

void findNeighbours(const NumberPicture& picture, int begin, int end, const NumberImage& image,
                    std::vector<Rival>& found) {
  const gl::Scissor& b = picture.bounds;
  for (int y = begin; y < end; ++y) {
    const std::ptrdiff_t first = std::ptrdiff_t(y) * b.width;
    const uvec2 *here = image.hits.data() + first, *below = y > 0 ? here - b.width : here,
                *above = y + 1 < b.height ? here + b.width : here;
    const uvec2* ids = picture.parentIds.data() + std::ptrdiff_t(b.y + y) * picture.widthPx + b.x;
    for (int x = 0; x < b.width; ++x) {
      if (here[x].x != 0) continue;
      const uvec2* beside[] = {here + std::max(x - 1, 0), here + std::min(x + 1, b.width - 1), below + x,
                               above + x};
      if ((beside[0]->x | beside[1]->x | beside[2]->x | beside[3]->x) == 0) continue;
      if (ids[x].y != picture.parentWord) continue;
      std::uint32_t last = 0;
      for (const uvec2* hit : beside) {
        if (hit->x == 0 || hit->x == last) continue;
        last = hit->x;
        const auto at = std::size_t(hit - image.hits.data());
        found.push_back({std::uint32_t(first + x), hit->x, std::bit_cast<float>(hit->y),
                         image.depths.empty() ? 0.0f : image.depths[at]});
      }
    }
  }
}

}  // namespace catoptric::virtual_object
