#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""morphing_plots.py COMMAND FOLDER: what the error of reflection morphing depends on.

Bakes one cell of the scene `columns` around each of a few eyes, with other spacings, rays and depths, compares what is
drawn from its middle with rays, and writes FOLDER/morphing-{spacing,rays,depth}.svg: median and 95th percentile of the
displacement over all mirror pixels, means over the eyes.
"""
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

EYES = ((0.06, 1.15, 2.3), (-0.35, 0.95, 2.1), (0.5, 1.3, 2.45))
SWEEPS = (
    ("spacing", "metres between sampling locations", (0.025, 0.05, 0.1, 0.2, 0.4, 0.8), lambda x: (x, 256, 5)),
    ("rays", "rays along an edge of a ray map (cells of 0.1 m)", (16, 32, 64, 128, 256, 512), lambda x: (0.1, x, 5)),
    ("depth", "levels of the ray octree (cells of 0.1 m)", (0, 1, 2, 3, 4, 5, 6), lambda x: (0.1, 256, x)),
)
WIDTH, HEIGHT, LEFT, BOTTOM = 420, 260, 56, 44
STYLE = "font-family:sans-serif;font-size:12px"


def measure(command, folder, spacing, rays, depth):
    """Median, 95th percentile; means over the eyes."""
    figures = []
    for eye in EYES:
        box = ",".join(f"{x - spacing / 2:.6f}" for x in eye) + "," + ",".join(f"{x + spacing / 2:.6f}" for x in eye)
        subprocess.run([command, "bake", "columns.glb", "-o", "cell.bake", f"--box={box}", "--counts", "2x2x2", "--rays",
                        str(rays), "--depth", str(depth), "-q"], cwd=folder, check=True)
        subprocess.run([command, "compare", "columns.glb", "-o", "report", "--methods", "morphing", "--baked", "cell.bake",
                        "--eye=" + ",".join(map(str, eye)), "--target", "0,0.5,0", "--fov", "36", "--repeat", "1", "-q"],
                       cwd=folder, check=True, stdout=subprocess.DEVNULL)
        os.remove(os.path.join(folder, "cell.bake"))
        with open(os.path.join(folder, "report", "report.json"), encoding="utf-8") as file:
            row = next(r for r in json.load(file)["results"] if r["name"] == "morphing")
        pixels = row["displacement"]["mirror_pixels"]
        figures.append((pixels["median_px"], pixels["p95_px"]))
    return [statistics.mean(column) for column in zip(*figures)]


def draw(title, xs, rows):
    """Both axes logarithmic, but depths by number."""
    is_log = xs[0] > 0
    position = [math.log10(x) if is_log else x for x in xs]
    low, high = math.floor(math.log10(min(map(min, rows)))), math.ceil(math.log10(max(map(max, rows))))

    def to_x(value):
        return LEFT + (value - position[0]) / (position[-1] - position[0]) * (WIDTH - LEFT - 16)

    def to_y(value):
        return HEIGHT - BOTTOM - (math.log10(value) - low) / (high - low) * (HEIGHT - BOTTOM - 30)

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" style="{STYLE}">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>']
    for power in range(low, high + 1):
        y = to_y(10 ** power)
        parts.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - 16}" stroke="#ddd"/>'
                     f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{10 ** power:g}</text>')
    for x, at in zip(xs, position):
        parts.append(f'<text x="{to_x(at):.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{x:g}</text>')
    for column, (name, colour) in enumerate((("median", "#1f6fb4"), ("95th percentile", "#c2452d"))):
        points = [(to_x(at), to_y(row[column])) for at, row in zip(position, rows)]
        parts.append(f'<polyline fill="none" stroke="{colour}" stroke-width="2" points="'
                     + " ".join(f"{x:.1f},{y:.1f}" for x, y in points) + '"/>')
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]
        parts.append(f'<text x="{LEFT + 8 + 70 * column}" y="16" fill="{colour}">{name}</text>')
    parts.append(f'<text x="{WIDTH - 16}" y="16" text-anchor="end">displacement, px</text>')
    parts.append(f'<text x="{(WIDTH + LEFT) / 2}" y="{HEIGHT - 8}" text-anchor="middle">{title}</text></svg>')
    return "\n".join(parts) + "\n"


def main():
    command, target = os.path.abspath(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([command, "scenes", "columns", "-o", folder, "-q"], check=True)
        for name, title, xs, options in SWEEPS:
            rows = []
            for x in xs:
                rows.append(measure(command, folder, *options(x)))
                print(f"{name:8} {x:6g}  median {rows[-1][0]:.4f} px  95 % {rows[-1][1]:.4f} px", flush=True)
            with open(os.path.join(target, f"morphing-{name}.svg"), "w", encoding="utf-8") as file:
                file.write(draw(title, xs, rows))


if __name__ == "__main__":
    main()
