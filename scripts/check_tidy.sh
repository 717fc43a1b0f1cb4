#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_tidy.sh [FILE...]: clang-tidy with .clang-tidy over the given .cpp files, or over all, the product's before
# the tests' and of each the ones changed last first, until TIDY_SECONDS (default 420) are over. Says how many files it got to; any warning fails.
# A file that was clean and whose text, headers and rules are the same since is not looked at again.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/release
[ -f $build/compile_commands.json ] || scripts/build.sh release catoptric_glad >/dev/null
# Generated sources must be there before anything that includes them is parsed.
cmake --build $build --target catoptric_glad >/dev/null
seconds=${TIDY_SECONDS:-420}
clean=$build/tidy
mkdir -p $clean

if [ $# -gt 0 ]; then
  files=("$@")
else
  mapfile -t by_age < <({ git diff --name-only HEAD; git log -n 200 --format= --name-only; } 2>/dev/null |
    awk '!seen[$0]++' | grep '\.cpp$' || true)
  mapfile -t all < <(find src app tests bench examples -name '*.cpp' | sort)
  mapfile -t files < <(printf '%s\n' "${by_age[@]}" "${all[@]}" | awk '!seen[$0]++' |
    awk '/^(src|app)\// { print; next } { rest = rest $0 "\n" } END { printf "%s", rest }')
  known=$(sed -n 's|^ *"file": "'"$PWD"'/\(.*\)".*|\1|p' $build/compile_commands.json)
  mapfile -t files < <(for file in "${files[@]}"; do
    [ -f "$file" ] && grep -qxF "$file" <<<"$known" && echo "$file"
  done)
fi

export build clean
rules=$({ cat .clang-tidy; find src app tests shaders \( -name "*.h" -o -name "*.glsl" \) -print0 | sort -z | xargs -0 cat; } | sha256sum)
export rules
deadline=$(($(date +%s) + seconds))
export deadline
check_one() { # FILE -> a line "ok", "kept" or "late" on descriptor 3; warnings on standard output
  local stamp left
  stamp=$clean/$({ echo "$rules"; cat "$1"; } | sha256sum | cut -c1-32)
  if [ -f "$stamp" ]; then
    echo kept >&3
    return
  fi
  left=$((deadline - $(date +%s)))
  if [ $left -le 5 ]; then
    echo late >&3
    return
  fi
  local status=0
  timeout $((left + 60)) clang-tidy --quiet --warnings-as-errors='*' -p $build "$1" 2>/dev/null || status=$?
  if [ $status = 0 ]; then
    touch "$stamp"
    echo ok >&3
  else
    echo "$1: clang-tidy exit $status"
    echo failed >&3
  fi
}
export -f check_one
verdicts=$(mktemp)
trap 'rm -f "$verdicts"' EXIT
printf '%s\0' "${files[@]}" | xargs -0 -P "${JOBS:-$(nproc)}" -I{} bash -c 'check_one {}' 3>>"$verdicts"
count() { grep -cx "$1" "$verdicts" || true; }
echo "tidy: $(count ok) files clean, $(count kept) clean before and unchanged, $(count failed) failed," \
  "$(count late) not reached in $seconds s"
[ "$(count failed)" = 0 ] && [ "$(wc -l <"$verdicts")" -gt 0 ]
