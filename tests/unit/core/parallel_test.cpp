// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace catoptric::core {
namespace {

TEST(ParallelFor, VisitsEachIndexOnce) {
  for (const std::size_t count : {0u, 1u, 7u, 1000u, 100003u})
    for (const std::size_t grain : {0u, 1u, 64u, 1000000u}) {
      if (count > 1000 && grain < 2) continue;  // a task for each index: slow and nothing new
      std::vector<std::atomic<int>> visits(count);
      parallelFor(count, grain, [&](std::size_t begin, std::size_t end) {
        ASSERT_LT(begin, end);
        ASSERT_LE(end, count);
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
      });
      for (const auto& visit : visits) ASSERT_EQ(visit.load(), 1);
    }
}

TEST(ParallelFor, RethrowsAndWorksAgainAfterwards) {
  const auto failing = [](std::size_t begin, std::size_t end) {
    if (begin <= 500 && 500 < end) throw std::runtime_error("in the body");
  };
  EXPECT_THROW(parallelFor(1000, 10, failing), std::runtime_error);
  std::atomic<int> sum{0};
  parallelFor(10, 1, [&](std::size_t begin, std::size_t end) { sum += int(end - begin); });
  EXPECT_EQ(sum, 10);
}

TEST(ParallelFor, MayBeNested) {
  std::atomic<int> sum{0};
  parallelFor(8, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      parallelFor(100, 10, [&](std::size_t b, std::size_t e) { sum += int(e - b); });
  });
  EXPECT_EQ(sum, 800);
}

TEST(RunBeside, RunsBothAndItsOwnOnThisThread) {
  for (const int threads : {0, 1}) {
    setThreadCount(threads);
    std::atomic<int> beside{0};
    std::thread::id own;
    runBeside([&] { parallelFor(100, 1, [&](std::size_t a, std::size_t b) { beside += int(b - a); }); },
              [&] { own = std::this_thread::get_id(); });
    EXPECT_EQ(beside, 100);
    EXPECT_EQ(own, std::this_thread::get_id());
  }
  setThreadCount(0);
}

TEST(RunBeside, RethrowsFromEither) {
  const auto nothing = [] {};
  const auto fail = [] { throw std::runtime_error("no"); };
  EXPECT_THROW(runBeside(fail, nothing), std::runtime_error);
  EXPECT_THROW(runBeside(nothing, fail), std::runtime_error);
  EXPECT_THROW(runBeside(fail, fail), std::runtime_error);
  int done = 0;
  runBeside(nothing, [&] { ++done; });
  EXPECT_EQ(done, 1);
}

TEST(ThreadCount, CanBeSetAndReset) {
  const int all = threadCount();
  EXPECT_GE(all, 1);
  setThreadCount(1);
  EXPECT_EQ(threadCount(), 1);
  std::atomic<int> sum{0};
  parallelFor(100, 1, [&](std::size_t begin, std::size_t end) { sum += int(end - begin); });
  EXPECT_EQ(sum, 100);
  setThreadCount(0);
  EXPECT_EQ(threadCount(), all);
}

}  // namespace
}  // namespace catoptric::core
