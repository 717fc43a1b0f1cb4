// SPDX-License-Identifier: Apache-2.0
// Question: in which order can a reference image be warped so that nearer surfaces come last and no z-buffer
// is needed (McMillan 1997; Bastos & Stuerzlinger 1998, section 4.1)?
//
// Inputs: size of the reference, and the epipole: the image of the new centre of projection in the
// reference, homogeneous, (x, y) in zexels. Output: sheets, each a list of runs of zexels.
//   1. All points that one pixel of the new view can show lie on a line through the epipole. If the new
//      centre lies before the reference (w > 0), they get nearer towards the epipole, else away from it; at
//      infinity (w = 0) they get nearer along (x, y), which both rules say for a far epipole.
//   2. The epipole's row and column cut the image into at most four sheets. Rows and columns of a sheet that
//      are taken towards the epipole (or away from it) take every such line in its order.
//   3. Sheets are cut further along lines through the epipole, into pieces of about an eighth of the image.
//      Two sheets never share a line, so they can be warped at the same time.
// Departure: step 3; with the epipole outside there are only one or two sheets for many cores.
// Known failure: a splat reaches over the edge of its sheet by its radius; there the later sheet wins.
// Cost: proportional to the rows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::depth_reflection_map {

/// Zexels [begin, end) of row y.
struct ZexelRun {
  std::int32_t y = 0, begin = 0, end = 0;
};

struct Sheet {
  std::uint32_t firstRun = 0, runCount = 0;  ///< in the order in which they are to be warped
  bool leftToRight = true;                   ///< the order within a run
  std::uint64_t zexels = 0;
};

class EpipolarOrder {
 public:
  /// Keeps its memory from call to call.
  void compute(int width, int height, const dvec3& epipole);

  [[nodiscard]] std::span<const Sheet> sheets() const { return sheets_; }
  [[nodiscard]] std::span<const ZexelRun> runs(const Sheet& sheet) const {
    return std::span(runs_).subspan(sheet.firstRun, sheet.runCount);
  }

 private:
  struct Quadrant;
  void addWedge(const Quadrant& quadrant, double fromSlope, double toSlope);
  [[nodiscard]] static double findSlope(const Quadrant& quadrant, double share);

  std::vector<Sheet> sheets_;
  std::vector<ZexelRun> runs_;
};

}  // namespace catoptric::depth_reflection_map
