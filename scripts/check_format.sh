#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_format.sh [--fix]: every C++ file is as clang-format 14 and .clang-format leave it; --fix makes it so.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -d '' files < <(find src app tests bench examples -name '*.cpp' -print0 -o -name '*.h' -print0 | sort -z)
if [ "${1:-}" = --fix ]; then
  clang-format -i "${files[@]}"
else
  clang-format --dry-run -Werror "${files[@]}"
fi
echo "format: ${#files[@]} files"
