#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh PRESET [TARGET...]: configures build/PRESET when it has not been, and builds the targets (all by default).
# JOBS=N limits the parallel jobs.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:?usage: build.sh PRESET [TARGET...]}
shift
build=build/$preset
# Objects do not depend on where the tree lies, so that a second clone (CI makes one) finds what the first one compiled.
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD} CCACHE_NOHASHDIR=1
if [ ! -f "$build/build.ninja" ]; then
  mkdir -p "$build"
  cmake --preset "$preset" >"$build/configure.log" 2>&1 || {
    cat "$build/configure.log" >&2
    exit 1
  }
fi
targets=()
[ $# = 0 ] || targets=(--target "$@")
exec cmake --build "$build" ${JOBS:+-j "$JOBS"} "${targets[@]}"
