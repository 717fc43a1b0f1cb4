// SPDX-License-Identifier: Apache-2.0
// "Did you mean ...?"
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace catoptric::app {

/// The word that is nearest to what was typed, if it is near enough to be a slip (edit distance, swaps count
/// one).
[[nodiscard]] std::optional<std::string> findSimilar(std::string_view typed,
                                                     std::span<const std::string> words);

/// "did you mean 'x'?", or `otherwise`.
[[nodiscard]] std::string makeSuggestion(std::string_view typed, std::span<const std::string> words,
                                         std::string_view otherwise = {});

}  // namespace catoptric::app
