#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""morphing_figures.py COMMAND [VIEWS]: displacement of reflection morphing against rays at viewer positions inside cells.

Bakes the scene `columns` over a box of the viewer and compares from VIEWS (50) positions, spread over the box by a fixed
sequence; prints the median over the views, and the worst view, of each figure.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile

LOWER, UPPER, COUNTS = (-0.5, 0.8, 2.0), (0.7, 1.4, 2.6), "9x5x5"
METHODS = ("environment", "morphing")


def position(i):
    """R3 sequence: no two views share a plane of the grid."""
    steps = (0.8191725134, 0.6710436067, 0.5497004779)
    return [low + (high - low) * ((0.5 + step * (i + 1)) % 1) for low, high, step in zip(LOWER, UPPER, steps)]


def main():
    command, views = os.path.abspath(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 50
    rows = {method: [] for method in METHODS}
    with tempfile.TemporaryDirectory() as folder:
        box = ",".join(map(str, LOWER + UPPER))
        subprocess.run([command, "bake", "columns", "-o", "columns.bake", "--box", box, "--counts", COUNTS, "-q"],
                       cwd=folder, check=True)
        for i in range(views):
            eye = ",".join(f"{x:.4f}" for x in position(i))
            subprocess.run([command, "compare", "columns", "-o", "report", "--methods", ",".join(METHODS), "--baked",
                            "columns.bake", "--eye", eye, "--target", "0,0.5,0", "--fov", "36", "--repeat", "1", "-q"],
                           cwd=folder, check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "report", "report.json"), encoding="utf-8") as file:
                for row in json.load(file)["results"]:
                    if row["name"] in rows:
                        rows[row["name"]].append(row["displacement"])
    for method in METHODS:
        for pixels in ("mirror_pixels", "object_pixels"):
            for figure in ("median_px", "p95_px", "share_le_1px", "share_lost"):
                values = [row[pixels][figure] for row in rows[method]]
                worst = min(values) if figure == "share_le_1px" else max(values)
                print(f"{method:12} {pixels:13} {figure:12} median {statistics.median(values):8.4f}  worst {worst:8.4f}")


if __name__ == "__main__":
    main()
