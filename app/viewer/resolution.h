// SPDX-License-Identifier: Apache-2.0
// How large frames are drawn while something moves, so that the next one comes soon enough.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace catoptric::viewer {

/// Starts coarse, so that the first picture is soon there. Steps down when a frame took too long, up when
/// there is room: at once to where a time in proportion to the number of pixels allows, which is on the safe
/// side since some of it is fixed. The gap between the two limits keeps it from going to and fro. Few steps,
/// since each one allocates its targets anew.
class MovingResolution {
 public:
  static constexpr double kTooSlowMs = 66;  ///< 15 frames a second
  static constexpr double kRoomMs = 28;     ///< the next step has about twice as many pixels
  static constexpr double kAimMs = 56;      ///< of a step up
  static constexpr std::array<double, 5> kScales{1.0, 0.7, 0.5, 0.35, 0.25};

  /// What a frame that was drawn at `scale` took.
  void learn(double scale, double frameMs) {
    if (scale != kScales[step_]) return;
    if (frameMs > kTooSlowMs) {
      // As many steps at once as the time asks for, were it proportional to the number of pixels.
      const double wanted = scale * std::max(0.5, std::min(1.0, kTooSlowMs / frameMs));
      while (step_ + 1 < kScales.size() && kScales[step_] > wanted) ++step_;
    } else if (frameMs < kRoomMs && step_ > 0) {
      do --step_;
      while (step_ > 0 && frameMs * square(kScales[step_ - 1] / scale) <= kAimMs);
    }
  }
  [[nodiscard]] double scale() const { return kScales[step_]; }

 private:
  static constexpr double square(double x) { return x * x; }

  std::size_t step_ = 3;
};

}  // namespace catoptric::viewer
