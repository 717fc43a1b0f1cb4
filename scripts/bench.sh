#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# bench.sh [ARGUMENT...]: runs every Google Benchmark program of build/release (the *_bench files) with the arguments,
# for instance --benchmark_filter=virtual. The results go to out/bench/NAME.json too.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p out/bench
found=0
for program in build/release/*_bench; do
  [ -x "$program" ] || continue
  found=1
  "$program" --benchmark_out="out/bench/$(basename "$program").json" --benchmark_out_format=json "$@"
done
[ $found = 1 ] || { echo "bench: no benchmark was built" >&2; exit 1; }
