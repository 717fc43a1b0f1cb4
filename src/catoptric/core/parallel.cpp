// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <memory>

namespace catoptric::core {
namespace {

std::unique_ptr<tbb::task_arena>& arenaSlot() {
  static auto slot = std::make_unique<tbb::task_arena>();
  return slot;
}

}  // namespace

int threadCount() {
  return arenaSlot()->max_concurrency();
}

void setThreadCount(int count) {
  arenaSlot() = count > 0 ? std::make_unique<tbb::task_arena>(count) : std::make_unique<tbb::task_arena>();
}

void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  if (grain == 0) grain = 1;
  arenaSlot()->execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
  });
}

void runBeside(const std::function<void()>& beside, const std::function<void()>& own) {
  tbb::task_group group;
  arenaSlot()->execute([&] { group.run(beside); });
  const auto finish = [&] { arenaSlot()->execute([&] { group.wait(); }); };
  try {
    own();  // not within execute(), which may leave it to another thread
  } catch (...) {
    group.cancel();
    try {
      finish();
    } catch (...) {  // one of the two is enough
    }
    throw;
  }
  finish();
}

}  // namespace catoptric::core
