// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/progress.h"

#include <gtest/gtest.h>

#include <string>

namespace catoptric::core {
namespace {

/// What a piece of work of two steps writes.
std::string reportInStyle(ProgressStyle style) {
  setProgressStyle(style);
  std::FILE* stream = std::tmpfile();
  {
    Progress progress("comparing", 2, stream);
    progress.describe("first");
    progress.advance();
    progress.describe("second");
    progress.advance();
  }
  setProgressStyle(ProgressStyle::Automatic);
  std::rewind(stream);
  std::string text(4096, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stream));
  std::fclose(stream);
  return text;
}

TEST(Progress, LinesAreWholeAndCarryNoControlCharacters) {
  EXPECT_EQ(reportInStyle(ProgressStyle::Lines), "comparing: 0/2 first\ncomparing: 1/2 second\n");
}

TEST(Progress, WhatIsNoTerminalGetsLines) {
  EXPECT_EQ(reportInStyle(ProgressStyle::Automatic), reportInStyle(ProgressStyle::Lines));
}

TEST(Progress, BarRunsFullAndIsErasedAtTheEnd) {
  const std::string text = reportInStyle(ProgressStyle::Bar);
  EXPECT_NE(text.find("[############............] 1/2 second"), std::string::npos) << text;
  EXPECT_NE(text.find("[########################] 2/2"), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(text.substr(text.size() - 4), "\r\033[K");
}

TEST(Progress, SilentSaysNothing) {
  EXPECT_EQ(reportInStyle(ProgressStyle::Silent), "");
}

TEST(Progress, NoStepsAtAll) {
  setProgressStyle(ProgressStyle::Silent);
  Progress progress("nothing", 0);
  progress.advance();
  setProgressStyle(ProgressStyle::Automatic);
}

}  // namespace
}  // namespace catoptric::core
