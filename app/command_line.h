// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace catoptric::app {

enum ExitCode { kDone = 0, kFailed = 1, kWrongUsage = 2, kLimitExceeded = 3 };

/// The whole program; `line` is without the program's name. Never throws.
[[nodiscard]] int runCommandLine(const std::vector<std::string>& line);

}  // namespace catoptric::app
