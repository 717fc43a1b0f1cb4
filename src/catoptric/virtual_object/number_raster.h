// SPDX-License-Identifier: Apache-2.0
// Which triangle is seen at each mirror pixel, found by the processor: what numbered_triangles.h asks a GPU.
//
// In:  virtual vertices in pixels, which virtual triangles are worth drawing, and for each mirror pixel how
//      long the path to the mirror is.
// Out: for each pixel the number of the nearest triangle whose virtual image its centre lies in, the length
//      of the path to it, and its depth: HitShading's images.
// Steps:
//   1. Triangles, some thousand at a time, to 1/256 of a pixel, eight side by side (triangle_lanes.h). Edge
//      functions are integers and follow the top-left rule, so that neighbours leave no gap and no pixel
//      twice. Into bands of rows come, of tiny ones, the pixels whose centres lie inside; of the others the
//      triangle, where it touches the band.
//   2. Band by band, in their order, pixels of tiny triangles one by one, other triangles eight pixels of a
//      row side by side: inside of all three edges, nearer than what is there (1 / w, which is linear on the
//      screen), not before the mirror (1998, section 3)? Triangles wider than TriangleGroup::kLargestPx, for
//      which edge functions would not fit, go through item_rasterizer.h; those that reach behind the eye or
//      far off the picture are cut first.
//   3. 1 / w to lengths and depths. Virtual triangles sag behind the curved images that they stand for, so
//      which of two is nearer is told only if they are further apart than that; else the second one is kept,
//      too, for the pixel's own ray to decide (rivals.h). So are the neighbours' triangles of pixels that
//      show none: at the mirror's rim, where all is squeezed, a wall may end half a pixel too soon.
// Bands are drawn on all cores, each with its triangles in their order, so the result does not depend on
// their number.
// Why: Mesa's llvmpipe sets triangles up on one core, at about 0.25 us each, and reading numbers back waits
// for it. A GPU has no such trouble, and keeps its own way.
// Cost: about 40 ns a triangle of a few pixels, and 10 ns a pixel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/gl/framebuffer.h"
#include "catoptric/raster/tessellation.h"

namespace catoptric::virtual_object {

/// A mirror's picture, in numbers.
struct NumberPicture {
  mat4 clipFromDraw{1.0f};  ///< a perspective whose centre is `drawEye`
  dvec3 drawEye{0};
  int widthPx = 0, heightPx = 0;
  gl::Scissor bounds;
  std::span<const vec4> mirror;      ///< of the pixels of `bounds`; w: length of the path to the mirror
  std::span<const uvec2> parentIds;  ///< of the whole picture
  std::uint32_t parentWord = 0;      ///< of the mirror's pixels, in parentIds[].y
  std::span<const vec3> screen;      ///< virtual vertices: projectVertices()
  std::span<const vec3> virtualPositions;
  std::span<const std::uint8_t> isKept;          ///< by triangle of the objects
  std::span<const std::uint8_t> isWanted;        ///< by part
  std::span<const std::uint32_t> triangleParts;  ///< by number
  bool withDepths = true;                        ///< else NumberImage::depths are left out
  bool withRivals = false;                       ///< else NumberImage::rivals are left out
};

/// A triangle that is nearly as near at a pixel as the one that is seen there; or, where none is, that is
/// seen beside it.
struct Rival {
  std::uint32_t pixel;   ///< of the bounds, row by row
  std::uint32_t number;  ///< + 1
  float length;          ///< of the path
  float depth;           ///< 0 where NumberImage::depths are left out
};

/// Of the pixels of NumberPicture::bounds, row by row.
struct NumberImage {
  std::vector<uvec2> hits;                 ///< number + 1, 0: none; bits of the length of the path
  std::vector<float> depths;               ///< 0 to 1; empty: left out
  std::vector<std::vector<Rival>> rivals;  ///< in no order, as many pieces as it pleases
};

struct PixelRays;

class NumberRaster {
 public:
  /// Nothing is allocated once it has drawn pictures as large. Returns how many triangles were drawn.
  std::size_t draw(const raster::TessellatedObjects& objects, const NumberPicture& picture,
                   NumberImage& image);

  /// At a pixel, (0,0) the corner of the picture's bounds; in 1/256 px.
  struct Corner {
    std::int32_t x, y;
    float nearness;  ///< 1 / w
  };
  /// Edge functions and nearness, each at the centre of its first pixel, with their steps.
  struct SmallTriangle {
    std::int32_t x0, y0, width, height;
    std::int32_t edge[3], stepX[3], stepY[3];
    float nearness, nearX, nearY, least, most;
    std::uint32_t number;
  };
  struct LargeTriangle {
    Corner corners[3];
    std::uint32_t number;
  };
  /// What is drawn, in its order: a pixel of a tiny triangle, with its number + 1 and its nearness; or a
  /// triangle.
  struct Item {
    std::uint32_t at;  ///< a place in Rows; with kTriangleBit an index of Chunk::small, kLargeBit of ::large
    std::uint32_t number;
    float nearness;
  };
  /// Items of some rows; keeps its memory.
  class Band {
   public:
    void clear() { count_ = 0; }
    [[nodiscard]] std::span<const Item> items() const { return {items_.data(), count_}; }
    /// `more` items at the end, to be written by the caller.
    Item* makeRoom(std::size_t more) {
      if (items_.size() < count_ + more) items_.resize(2 * (count_ + more));
      count_ += more;
      return items_.data() + (count_ - more);
    }

   private:
    std::vector<Item> items_;
    std::size_t count_ = 0;
  };
  /// Step 1 of some triangles.
  struct Chunk {
    std::vector<SmallTriangle> small;
    std::vector<LargeTriangle> large;
    std::vector<Band> bands;
    std::size_t drawn = 0;
  };
  /// Pixels while they are drawn; rows are longer than the picture by eight pixels.
  struct Rows {
    float *nearness, *limits;
    std::uint32_t* numbers;
    float* rivalNearness;  ///< of the second nearest; null: left out
    std::uint32_t* rivals;
    int stride, width;
  };
  static constexpr std::uint32_t kTriangleBit = 0x80000000u, kLargeBit = 0x40000000u;

 private:
  void drawBand(const NumberPicture& picture, const PixelRays& rays, int band, NumberImage& image);

  std::vector<Chunk> chunks_;
  std::vector<float> nearness_, limits_, rivalNearness_;
  std::vector<std::uint32_t> numbers_, rivals_;
};

}  // namespace catoptric::virtual_object
