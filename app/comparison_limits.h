// SPDX-License-Identifier: Apache-2.0
// Limits that a comparison must keep: exit code 3 otherwise.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arguments.h"
#include "comparison.h"

namespace catoptric::app {

struct Limits {
  std::optional<double> maxMedianPx, minWithin1Px, maxLost, minPrimary;
  std::string method;  ///< the variant that is judged; empty: the last one compared
};

void declareLimits(Arguments& arguments, Limits& limits);

/// Throws UsageError when the judged method is not among those that are compared.
void checkLimits(const Limits& limits, const std::vector<MethodVariant>& variants);

/// One line for each limit that is exceeded. Limits on displacement hold for all mirror pixels and for object
/// pixels; where there is nothing to judge, the limit is exceeded.
[[nodiscard]] std::vector<std::string> findExceeded(const Limits& limits,
                                                    const std::vector<Comparison>& comparisons);

}  // namespace catoptric::app
