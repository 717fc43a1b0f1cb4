// SPDX-License-Identifier: Apache-2.0
// Data-parallel loops over contiguous ranges; one oneTBB arena for the whole program.
#pragma once

#include <cstddef>
#include <functional>

namespace catoptric::core {

/// Number of threads that parallelFor uses. 0 given to setThreadCount means all hardware threads.
[[nodiscard]] int threadCount();
void setThreadCount(int count);

/// Calls body(begin, end) on disjoint ranges that cover [0, count), each at most about `grain` long, on all
/// threads of the arena; returns when all are done. An exception thrown by body is rethrown here.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body);

/// Runs `beside` on other threads of the arena while this one runs `own`, which no other thread may run
/// (calls of GL); then this one helps. Returns when both are done. Whatever one of them throws is rethrown
/// here.
void runBeside(const std::function<void()>& beside, const std::function<void()>& own);

}  // namespace catoptric::core
