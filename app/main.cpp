// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

int main(int argc, char** argv) {
  return catoptric::app::runCommandLine({argv + (argc > 0 ? 1 : 0), argv + argc});
}
