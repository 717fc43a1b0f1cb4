// SPDX-License-Identifier: Apache-2.0
// How far long work has come: a bar on a terminal, plain lines otherwise, nothing when told so. On stderr.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>

namespace catoptric::core {

enum class ProgressStyle { Automatic, Bar, Lines, Silent };

/// Style of every Progress made from now on. Automatic: a bar if stderr is a terminal that can move its
/// cursor (TERM is set and is not "dumb"), lines otherwise.
void setProgressStyle(ProgressStyle style);

/// One piece of long work of `steps` equal steps. Any thread may report. The bar is erased at the end, so
/// what is printed afterwards starts on a clean line.
class Progress {
 public:
  Progress(std::string task, std::size_t steps, std::FILE* stream = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Says what is being done now; does not count.
  void describe(const std::string& what);
  /// One step (or `count` of them) is done.
  void advance(std::size_t count = 1);
  /// The steps that are left take about equally long: the time left is shown, as soon as there is something
  /// to judge it by. What is done by now was done earlier and tells nothing.
  void expectEvenSteps();

 private:
  void show(bool lineIsDue);
  [[nodiscard]] std::string makeBar() const;
  [[nodiscard]] std::string describeTimeLeft(std::chrono::steady_clock::time_point now) const;

  std::mutex mutex_;
  std::string task_, what_;
  std::size_t steps_, done_ = 0;
  std::FILE* stream_;
  ProgressStyle style_;
  std::chrono::steady_clock::time_point lastShown_{};
  bool isEven_ = false;
  std::size_t doneEarlier_ = 0;
  std::chrono::steady_clock::time_point evenSince_{};
};

}  // namespace catoptric::core
