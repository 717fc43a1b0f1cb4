// SPDX-License-Identifier: Apache-2.0
// Files are read with a size cap and written whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace catoptric::core {

/// Reads a whole regular file. Throws Error("file.*") if it cannot be read, is not a regular file or is
/// larger than maxBytes.
[[nodiscard]] std::vector<std::byte> readFile(const std::filesystem::path& path,
                                              std::size_t maxBytes = std::size_t(4) << 30);

/// Writes to a temporary file in the same folder, then renames it over `path`; on failure (disk full, no
/// permission) nothing is left and the old file stays. Throws Error("file.write").
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void writeFileAtomically(const std::filesystem::path& path, std::string_view text);

}  // namespace catoptric::core
