// SPDX-License-Identifier: Apache-2.0
// Text of the command line to values. Every function throws UsageError that names the option, the text and
// what was expected.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.h"
#include "catoptric/core/math.h"

namespace catoptric::app {

[[nodiscard]] int parseInteger(std::string_view option, const std::string& text, int least, int most);
[[nodiscard]] double parseNumber(std::string_view option, const std::string& text, double least, double most);
/// "0.9" or "90%".
[[nodiscard]] double parseShare(std::string_view option, const std::string& text);
[[nodiscard]] dvec3 parseVector(std::string_view option, const std::string& text);           ///< "x,y,z"
[[nodiscard]] ivec2 parseSize(std::string_view option, const std::string& text);             ///< "960x720"
[[nodiscard]] std::size_t parseByteCount(std::string_view option, const std::string& text);  ///< "512M", "4G"
[[nodiscard]] std::vector<std::string> splitList(std::string_view text);                     ///< at commas

/// Setters for the usual cases; `option` is the name in messages.
[[nodiscard]] Setter setText(std::string& target);
[[nodiscard]] Setter setInteger(std::string_view option, int& target, int least, int most);

}  // namespace catoptric::app
