#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""virtual_object_scaling.py CATOPTRIC [-o PLOT.svg] [--repeat N]: what reflections by virtual objects (solver refined) cost.

Three sweeps, each with a slope fitted to logarithms: against reflected vertices (less to reflect, more mirrors, then finer --max-error), against
reflectors (32 chrome balls, of which so many are mirrors), against pixels. Printed as tables, drawn side by side. Times are the reflection part of
a frame, but for vertices, where they are those of finding virtual vertices; all as `bench` measures them."""
import argparse
import json
import math
import os
import subprocess
import tempfile

from zexel_scaling import Glb

# Groups (a board, a pole and beads), balls, how many of them are mirrors, --max-error. All four groups and 32 balls, of which one is a
# mirror and shows the others, have 4,000 virtual vertices before anything is cut: for fewer there is less to show.
SCENES = ((1, 1, 1, 64), (4, 1, 1, 64), (4, 32, 1, 64), (4, 32, 1, 8), (4, 32, 2, 8), (4, 32, 4, 8), (4, 32, 8, 8), (4, 32, 16, 8),
          (4, 32, 32, 8), (4, 32, 32, 2), (4, 32, 32, 0.5), (4, 32, 32, 0.2))
SIZES = ("512x512", "960x720", "1280x960", "1920x1080", "2560x1440", "3840x2160")
COUNTS = (1, 2, 4, 8, 16, 32)


def bench(catoptric, folder, scene, repeat, *options):
    path = os.path.join(folder, "bench.json")
    subprocess.run([catoptric, "bench", scene, "--methods", "virtual-refined", "--repeat", str(repeat), "-q", "--json", path,
                    *options], check=True, stdout=subprocess.DEVNULL)
    with open(path, encoding="utf-8") as file:
        return json.load(file)["results"][0]


def is_left_out(name, groups):
    thing, _, number = name.partition(" ")
    return thing in ("ball", "partition") or thing in ("board", "pole", "bead") and int(number) > groups


def write_balls(catoptric, folder, groups, balls):
    """So many balls in place of the four of reflector-sweep, all like its finest one."""
    subprocess.run([catoptric, "scenes", "reflector-sweep", "-o", folder, "-q"], check=True)
    glb = Glb(os.path.join(folder, "reflector-sweep.glb"))
    scene = glb.json
    nodes, roots = scene["nodes"], scene["scenes"][0]["nodes"]
    mesh = next(node["mesh"] for node in nodes if node.get("name") == "ball 4")
    gone = {i for i, node in enumerate(nodes) if is_left_out(node.get("name", ""), groups)}
    scene["scenes"][0]["nodes"] = [i for i in roots if i not in gone]
    for i in range(balls):
        scene["scenes"][0]["nodes"].append(len(nodes))
        nodes.append({"name": f"mirror {i + 1}", "mesh": mesh, "scale": [0.4] * 3,
                      "translation": [(i % 8 - 3.5) * 0.44, 0.2 + 0.4 * (i // 8), -0.35]})
    path = os.path.join(folder, f"balls-{groups}-{balls}.glb")
    glb.write(path)
    return path


def fit_slope(points):
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    x0, y0 = sum(xs) / len(xs), sum(ys) / len(ys)
    slope = sum((x - x0) * (y - y0) for x, y in zip(xs, ys)) / sum((x - x0) ** 2 for x in xs)
    return slope, math.exp(y0 - slope * x0)


def draw_panel(parts, left, title, title_x, points):
    """One plot with logarithmic axes, 300 pixels wide."""
    width, height, top = 240, 200, 46
    x_range = [f(x for x, _ in points) for f in (min, max)]
    y_range = [min(y for _, y in points) / 1.5, max(y for _, y in points) * 1.5]

    def place(x, y):
        return (left + 50 + width * math.log(x / x_range[0]) / math.log(x_range[1] / x_range[0]),
                top + height * math.log(y_range[1] / y) / math.log(y_range[1] / y_range[0]))

    slope, factor = fit_slope(points)
    parts.append(f'<text x="{left + 50}" y="18">{title}</text>'
                 f'<text x="{left + 50}" y="34" fill="#666">time ~ {title_x}^{slope:.2f}</text>'
                 f'<rect x="{left + 50}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#bbb"/>')
    ends = [place(x, factor * x ** slope) for x in x_range]
    parts.append(f'<path d="M{ends[0][0]:.1f} {ends[0][1]:.1f}L{ends[1][0]:.1f} {ends[1][1]:.1f}" stroke="#aaa" stroke-dasharray="5 4"/>')
    for x, y in points:
        px, py = place(x, y)
        parts.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="4" fill="#1f6fb4"/>')
    for x in x_range:
        parts.append(f'<text x="{place(x, y_range[0])[0]:.1f}" y="{top + height + 16}" text-anchor="middle">{x:,.0f}</text>')
    for y in (points[0][1], points[-1][1]):
        parts.append(f'<text x="{left + 46}" y="{place(x_range[0], y)[1] + 4:.1f}" text-anchor="end">{y:.3g}</text>')
    parts.append(f'<text x="{left + 50 + width / 2}" y="{top + height + 34}" text-anchor="middle">{title_x}</text>')


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("catoptric")
    arguments.add_argument("-o", "--output")
    arguments.add_argument("--repeat", type=int, default=5)
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        full = write_balls(given.catoptric, folder, 4, 32)

        def bench_balls(scene, count, *options):
            named = [word for i in range(count) for word in ("--reflector", f"mirror {i + 1}")]
            return bench(given.catoptric, folder, scene, given.repeat, *named, *options)

        vertices = []
        for groups, balls, count, error in SCENES:
            scene = full if (groups, balls) == (4, 32) else write_balls(given.catoptric, folder, groups, balls)
            row = bench_balls(scene, count, "--max-error", str(error))
            vertices.append((row["virtual_vertices"], 1000 * row["virtual_vertices"] / row["virtual_vertices_per_s"]))
        reflectors = [(count, bench_balls(full, count)["reflection_ms"]) for count in COUNTS]
        pixels = []
        for size in SIZES:
            x, y = map(int, size.split("x"))
            pixels.append((x * y, bench(given.catoptric, folder, "four-spheres", given.repeat, "--size", size)["reflection_ms"]))
    sweeps = (("up to 32 balls, virtual vertices, ms", "vertices", vertices), ("32 balls, reflections, ms", "reflectors", reflectors),
              ("four-spheres, reflections, ms", "pixels", pixels))
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 960 290" width="960" height="290" '
             'style="font-family:sans-serif;font-size:12px"><rect width="960" height="290" fill="#fff"/>']
    for i, (title, title_x, points) in enumerate(sweeps):
        print(f"{title}: time ~ {title_x}^{fit_slope(points)[0]:.2f}")
        for x, y in points:
            print(f"  {x:>10,} {y:9.2f}")
        draw_panel(parts, 315 * i, title, title_x, points)
    if given.output:
        with open(given.output, "w", encoding="utf-8") as file:
            file.write("\n".join([*parts, "</svg>"]) + "\n")


if __name__ == "__main__":
    main()
