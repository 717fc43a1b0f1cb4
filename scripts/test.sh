#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# test.sh [CTEST ARGUMENT...]: runs the whole test suite of build/release. Tests on the shared asset collection need
# CATOPTRIC_ASSETS and skip, saying so, without it.
set -euo pipefail
cd "$(dirname "$0")/.."
export CTEST_OUTPUT_ON_FAILURE=1
[ -n "${CATOPTRIC_ASSETS:-}" ] || echo "CATOPTRIC_ASSETS is not set: tests on the asset collection will skip."
exec ctest --test-dir build/release --no-tests=error --timeout 300 -j "${JOBS:-$(nproc)}" "$@"
