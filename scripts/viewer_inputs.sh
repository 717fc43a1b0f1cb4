#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# viewer_inputs.sh [COUNT]: COUNT random inputs (2000) to the viewer of build/sanitize under Xvfb: keys, clicks, drags,
# edits, undo, recording. Fails at a crash, a report of the address or undefined-behaviour sanitizer, a leak of ours, or a
# message of OpenGL's debug output.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh sanitize catoptric_app
export CATOPTRIC_VIEW_INPUTS=${1:-2000} CATOPTRIC=$PWD/build/sanitize/catoptric CATOPTRIC_GL_DEBUG=1
export ASAN_OPTIONS=detect_leaks=1:intercept_tls_get_addr=0:strict_string_checks=1:allocator_may_return_null=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export LSAN_OPTIONS=suppressions=$PWD/tests/sanitizer/lsan.supp:print_suppressions=0
exec python3 -B tests/cli/view_test.py WithDisplay.test_random_inputs
