#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# demo.sh: writes the built-in scenes, compares every method on each with ray-traced truth, and prints the table.
# What is left: out/demo/index.html, report.json, the pictures and error maps, and scenes/*.glb.
# The comparison is run again only when the command or the scenes have changed (out/demo/.made_by remembers by which);
# FORCE=1 runs it always. COMPARE_ARGS are handed to `catoptric compare`.
set -euo pipefail
cd "$(dirname "$0")/.."
catoptric=build/release/catoptric
out=out/demo
mkdir -p "$out"

rm -rf "$out/scenes.new"
"$catoptric" scenes -o "$out/scenes.new" --quiet
rm -rf "$out/scenes"
mv "$out/scenes.new" "$out/scenes"

made_by=$({ cat "$catoptric" "$out"/scenes/*.glb; echo "${COMPARE_ARGS:-}"; } | sha256sum)
if [ "${FORCE:-}" != 1 ] && [ -f "$out/report.json" ] && [ "$(cat "$out/.made_by" 2>/dev/null)" = "$made_by" ]; then
  echo "Nothing has changed since the last comparison; FORCE=1 makes it again."
else
  rm -f "$out/.made_by"
  # shellcheck disable=SC2086  # the arguments are meant to be split
  "$catoptric" compare "$out"/scenes/*.glb -o "$out" ${COMPARE_ARGS:-}
  echo "$made_by" >"$out/.made_by"
fi

echo
python3 scripts/report_table.py "$out/report.json"
echo
echo "Pictures side by side, error maps and this table: $PWD/$out/index.html"
echo "The figures as JSON:                              $PWD/$out/report.json"
echo "The scenes, to open in any glTF viewer:           $PWD/$out/scenes/"
