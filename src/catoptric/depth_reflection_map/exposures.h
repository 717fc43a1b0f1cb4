// SPDX-License-Identifier: Apache-2.0
// Exposures: pixels of a mirror that no zexel reached (Bastos & Stuerzlinger 1998, section 4.1). How many
// there are, and what they show instead.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "catoptric/depth_reflection_map/forward_warp.h"

namespace catoptric::depth_reflection_map {

/// Which pixels of the picture show a mirror: those with this word in ids.g, bottom row first.
struct MirrorPixels {
  std::span<const uvec2> ids;
  int widthPx = 0;
  std::uint32_t word = 0;

  [[nodiscard]] bool contains(int x, int y) const {
    return ids[std::size_t(y) * std::size_t(widthPx) + std::size_t(x)].y == word;
  }
};

struct Coverage {
  std::uint64_t pixels = 0;     ///< of the mirror
  std::uint64_t uncovered = 0;  ///< of which no winner shows anything
};

[[nodiscard]] Coverage measureCoverage(const WinnerImage& image, const MirrorPixels& mirror);

/// Instead of a winner: the pixel is drawn as an exposure (zexel_resolve.frag has the same number).
constexpr std::uint32_t kExposed = 0xffffffffu;

void markExposures(const MirrorPixels& mirror, WinnerImage& image);

constexpr std::uint32_t kNoTag = 4;

/// The paper's colour coherence: an uncovered pixel keeps the zexel that it showed in the frame before.
/// `tags`: which reference each of the last frame's references is now; kNoTag = it is not in use any more.
void keepLastFrame(const WinnerImage& last, const std::array<std::uint32_t, 4>& tags, WinnerImage& image);

/// What an edge hid is most often the surface behind the edge, continued: an uncovered pixel gets the
/// farthest of the winners next to it, and so the plane of that zexel. `distance` is that of a winner's point
/// from the eye, 0 at the sky, which is not continued.
void continueSurfaces(const MirrorPixels& mirror, WinnerImage& image,
                      const std::function<double(std::uint32_t winner)>& distance);

}  // namespace catoptric::depth_reflection_map
