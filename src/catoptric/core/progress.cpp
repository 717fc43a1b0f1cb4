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

void Progress::expectEvenSteps() {
  const std::lock_guard lock(mutex_);
  isEven_ = true;
  doneEarlier_ = done_;
  evenSince_ = std::chrono::steady_clock::now();
}

std::string Progress::describeTimeLeft(std::chrono::steady_clock::time_point now) const {
  constexpr double kLeastSeconds = 1;
  const double spent = std::chrono::duration<double>(now - evenSince_).count();
  if (!isEven_ || done_ <= doneEarlier_ || done_ == steps_ || spent < kLeastSeconds) return {};
  const double left = spent * double(steps_ - done_) / double(done_ - doneEarlier_);
  constexpr double kMinute = 60, kHour = 3600;
  if (left < 2 * kMinute) return fmt::format("{:.0f} s left", left);
  if (left < 2 * kHour) return fmt::format("{:.0f} min left", left / kMinute);
  return fmt::format("{:.1f} h left", left / kHour);
}

std::string Progress::makeBar() const {
  const std::size_t full = steps_ == 0 ? kBarCells : done_ * kBarCells / steps_;
  return std::string(full, '#') + std::string(kBarCells - full, '.');
}

void Progress::show(bool lineIsDue) {
  if (style_ == ProgressStyle::Silent) return;
  const auto now = std::chrono::steady_clock::now();
  const std::string left = describeTimeLeft(now);
  const std::string& said = left.empty() ? what_ : left;
  if (style_ == ProgressStyle::Bar) {
    if (now - lastShown_ < kBarInterval && done_ != steps_ && !lineIsDue) return;
    fmt::print(stream_, "\r\033[K{} [{}] {}/{} {}", task_, makeBar(), done_, steps_, said);
  } else {
    // A line for each new thing that is done; for mere steps one every two seconds.
    if (!lineIsDue && now - lastShown_ < kLineInterval) return;
    fmt::print(stream_, "{}: {}/{} {}\n", task_, done_, steps_, said);
  }
  std::fflush(stream_);
  lastShown_ = now;
}

}  // namespace catoptric::core
