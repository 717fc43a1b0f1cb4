#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# sanitize.sh [CTEST ARGUMENT...]: builds library, command and tests in build/sanitize with the address and
# undefined-behaviour sanitizers and runs the suite there. Any report fails the test in which it happens; leaks of third
# parties are listed in tests/sanitizer/lsan.supp. Left out: tests labelled "slow", whole pictures on the CPU (Picture.*)
# and the documentation's examples (cli.docs: other tests run the same commands), all of which would take minutes, and
# "structure", which runs no code of ours.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh sanitize
export CTEST_OUTPUT_ON_FAILURE=1
# intercept_tls_get_addr=0: with it the leak checker of GCC 12 guesses where glibc keeps the thread storage of loaded
# libraries (Mesa), now and then guesses wrong, and crashes ("Tracer caught signal 11").
export ASAN_OPTIONS=detect_leaks=1:intercept_tls_get_addr=0:strict_string_checks=1:check_initialization_order=1:allocator_may_return_null=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export LSAN_OPTIONS=suppressions=$PWD/tests/sanitizer/lsan.supp:print_suppressions=0
exec ctest --test-dir build/sanitize --no-tests=error --timeout 600 -j "${JOBS:-$(nproc)}" -LE 'slow|structure' -E '^Picture|^cli.docs' "$@"
