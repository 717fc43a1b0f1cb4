// SPDX-License-Identifier: Apache-2.0
#include "data_address.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace catoptric::app {

std::string makeDataAddress(std::string_view mediaType, std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(mediaType.size() + bytes.size() / 3 * 4 + 32);
  text.append("data:").append(mediaType).append(";base64,");
  for (std::size_t i = 0; i < bytes.size(); i += 3) {  // three bytes are four digits of six bits
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < count ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

}  // namespace catoptric::app
