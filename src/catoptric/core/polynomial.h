// SPDX-License-Identifier: Apache-2.0
// Real roots of polynomials of low degree, all of them, without a starting value.
#pragma once

#include <array>
#include <span>

namespace catoptric::core {

struct RealRoots {
  std::array<double, 4> values{};  ///< ascending
  int count = 0;

  [[nodiscard]] const double* begin() const { return values.data(); }
  [[nodiscard]] const double* end() const { return values.data() + count; }
};

/// Where sum of coefficients[i] x^i changes its sign; degree at most 4. Roots are bracketed between the
/// extrema, which are the roots of the derivative, and found by Newton's method that never leaves its
/// bracket. A root where the polynomial only touches zero may be left out. None for a polynomial that is
/// zero everywhere.
[[nodiscard]] RealRoots findRealRoots(std::span<const double> coefficients);

}  // namespace catoptric::core
