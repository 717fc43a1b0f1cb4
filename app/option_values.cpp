// SPDX-License-Identifier: Apache-2.0
#include "option_values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "catoptric/core/image_io.h"

namespace catoptric::app {
namespace {

/// All of the text as a number, independent of the locale.
template <class Number>
std::optional<Number> readAll(std::string_view text) {
  Number value{};
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(std::string_view option, const std::string& text, const std::string& expected) {
  throw UsageError(fmt::format("{}: '{}' is not {}", option, text, expected));
}

}  // namespace

int parseInteger(std::string_view option, const std::string& text, int least, int most) {
  const auto value = readAll<int>(text);
  if (!value || *value < least || *value > most)
    refuse(option, text, fmt::format("a whole number from {} to {}", least, most));
  return *value;
}

double parseNumber(std::string_view option, const std::string& text, double least, double most) {
  const auto value = readAll<double>(text);
  if (!value || !(*value >= least && *value <= most))
    refuse(option, text, fmt::format("a number from {:g} to {:g}", least, most));
  return *value;
}

double parseShare(std::string_view option, const std::string& text) {
  const bool isPercent = text.ends_with('%');
  const auto value = readAll<double>(std::string_view(text).substr(0, text.size() - (isPercent ? 1 : 0)));
  const double share = value.value_or(-1) / (isPercent ? 100 : 1);
  if (!(share >= 0 && share <= 1)) refuse(option, text, "a share, as in 0.9 or 90%");
  return share;
}

dvec3 parseVector(std::string_view option, const std::string& text) {
  constexpr double kLargest = 1e15;  // as for coordinates of a scene
  const auto parts = splitList(text);
  dvec3 vector(0);
  bool isGood = parts.size() == 3;
  for (std::size_t i = 0; i < 3 && isGood; ++i) {
    const auto value = readAll<double>(parts[i]);
    isGood = value && std::abs(*value) <= kLargest;
    if (isGood) vector[int(i)] = *value;
  }
  if (!isGood) refuse(option, text, "three numbers x,y,z, as in 0,1.5,-2");
  return vector;
}

ivec2 parseSize(std::string_view option, const std::string& text) {
  constexpr int kLargestEdge = 16384;  // what any OpenGL 3.3 in use can draw
  const auto cross = text.find_first_of("xX");
  if (cross == std::string::npos) refuse(option, text, "WIDTHxHEIGHT, as in 960x720");
  const auto width = readAll<int>(std::string_view(text).substr(0, cross));
  const auto height = readAll<int>(std::string_view(text).substr(cross + 1));
  if (!width || !height) refuse(option, text, "WIDTHxHEIGHT, as in 960x720");
  if (*width < 1 || *height < 1 || *width > kLargestEdge || *height > kLargestEdge ||
      std::size_t(*width) * std::size_t(*height) > core::kDefaultMaxPixels)
    refuse(
        option, text,
        fmt::format("from 1x1 to {0} pixels each way and {1} in all", kLargestEdge, core::kDefaultMaxPixels));
  return {*width, *height};
}

std::size_t parseByteCount(std::string_view option, const std::string& text) {
  std::string_view digits = text;
  double unit = 1;
  constexpr std::string_view kUnits = "KMGT";
  if (!digits.empty() && kUnits.find(char(digits.back() & ~0x20)) != std::string_view::npos) {
    unit = std::ldexp(1.0, 10 * int(kUnits.find(char(digits.back() & ~0x20)) + 1));
    digits.remove_suffix(1);
  }
  const auto value = readAll<double>(digits);
  const double count = value.value_or(0) * unit;
  if (!(count >= 1 && count <= std::ldexp(1.0, 50))) refuse(option, text, "a count, as in 512M or 4G");
  return std::size_t(count);
}

std::vector<std::string> splitList(std::string_view text) {
  std::vector<std::string> parts;
  while (true) {
    const auto comma = text.find(',');
    parts.emplace_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

Setter setText(std::string& target) {
  return [&target](const std::string& text) { target = text; };
}

Setter setInteger(std::string_view option, int& target, int least, int most) {
  return [option = std::string(option), &target, least, most](const std::string& text) {
    target = parseInteger(option, text, least, most);
  };
}

}  // namespace catoptric::app
