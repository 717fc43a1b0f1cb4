// SPDX-License-Identifier: Apache-2.0
// Pictures of a sequence: which time each shows, which file it goes to.
#pragma once

#include <string>

namespace catoptric::app {

struct SequenceOptions {
  int frames = 0;  ///< --frames; 0 = one picture, no sequence
  double framesPerS = 25;
};

/// "out_####.png" and 7 -> "out_0007.png": the last run of '#' becomes the number, with at least as many
/// digits. Throws UsageError where a name has none.
[[nodiscard]] std::string numberFile(const std::string& option, const std::string& pattern, int number);

}  // namespace catoptric::app
