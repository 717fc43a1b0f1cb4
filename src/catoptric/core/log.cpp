// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/log.h"

#include <cstdio>
#include <mutex>
#include <set>
#include <utility>

namespace catoptric::core {
namespace {

struct State {
  std::mutex mutex;
  std::function<void(LogLevel, const std::string&)> callback = [](LogLevel level, const std::string& line) {
    if (level == LogLevel::Warning) std::fprintf(stderr, "catoptric: warning: %s\n", line.c_str());
  };
  std::set<std::string> said;
};

State& state() {
  static State instance;
  return instance;
}

}  // namespace

void setLogCallback(std::function<void(LogLevel, const std::string&)> callback) {
  const std::lock_guard lock(state().mutex);
  state().callback = std::move(callback);
}

void logInfo(const std::string& line) {
  const std::lock_guard lock(state().mutex);
  if (state().callback) state().callback(LogLevel::Info, line);
}

void logWarningOnce(const std::string& line) {
  const std::lock_guard lock(state().mutex);
  if (state().said.insert(line).second && state().callback) state().callback(LogLevel::Warning, line);
}

}  // namespace catoptric::core
