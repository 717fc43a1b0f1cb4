// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

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

TEST(Progress, TimeLeftGoesByWhatWasDoneSinceAndNotBefore) {
  setProgressStyle(ProgressStyle::Bar);
  std::FILE* stream = std::tmpfile();
  {
    Progress progress("baking", 100, stream);
    progress.advance(90);  // of an earlier run
    progress.expectEvenSteps();
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    progress.advance();
    progress.describe("");
  }
  setProgressStyle(ProgressStyle::Automatic);
  std::rewind(stream);
  std::string text(4096, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stream));
  std::fclose(stream);
  const std::size_t at = text.find("91/100 ");
  ASSERT_NE(at, std::string::npos) << text;
  const int seconds = std::atoi(text.c_str() + at + 7);  // nine more of 1.1 s, or longer on a busy machine
  EXPECT_GE(seconds, 9) << text;
  EXPECT_NE(text.find(" s left", at), std::string::npos) << text;
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
