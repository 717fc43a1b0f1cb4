// SPDX-License-Identifier: Apache-2.0
// Bytes as a "data:" address (RFC 2397), for pages that carry their pictures in themselves.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace catoptric::app {

/// "data:image/png;base64,iVBORw0..."
[[nodiscard]] std::string makeDataAddress(std::string_view mediaType, std::span<const std::byte> bytes);

}  // namespace catoptric::app
