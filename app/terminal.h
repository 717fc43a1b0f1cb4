// SPDX-License-Identifier: Apache-2.0
// Data goes to stdout, everything else to stderr.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::app {

enum class Verbosity { Quiet, Normal, Verbose };

/// Also decides which diagnostics of the library are shown, and whether long work shows its progress.
void setVerbosity(Verbosity verbosity);

void say(const std::string& line);         ///< stderr, not when quiet
void sayDetail(const std::string& line);   ///< stderr, only when verbose
void sayError(const std::string& line);    ///< stderr, always: "catoptric: error: ..."
void sayWarning(const std::string& line);  ///< stderr, not when quiet: "catoptric: warning: ..."

/// stdout. Throws core::Error("file.write") when it cannot be written (full disk, ...).
void printData(std::string_view text);

/// True when the stream is a terminal and NO_COLOR is not set.
[[nodiscard]] bool usesColour(std::FILE* stream);

/// Names in a file may hold anything; a terminal must not obey it.
[[nodiscard]] std::string withoutControlCharacters(std::string text);

/// Columns side by side; the first row is the heading, the first `leftColumns` columns are flush
/// left, the others right.
[[nodiscard]] std::string formatTable(const std::vector<std::vector<std::string>>& rows, bool colour = false,
                                      std::size_t leftColumns = 1);

}  // namespace catoptric::app
