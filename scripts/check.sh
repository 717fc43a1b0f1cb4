#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check.sh: the checks that need no test run, one after the other; all are run even when one fails.
# Last line: "N passed, N failed".
set -uo pipefail
cd "$(dirname "$0")/.." || exit
passed=0 failed=0
run() {
  echo "== $*"
  if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)) && echo "FAILED: $*" >&2; fi
}
run scripts/check_format.sh
run scripts/check_sources.py
run scripts/validate_shaders.py
run scripts/check_tidy.sh
echo "$passed passed, $failed failed"
[ $failed = 0 ]
