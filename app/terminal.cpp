// SPDX-License-Identifier: Apache-2.0
#include "terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "catoptric/core/error.h"
#include "catoptric/core/log.h"
#include "catoptric/core/progress.h"

namespace catoptric::app {
namespace {

Verbosity currentVerbosity = Verbosity::Normal;

/// Number of characters, not bytes, of UTF-8.
std::size_t widthOf(std::string_view text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

void sayLabelled(const char* label, const char* colour, const std::string& line) {
  const std::string text = withoutControlCharacters(line);
  if (usesColour(stderr))
    fmt::print(stderr, "catoptric: \033[{}m{}:\033[0m {}\n", colour, label, text);
  else
    fmt::print(stderr, "catoptric: {}: {}\n", label, text);
}

}  // namespace

std::string withoutControlCharacters(std::string text) {
  for (char& c : text)
    if ((c >= 0 && c < 0x20) || c == 0x7f) c = ' ';
  return text;
}

void setVerbosity(Verbosity verbosity) {
  currentVerbosity = verbosity;
  core::setProgressStyle(verbosity == Verbosity::Quiet ? core::ProgressStyle::Silent
                                                       : core::ProgressStyle::Automatic);
  core::setLogCallback([](core::LogLevel level, const std::string& line) {
    level == core::LogLevel::Warning ? sayWarning(line) : sayDetail(line);
  });
}

void say(const std::string& line) {
  if (currentVerbosity != Verbosity::Quiet) fmt::print(stderr, "{}\n", withoutControlCharacters(line));
}

void sayDetail(const std::string& line) {
  if (currentVerbosity == Verbosity::Verbose) fmt::print(stderr, "{}\n", withoutControlCharacters(line));
}

void sayError(const std::string& line) {
  sayLabelled("error", "1;31", line);
}

void sayWarning(const std::string& line) {
  if (currentVerbosity != Verbosity::Quiet) sayLabelled("warning", "33", line);
}

void printData(std::string_view text) {
  const bool written =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written)
    throw core::Error("file.write", "cannot write to standard output: " +
                                        std::error_code(errno, std::generic_category()).message());
}

bool usesColour(std::FILE* stream) {
  const char* noColour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return (noColour == nullptr || *noColour == '\0') && terminal != nullptr &&
         std::strcmp(terminal, "dumb") != 0 && isatty(fileno(stream)) != 0;
}

std::string formatTable(const std::vector<std::vector<std::string>>& rows, bool colour,
                        std::size_t leftColumns) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], widthOf(row[i]));
  }
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < rows[r].size(); ++i) {
      const std::string cell = withoutControlCharacters(rows[r][i]);
      const std::string padding(widths[i] - widthOf(cell), ' ');
      line += (i == 0 ? "" : "  ") + (i < leftColumns ? cell + padding : padding + cell);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += (r == 0 && colour ? "\033[1m" + line + "\033[0m" : line) + "\n";
  }
  return text;
}

}  // namespace catoptric::app
