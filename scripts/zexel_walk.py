#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""zexel_walk.py CATOPTRIC [SCENE...]: depth-preserving reflection maps along the walks of checker-box and furnished-room.

For each scene: displacement from ray-traced truth at moments of the walk, over object pixels, the environment map's
beside it; and the share of mirror pixels that no zexel reached, with all remedies and with each one off, over a sequence
of frames. Prints Markdown tables."""
import json
import os
import subprocess
import sys
import tempfile

SECONDS = {"furnished-room": 8.0, "checker-box": 6.0}
MOMENTS = 9    # that are compared with the truth
FRAMES = 25    # that are drawn one after the other
COMPARED = ("--size", "640x480", "--camera", "walk", "--repeat", "1", "--methods", "environment,zexel")
REMEDIES = [("all of them", ()),
            ("splats 3x3", ("--zexel-splat", "square")),
            ("no splats", ("--zexel-splat", "point")),
            ("no coherence", ("--zexel-without", "coherence")),
            ("one reference", ("--zexel-references", "1")),
            ("none: points, one reference, no coherence",
             ("--zexel-splat", "point", "--zexel-references", "1", "--zexel-without", "coherence"))]


def run(catoptric, *arguments):
    subprocess.run([catoptric, *arguments, "--quiet"], check=True, stdout=subprocess.DEVNULL)


def displacement(catoptric, scene, folder):
    """method -> list of statistics of object pixels, one a moment."""
    found = {"environment": [], "zexel": []}
    for i in range(MOMENTS):
        time = SECONDS[scene] * i / (MOMENTS - 1)
        run(catoptric, "compare", scene, "-o", folder, *COMPARED, "--time", f"{time:.3f}")
        with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
            for row in json.load(file)["results"]:
                pixels = row["displacement"]["object_pixels"]
                if row["name"] in found and pixels["pixels"] >= 100:
                    found[row["name"]].append(pixels)
    return found


def uncovered(catoptric, scene, folder, options):
    """Share of mirror pixels in each frame."""
    data = os.path.join(folder, "frames.json")
    run(catoptric, "render", scene, "-o", os.path.join(folder, "frame_##.png"), "--method", "zexel", "--camera", "walk",
        "--size", "640x480", "--frames", str(FRAMES), "--fps", f"{(FRAMES - 1) / SECONDS[scene]:.6f}", "--json", data, *options)
    with open(data, encoding="utf-8") as file:
        counters = [frame["counters"] for frame in json.load(file)["frames"]]
    return [c["uncovered_pixels"] / c["zexel_pixels"] for c in counters if c["zexel_pixels"]]


def main():
    catoptric, scenes = sys.argv[1], sys.argv[2:] or list(SECONDS)
    print(f"Displacement, object pixels, {MOMENTS} moments of the walk, 640x480: mean over the moments (worst); "
          "within 2 px: of the pixels of all moments together\n")
    print("| scene | method | median px | 95th percentile px | within 1 px | within 2 px | lost |\n"
          "| --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            for method, moments in displacement(catoptric, scene, folder).items():
                def cell(name, worst, scale=1.0, unit="", moments=moments):
                    values = [scale * m[name] for m in moments]
                    return f"{sum(values) / len(values):.2f} ({worst(values):.2f}){unit}"
                pixels = sum(m["pixels"] for m in moments)
                within = sum(m["pixels"] * m["share_le_2px"] for m in moments) / pixels
                print(f"| {scene} | {method} | {cell('median_px', max)} | {cell('p95_px', max)} | "
                      f"{cell('share_le_1px', min, 100, ' %')} | {100 * within:.2f} % | "
                      f"{cell('share_lost', max, 100, ' %')} |", flush=True)
        print(f"\nUncovered mirror pixels, {FRAMES} frames of the walk, 640x480: mean (worst frame)\n")
        print("| remedies | " + " | ".join(scenes) + " |\n| --- |" + " --- |" * len(scenes))
        for name, options in REMEDIES:
            cells = []
            for scene in scenes:
                shares = uncovered(catoptric, scene, folder, options)
                cells.append(f"{100 * sum(shares) / len(shares):.2f} % ({100 * max(shares):.2f} %)")
            print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
