// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/polynomial.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace catoptric::core {
namespace {

constexpr int kMaxSteps = 128;

struct Value {
  double value, slope;
};

Value evaluate(std::span<const double> c, double x) {
  Value at{c.back(), 0};
  for (std::size_t i = c.size() - 1; i-- > 0;) {
    at.slope = at.slope * x + at.value;
    at.value = at.value * x + c[i];
  }
  return at;
}

/// The root in [low, high], where the values at the ends differ in sign.
double polishRoot(std::span<const double> c, double low, double high, bool isRising) {
  double x = 0.5 * (low + high);
  for (int step = 0; step < kMaxSteps; ++step) {
    const Value at = evaluate(c, x);
    if (at.value == 0) return x;
    ((at.value > 0) == isRising ? high : low) = x;
    double next = x - at.value / at.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == x || next == low || next == high) return next;
    if (std::abs(next - x) <= 1e-16 * std::abs(x)) return next;
    x = next;
  }
  return x;
}

}  // namespace

RealRoots findRealRoots(std::span<const double> coefficients) {
  assert(coefficients.size() <= 5);
  while (!coefficients.empty() && coefficients.back() == 0)
    coefficients = coefficients.first(coefficients.size() - 1);
  RealRoots roots;
  if (coefficients.size() < 2) return roots;
  const double leading = coefficients.back();
  if (coefficients.size() == 2) {
    roots.values[0] = -coefficients[0] / leading;
    roots.count = 1;
    return roots;
  }
  std::array<double, 4> derivative{};
  double bound = 0;  // Cauchy's, of the size of a root
  for (std::size_t i = 0; i + 1 < coefficients.size(); ++i) {
    derivative[i] = double(i + 1) * coefficients[i + 1];
    bound = std::max(bound, std::abs(coefficients[i] / leading));
  }
  bound = 1.0 + bound;
  const RealRoots extrema = findRealRoots(std::span(derivative).first(coefficients.size() - 1));
  double low = -bound, valueLow = evaluate(coefficients, low).value;
  for (int i = 0; i <= extrema.count; ++i) {
    const double high = i < extrema.count ? std::clamp(extrema.values[std::size_t(i)], low, bound) : bound;
    const double valueHigh = evaluate(coefficients, high).value;
    if ((valueLow < 0) != (valueHigh < 0) && roots.count < 4)
      roots.values[std::size_t(roots.count++)] = polishRoot(coefficients, low, high, valueHigh > valueLow);
    low = high;
    valueLow = valueHigh;
  }
  return roots;
}

}  // namespace catoptric::core
