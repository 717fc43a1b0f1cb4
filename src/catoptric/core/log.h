// SPDX-License-Identifier: Apache-2.0
// Diagnostics of the library go to one callback that the embedding program may replace.
#pragma once

#include <functional>
#include <string>

namespace catoptric::core {

enum class LogLevel { Info, Warning };

/// Replaces the receiver; the default writes "catoptric: warning: ..." lines to stderr and drops Info.
void setLogCallback(std::function<void(LogLevel, const std::string&)> callback);

void logInfo(const std::string& line);
/// Says each distinct line once per process.
void logWarningOnce(const std::string& line);

}  // namespace catoptric::core
