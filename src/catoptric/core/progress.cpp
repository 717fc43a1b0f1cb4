// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace catoptric::core {
namespace {

constexpr std::size_t kBarCells = 24;
constexpr std::chrono::milliseconds kBarInterval{80};
constexpr std::chrono::seconds kLineInterval{2};

std::atomic<ProgressStyle>& chosenStyle() {
  static std::atomic<ProgressStyle> style{ProgressStyle::Automatic};
  return style;
}

ProgressStyle styleFor(std::FILE* stream) {
  const ProgressStyle style = chosenStyle();
  if (style != ProgressStyle::Automatic) return style;
  const char* terminal = std::getenv("TERM");
  const bool movesCursor = terminal != nullptr && std::strcmp(terminal, "dumb") != 0;
  return movesCursor && isatty(fileno(stream)) != 0 ? ProgressStyle::Bar : ProgressStyle::Lines;
}

}  // namespace

void setProgressStyle(ProgressStyle style) {
  chosenStyle() = style;
}

Progress::Progress(std::string task, std::size_t steps, std::FILE* stream)
    : task_(std::move(task)), steps_(steps), stream_(stream), style_(styleFor(stream)) {}

Progress::~Progress() {
  if (style_ == ProgressStyle::Bar && lastShown_ != std::chrono::steady_clock::time_point{})
    fmt::print(stream_, "\r\033[K");
  std::fflush(stream_);
}

void Progress::describe(const std::string& what) {
  const std::lock_guard lock(mutex_);
  if (what == what_) return;
  what_ = what;
  show(true);
}

void Progress::advance(std::size_t count) {
  const std::lock_guard lock(mutex_);
  done_ = std::min(done_ + count, steps_);
  show(false);
}

std::string Progress::makeBar() const {
  const std::size_t full = steps_ == 0 ? kBarCells : done_ * kBarCells / steps_;
  return std::string(full, '#') + std::string(kBarCells - full, '.');
}

void Progress::show(bool lineIsDue) {
  if (style_ == ProgressStyle::Silent) return;
  const auto now = std::chrono::steady_clock::now();
  if (style_ == ProgressStyle::Bar) {
    if (now - lastShown_ < kBarInterval && done_ != steps_ && !lineIsDue) return;
    fmt::print(stream_, "\r\033[K{} [{}] {}/{} {}", task_, makeBar(), done_, steps_, what_);
  } else {
    // A line for each new thing that is done; for mere steps one every two seconds.
    if (!lineIsDue && now - lastShown_ < kLineInterval) return;
    fmt::print(stream_, "{}: {}/{} {}\n", task_, done_, steps_, what_);
  }
  std::fflush(stream_);
  lastShown_ = now;
}

}  // namespace catoptric::core
