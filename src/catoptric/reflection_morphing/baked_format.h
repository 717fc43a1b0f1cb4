// SPDX-License-Identifier: Apache-2.0
// The parts of a baked file that reader and writer share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/reflection_morphing/baked_file.h"

namespace catoptric::reflection_morphing {

using Magic = std::array<char, 8>;
inline constexpr Magic kMagic{'C', 'A', 'T', 'O', 'B', 'A', 'K', 'E'};
inline constexpr Magic kEndMagic{'C', 'A', 'T', 'O', 'D', 'O', 'N', 'E'};
inline constexpr std::uint32_t kBakedVersion = 2;
inline constexpr std::size_t kRecordHeader = 16;  ///< size and checksum

[[nodiscard]] std::vector<std::byte> packHeader(const BakedHeader& header);
/// Throws as BakedFile does.
[[nodiscard]] BakedHeader unpackHeader(std::span<const std::byte> bytes);
/// Of any header of this version.
[[nodiscard]] std::size_t headerSize();

}  // namespace catoptric::reflection_morphing
