// SPDX-License-Identifier: Apache-2.0
// Question: which zexel of a reference image does each pixel of a new view show (Bastos & Stuerzlinger 1998,
// section 4.1)?
//
// Inputs: a zexel map; the reference's and the view's centre of projection and the directions of their zexels
// and pixels, world space, metres; the rectangle of pixels that is wanted. Output: for each of them the
// number of the zexel that it shows, 0 where there is none.
//   1. Eq. 3: x_o = d(x_i) P_o^-1 (c_i - c_o) + P_o^-1 P_i x_i, homogeneous; d is the disparity of eq. 4. It
//      is linear in the column, so a run of zexels costs three additions and a division each.
//   2. Tiles of zexels whose image, bounded by that of their eight corners in (column, row, disparity),
//      misses the rectangle are left out as wholes.
//   3. Sheets are warped in occlusion-compatible order (epipolar_order.h), each thread its own sheets into
//      a winner image of its own; the images are laid over one another in the order of the sheets.
//   4. A zexel is splatted: on one pixel, on 3x3, or on the pixels within its own footprint, which the
//      derivatives of step 1 give, with the slope of the disparity towards its neighbours on one surface.
// Departures: winners instead of colours, so that colours are fetched once per pixel (by the GPU) and not
// once per zexel; footprints. `Visibility::ZBuffer` takes the nearest instead of the last, for comparison.
// Known failures: exposures, where no reference saw what the view shows; a splat rounds silhouettes by up
// to its radius. Cost: linear in zexels, independent of the scene (README).
#pragma once

#include <cstdint>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/depth_reflection_map/epipolar_order.h"
#include "catoptric/depth_reflection_map/zexel_landing.h"
#include "catoptric/depth_reflection_map/zexel_map.h"
#include "catoptric/depth_reflection_map/zexel_options.h"

namespace catoptric::depth_reflection_map {

/// Pixels (x, y) show centre + t worldFromPixel (x, y, 1), t > 0; the middle of the first is (0.5, 0.5).
struct Pinhole {
  dvec3 centre{0};
  dmat3 worldFromPixel{1.0};
};

struct PixelRectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

struct WarpOptions {
  Splat splat = Splat::Footprint;
  Visibility visibility = Visibility::Ordered;
  int level = 0;             ///< of the hierarchical map
  bool skipsRegions = true;  ///< step 2
};

/// The zexel that each pixel of a rectangle shows.
struct WinnerImage {
  static constexpr int kBorder = 8;  ///< pixels around the rectangle that splats may write to

  PixelRectangle rectangle;
  int stride = 0, rows = 0;            ///< with the border
  std::vector<std::uint32_t> winners;  ///< zexel of level 0 + 1, with the tag; 0 = none
  std::vector<float> nearness;         ///< ZBuffer only: 1 / depth, -1 = none
  PixelBox written;                    ///< with the border; all other winners are 0

  void reset(const PixelRectangle& bounds, bool withNearness);
  /// As reset(), but what the winners are is not defined.
  void resize(const PixelRectangle& bounds, bool withNearness);
  [[nodiscard]] bool hasLayoutOf(const WinnerImage& other) const {
    return stride == other.stride && winners.size() == other.winners.size() &&
           nearness.size() == other.nearness.size();
  }
  /// Pixel of the rectangle, (0, 0) its lower left one.
  [[nodiscard]] std::uint32_t at(int x, int y) const {
    return winners[std::size_t(y + kBorder) * std::size_t(stride) + std::size_t(x + kBorder)];
  }
  [[nodiscard]] std::uint32_t& at(int x, int y) {
    return winners[std::size_t(y + kBorder) * std::size_t(stride) + std::size_t(x + kBorder)];
  }
};

/// The upper two bits of a winner say which reference it is of.
constexpr std::uint32_t kWinnerTagShift = 30, kWinnerIndexMask = (1u << kWinnerTagShift) - 1u;

class ForwardWarp {
 public:
  /// Returns how many zexels were warped. Keeps its memory from call to call.
  std::uint64_t warp(const ZexelMap& map, const Pinhole& reference, const Pinhole& view,
                     const PixelRectangle& rectangle, std::uint32_t tag, const WarpOptions& options,
                     WinnerImage& out);

 private:
  struct Setup;
  void findVisibleTiles(const ZexelLevel& level, const Setup& setup, const WinnerImage& image, bool skips);
  [[nodiscard]] std::uint64_t countVisible(const ZexelLevel& level, const Sheet& sheet) const;
  void shareSheets(const ZexelLevel& level, std::size_t threads, std::uint64_t clearing);
  std::uint64_t warpSheets(const ZexelLevel& level, const Setup& setup, std::size_t first, std::size_t last,
                           const WarpOptions& options, WinnerImage& out) const;

  EpipolarOrder order_;
  std::vector<std::uint8_t> visibleTiles_;
  std::vector<std::uint32_t> visibleBefore_;  ///< zexels of a row before each tile, and before its end
  std::vector<std::uint64_t> sheetWork_;
  std::vector<std::size_t> firstSheets_;  ///< of each thread, and the end
  std::vector<WinnerImage> layers_;  ///< of the threads after the first; between calls nothing is in them
};

/// Pixels that `first` does not show are taken from `second`; both have the same rectangle.
void fillExposures(const WinnerImage& second, WinnerImage& first);

}  // namespace catoptric::depth_reflection_map
