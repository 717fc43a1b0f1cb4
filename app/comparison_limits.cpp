// SPDX-License-Identifier: Apache-2.0
#include "comparison_limits.h"

#include <fmt/format.h>

#include <algorithm>

#include "option_values.h"

namespace catoptric::app {
namespace {

/// A line if the limits on displacement do not hold for one set of pixels.
void judgePixels(const Limits& limits, const metrics::DisplacementStatistics& statistics,
                 const std::string& what, std::vector<std::string>& exceeded) {
  if (limits.maxMedianPx && statistics.medianPx > *limits.maxMedianPx)
    exceeded.push_back(
        fmt::format("{}: median {:.3f} px, limit {:g} px", what, statistics.medianPx, *limits.maxMedianPx));
  if (limits.minWithin1Px && statistics.shareWithin1Px < *limits.minWithin1Px)
    exceeded.push_back(fmt::format("{}: {:.2f} % within 1 px, limit {:g} %", what,
                                   100 * statistics.shareWithin1Px, 100 * *limits.minWithin1Px));
  if (limits.maxLost && statistics.shareLost > *limits.maxLost)
    exceeded.push_back(fmt::format("{}: {:.2f} % lost, limit {:g} %", what, 100 * statistics.shareLost,
                                   100 * *limits.maxLost));
}

void judgeRow(const Limits& limits, const ComparisonRow& row, const std::string& what,
              std::vector<std::string>& exceeded) {
  if (limits.maxMedianPx || limits.minWithin1Px || limits.maxLost) {
    if (row.displacement.mirrorPixels.pixels == 0) exceeded.push_back(what + ": no mirror pixels to judge");
    judgePixels(limits, row.displacement.mirrorPixels, what + ", mirror pixels", exceeded);
    if (row.displacement.objectPixels.pixels > 0)
      judgePixels(limits, row.displacement.objectPixels, what + ", object pixels", exceeded);
  }
  if (!limits.minPrimary) return;
  if (row.primary.pixels == 0) exceeded.push_back(what + ": no pixels outside of mirrors to judge");
  if (row.primary.shareWithin4 < *limits.minPrimary)
    exceeded.push_back(fmt::format("{}: {:.3f} % of the direct pixels within 4/255, limit {:g} %", what,
                                   100 * row.primary.shareWithin4, 100 * *limits.minPrimary));
}

}  // namespace

void declareLimits(Arguments& arguments, Limits& limits) {
  arguments.group("Limits (exit code 3 when one is exceeded)");
  arguments.option("--max-median", "PX", "Largest median displacement", [&](const std::string& text) {
    limits.maxMedianPx = parseNumber("--max-median", text, 0, metrics::kLostPx);
  });
  arguments.option(
      "--min-within-1px", "SHARE", "Least share of pixels displaced by at most 1 px, as in 90%",
      [&](const std::string& text) { limits.minWithin1Px = parseShare("--min-within-1px", text); });
  arguments.option("--max-lost", "SHARE", "Largest share of lost pixels",
                   [&](const std::string& text) { limits.maxLost = parseShare("--max-lost", text); });
  arguments.option("--min-direct", "SHARE",
                   "Least share of pixels outside of mirrors within 4/255 of the truth",
                   [&](const std::string& text) { limits.minPrimary = parseShare("--min-direct", text); });
  arguments.option("--limit-method", "NAME",
                   "The method that is held to them; default: the last of --methods", setText(limits.method));
}

void checkLimits(const Limits& limits, const std::vector<MethodVariant>& variants) {
  const bool isThere = std::any_of(variants.begin(), variants.end(), [&](const MethodVariant& variant) {
    return variant.name == limits.method;
  });
  if (!limits.method.empty() && !isThere)
    throw UsageError("--limit-method: '" + limits.method + "' is not among the methods that are compared");
}

std::vector<std::string> findExceeded(const Limits& limits, const std::vector<Comparison>& comparisons) {
  std::vector<std::string> exceeded;
  for (const Comparison& comparison : comparisons) {
    const std::size_t last = comparison.rows.size() - 2;  // the truth comes after it
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
      const ComparisonRow& row = comparison.rows[i];
      const bool isJudged = limits.method.empty() ? i == last : row.variant.name == limits.method;
      if (isJudged)
        judgeRow(limits, row, comparison.sceneName + " (" + comparison.camera.name + "), " + row.variant.name,
                 exceeded);
    }
  }
  return exceeded;
}

}  // namespace catoptric::app
