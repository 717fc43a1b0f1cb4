#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""layered_plot.py VIRTUAL_OBJECT_TEST [-o PLOT.svg]: how far off solver layered is, by the number of its maps and their resolution.

The test program measures (a sphere 700 px wide, mesh of 12,500 triangles, 4,000 points from 1.1 to 15 radii away): mean error
in px of the reflection point. Printed as it says it, and drawn: against layers, one line a resolution; against resolution, one
line for 2 layers (the maps of 1998), 4, 8 and 16."""
import argparse
import math
import re
import subprocess
import sys

TEST = "Layered.ErrorFallsWithTheNumberOfLayers"
COLORS = ("#1f6fb4", "#d1632a", "#3a8f4d", "#8a4fa8", "#b8860b", "#444")
LAYERS_DRAWN = (2, 4, 8, 16)
WIDTH, HEIGHT, TOP = 300, 220, 30


def measure(program):
    """The resolutions, and by layers the errors: of ideal maps, then of each resolution."""
    done = subprocess.run([program, f"--gtest_filter={TEST}"], check=True, capture_output=True, text=True).stdout
    heading = re.search(r"^layers +ideal((?: +\d+)+)$", done, re.M)
    rows = re.findall(r"^ *(\d+)((?: +\d+\.\d+)+)$", done, re.M)
    if heading is None or not rows:
        sys.exit(f"layered_plot: {program} has not printed the table of {TEST}")
    return ([int(word) for word in heading.group(1).split()],
            {int(layers): [float(word) for word in errors.split()] for layers, errors in rows})


def draw_panel(parts, left, title, lines):
    """Lines are (name, [(x, y)]), both axes logarithmic and the same y axis in all panels."""
    xs = sorted({x for _, points in lines for x, _ in points})

    def place(x, y):
        return (left + 46 + WIDTH * math.log(x / xs[0]) / math.log(xs[-1] / xs[0]),
                TOP + HEIGHT * math.log(30 / y) / math.log(30 / 0.03))

    parts.append(f'<text x="{left + 46}" y="18">{title}</text>'
                 f'<rect x="{left + 46}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#bbb"/>')
    for x in xs:
        parts.append(f'<text x="{place(x, 1)[0]:.1f}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{x}</text>')
    for y in (0.1, 1, 10):
        parts.append(f'<path d="M{left + 46} {place(xs[0], y)[1]:.1f}h{WIDTH}" stroke="#eee"/>'
                     f'<text x="{left + 40}" y="{place(xs[0], y)[1] + 4:.1f}" text-anchor="end">{y}</text>')
    for i, (name, points) in enumerate(lines):
        color = COLORS[i % len(COLORS)]
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in (place(*point) for point in points))
        parts.append(f'<path d="M{path}" fill="none" stroke="{color}" stroke-width="1.6"/>')
        for point in points:
            x, y = place(*point)
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>')
        parts.append(f'<text x="{left + 58 + WIDTH}" y="{TOP + 14 + 16 * i}" fill="{color}">{name}</text>')


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("-o", "--output")
    given = arguments.parse_args()
    resolutions, errors = measure(given.program)
    print("layers    ideal" + "".join(f" {resolution:8d}" for resolution in resolutions))
    for layers, row in errors.items():
        print(f"{layers:6d}" + "".join(f" {error:8.3f}" for error in row))
    if not given.output:
        return
    names = ["ideal maps"] + [f"{resolution}²" for resolution in resolutions]
    by_layers = [(name, [(layers, row[i]) for layers, row in errors.items()]) for i, name in enumerate(names)]
    by_pixels = [(f"{layers} layers" + (" (1998)" if layers == 2 else ""), list(zip(resolutions, errors[layers][1:])))
                 for layers in LAYERS_DRAWN]
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 940 280" width="940" height="280" '
             'style="font-family:sans-serif;font-size:12px"><rect width="940" height="280" fill="#fff"/>']
    draw_panel(parts, 0, "mean error, px, against the number of layers", by_layers)
    draw_panel(parts, 470, "against pixels across a map", by_pixels)
    with open(given.output, "w", encoding="utf-8") as file:
        file.write("\n".join([*parts, "</svg>"]) + "\n")


if __name__ == "__main__":
    main()
