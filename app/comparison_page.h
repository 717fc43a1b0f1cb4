// SPDX-License-Identifier: Apache-2.0
// The page that compare leaves: a slider between any two methods, pictures, error maps, charts, tables. One
// file that works offline and can be sent to somebody: pictures, style, script and chart library are in it.
#pragma once

#include <string>
#include <vector>

#include "comparison.h"

namespace catoptric::app {

/// `document` is report.json (its "environment" goes to the foot), `command` the line that made it.
[[nodiscard]] std::string makeComparisonPage(const std::vector<Comparison>& comparisons, const Json& document,
                                             const std::string& command);

}  // namespace catoptric::app
