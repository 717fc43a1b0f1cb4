#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# demo.sh: writes the built-in scenes, compares every method on each with ray-traced truth, and prints the tables.
# What is left in out/demo:
#   index.html, report.json   every scene and method, one bounce: pictures, error maps, figures
#   hall-of-mirrors-4-bounces mirrors in mirrors, four levels deep
#   shapes                    mirrors of other shapes, concave and mixed ones among them, fewer methods and repetitions
#   no-mirrors                the drivers-view with every mirror switched off: raster against ray-traced
#   scenes/*.glb              the scenes themselves
# A comparison is run again only when the command or the scenes have changed (.made_by remembers by which); FORCE=1
# runs it always. DEMO_ARGS are handed to every `catoptric compare`, for instance DEMO_ARGS="--size 480x360 --repeat 1".
set -euo pipefail
cd "$(dirname "$0")/.."
catoptric=build/release/catoptric
out=out/demo
mkdir -p "$out"

rm -rf "$out/scenes.new"
"$catoptric" scenes -o "$out/scenes.new" --quiet
rm -rf "$out/scenes"
mv "$out/scenes.new" "$out/scenes"

made_by=$({ cat "$catoptric" "$out"/scenes/*.glb "$0"; echo "${DEMO_ARGS:-}"; } | sha256sum)
if [ "${FORCE:-}" != 1 ] && [ "$(cat "$out/.made_by" 2>/dev/null)" = "$made_by" ]; then
  echo "The command and the scenes are those of the last comparison, so its figures stand; FORCE=1 makes it again."
else
  rm -f "$out/.made_by"
  read -ra arguments <<<"${DEMO_ARGS:-}"
  compare() { "$catoptric" compare "$@" "${arguments[@]}" --json - >/dev/null; }
  start=$(date +%s)
  shapes=()
  for name in concave-bowl mask mixed tv cone vase wavy-wall; do shapes+=("$out/scenes/$name.glb"); done
  others=()
  for name in four-spheres cylinder fender polyhedra-and-sphere checker-box hall-of-mirrors drivers-view; do
    others+=("$out/scenes/$name.glb")
  done
  compare "${others[@]}" -o "$out"
  compare "${shapes[@]}" -o "$out/shapes" --repeat 1 --methods environment,virtual-explosion,virtual-refined
  compare "$out/scenes/hall-of-mirrors.glb" -o "$out/hall-of-mirrors-4-bounces" --bounces 4 \
    --methods none,environment,virtual-refined
  compare "$out/scenes/drivers-view.glb" -o "$out/no-mirrors" --no-reflectors --methods none
  echo "Compared in $(($(date +%s) - start)) s."
  echo "$made_by" >"$out/.made_by"
fi

for report in "$out/report.json" "$out"/*/report.json; do
  echo
  python3 scripts/readme_table.py "$report"
done
cat <<TEXT

Displacement is how far, in pixels, a reflection is from where the ray-traced truth shows the same point.
Pictures side by side, error maps, tables:  $PWD/$out/index.html
The figures as JSON:                        $PWD/$out/report.json
The scenes, for any glTF viewer:            $PWD/$out/scenes/
TEXT
