#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# readme_pictures.sh: renders the pictures of README.md into docs/images with the command that a user has. For each scene:
# an environment map, our rasterizer, the ray-traced truth (JPEG), and the map of displacements between the last two (PNG).
set -euo pipefail
cd "$(dirname "$0")/.."
catoptric=build/release/catoptric
images=docs/images
work=out/readme_pictures
options=(--size 640x480)
mkdir -p "$images" "$work"
for scene in drivers-view four-spheres fender; do
  for method in environment virtual raytrace; do
    "$catoptric" render "$scene" -o "$images/$scene-$method.jpg" --method "$method" --samples 8 "${options[@]}" --quiet
  done
  "$catoptric" compare "$scene" -o "$work" --methods virtual-refined --repeat 1 "${options[@]}" --json "$work/$scene.json" \
    >/dev/null
  cp "$work/$(python3 -c 'import json, sys
print(json.load(open(sys.argv[1]))["results"][0]["files"]["displacement"])' "$work/$scene.json")" \
    "$images/$scene-displacement.png"
done
ls -l "$images"
too_large=$(find "$images" -size +300k)
[ -z "$too_large" ] || { echo "over 300 KiB: $too_large" >&2; exit 1; }
