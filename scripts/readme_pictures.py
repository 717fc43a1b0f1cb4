#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""readme_pictures.py COMMAND [--size WxH] [--samples N]: the strip of pictures in README.md, out of a report of `catoptric compare`.

One comparison, three scenes, eight samples a pixel, is left in out/readme. The pictures are those that its page carries in itself
(JPEG) and the displacement maps that lie beside it (PNG); they go to docs/images, and the lines of README.md between
`<!-- pictures -->` and `<!-- /pictures -->` are written anew. What the strip shows is what the report measured."""
import argparse
import os
import re
import shutil
import subprocess
import sys

import report_pictures

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SCENES = {"drivers-view": "wing mirrors", "four-spheres": "four spheres", "fender": "a fender"}
SHOWN = ("drivers-view", "four-spheres")  # in README.md; the fender is for other pages
METHODS = {"environment": "environment", "virtual": "virtual-refined", "raytrace": "raytrace"}  # file's name, row's name
LARGEST = 300 * 1024


def keep_pictures(report, images):
    """Writes the files; scene -> share of object pixels within 1 px by method."""
    embedded, within = report_pictures.read_pictures(report), {}
    rows = {(row["scene"], row["name"]): row for row in report_pictures.read_rows(report)}
    for scene in SCENES:
        for file, name in METHODS.items():
            row = rows[scene, name]
            within[scene, file] = row["displacement"]["object_pixels"]["share_le_1px"]
            with open(os.path.join(images, f"{scene}-{file}.jpg"), "wb") as picture:
                picture.write(embedded[row["files"]["picture"]])
        shutil.copyfile(os.path.join(report, rows[scene, METHODS["virtual"]]["files"]["displacement"]),
                        os.path.join(images, f"{scene}-displacement.png"))
    return within


def make_strip(within):
    lines = ["| environment map | Catoptric | ray-traced truth | displacement from the truth |", "| --- | --- | --- | --- |"]
    for scene in SHOWN:
        what = SCENES[scene]
        lines.append(f"| ![{what} by environment map](docs/images/{scene}-environment.jpg) "
                     f"| ![{what} by virtual objects](docs/images/{scene}-virtual.jpg) "
                     f"| ![{what}, ray-traced](docs/images/{scene}-raytrace.jpg) | ![error map](docs/images/{scene}-displacement.png) |")
        lines.append(f"| {100 * within[scene, 'environment']:.1f} % of the objects' pixels within 1 px "
                     f"| {100 * within[scene, 'virtual']:.1f} % | | blue 0 px, green 1 px, red lost |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--samples", default="8")
    arguments = parser.parse_args()
    report, images, readme = (os.path.join(ROOT, *path) for path in (("out", "readme"), ("docs", "images"), ("README.md",)))
    subprocess.run([arguments.command, "compare", *SCENES, "-o", report, "--methods", "environment,virtual-refined", "--repeat", "1",
                    "--size", arguments.size, "--samples", arguments.samples, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    strip = make_strip(keep_pictures(report, images))
    with open(readme, encoding="utf-8") as file:
        text, count = re.subn(r"(<!-- pictures -->\n).*(\n<!-- /pictures -->)", lambda m: m[1] + "\n" + strip + "\n" + m[2], file.read(),
                              flags=re.S)
    if count != 1:
        sys.exit("readme_pictures: README.md has no place marked for pictures")
    with open(readme, "w", encoding="utf-8") as file:
        file.write(text)
    too_large = [name for name in os.listdir(images) if os.path.getsize(os.path.join(images, name)) > LARGEST]
    if too_large:
        sys.exit(f"readme_pictures: over {LARGEST // 1024} KiB: {', '.join(sorted(too_large))}")


if __name__ == "__main__":
    main()
