// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <tuple>

namespace catoptric::depth_reflection_map {

/// Which reference image of a scene.
struct ReferenceKey {
  std::uint32_t reflector = 0;
  bool isFromBehind = false;  ///< of a double-sided mirror
  int shell = 0;  ///< twice the step of the ladder of radii; odd: of eyes outside of the scene's box
  int index = 0;

  friend bool operator==(const ReferenceKey& a, const ReferenceKey& b) { return a.order() == b.order(); }
  friend bool operator<(const ReferenceKey& a, const ReferenceKey& b) { return a.order() < b.order(); }

 private:
  [[nodiscard]] std::tuple<std::uint32_t, bool, int, int> order() const {
    return {reflector, isFromBehind, shell, index};
  }
};

}  // namespace catoptric::depth_reflection_map
