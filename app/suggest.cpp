// SPDX-License-Identifier: Apache-2.0
#include "suggest.h"

#include <algorithm>
#include <vector>

namespace catoptric::app {
namespace {

/// Damerau-Levenshtein distance (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> findSimilar(std::string_view typed, std::span<const std::string> words) {
  constexpr std::size_t kLongestWord = 64;  // a path that was typed by mistake is no slip
  if (typed.empty() || typed.size() > kLongestWord) return std::nullopt;
  const std::string* best = nullptr;
  std::size_t bestDistance = 0;
  for (const std::string& word : words) {
    const std::size_t distance = word.starts_with(typed) && typed.size() >= 3 ? 1 : editDistance(typed, word);
    if (best == nullptr || distance < bestDistance) best = &word, bestDistance = distance;
  }
  const std::size_t allowed = std::max<std::size_t>(1, std::min<std::size_t>(3, typed.size() / 3));
  if (best == nullptr || bestDistance > allowed) return std::nullopt;
  return *best;
}

std::string makeSuggestion(std::string_view typed, std::span<const std::string> words,
                           std::string_view otherwise) {
  const auto similar = findSimilar(typed, words);
  return similar ? "did you mean '" + *similar + "'?" : std::string(otherwise);
}

}  // namespace catoptric::app
