// SPDX-License-Identifier: Apache-2.0
#include "frame_sequence.h"

#include <fmt/format.h>

#include "arguments.h"

namespace catoptric::app {

std::string numberFile(const std::string& option, const std::string& pattern, int number) {
  const std::size_t last = pattern.rfind('#');
  if (last == std::string::npos)
    throw UsageError(option + ": '" + pattern + "' has no place for the number of the frame",
                     "write # for each digit, as in out_####.png");
  const std::size_t before = pattern.find_last_not_of('#', last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  return pattern.substr(0, first) + fmt::format("{:0{}}", number, last + 1 - first) +
         pattern.substr(last + 1);
}

}  // namespace catoptric::app
