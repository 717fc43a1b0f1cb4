#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""viewer_figures.py [SCENE...]: how fast the viewer is, as a table; four-spheres unless scenes are named.

Each scene in a window of 960x720 on a virtual X server of its own (Xvfb, xdotool), orbited by the mouse for
CATOPTRIC_ORBIT_SECONDS (10), the mirrors in view. Columns: from the command to the first picture (a coarse one by ray tracing, where that
is sooner), to the first frame by the method, coarse and in full; pictures a second while orbiting, their median size; from an input to the picture that shows it, the input the first one that no earlier picture showed, median and 95 %.
CATOPTRIC names the command, CATOPTRIC_COLD=1 empties Mesa's shader cache, as it is at the first start on a machine.
"""
import os
import re
import statistics
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
os.environ.setdefault("CATOPTRIC", os.path.join(HERE, "..", "build", "release", "catoptric"))
os.environ["CATOPTRIC"] = os.path.abspath(os.environ["CATOPTRIC"])
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(HERE, "..", "tests", "cli"))
import window_support  # noqa: E402 (the path is set above)

ORBIT_SECONDS = float(os.environ.get("CATOPTRIC_ORBIT_SECONDS", "10"))
MOVING = re.compile(r"moving: (\d+)x(\d+), (\d+) ms, (\d+) ms after the input")


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


def orbit(viewer):
    """Said while the mouse goes to and fro; a move each 10 ms, as a mouse sends them."""
    viewer.do("mousemove", 700, 360)
    time.sleep(0.3)  # the press must not be where the pointer came from
    viewer.do("mousedown", 1)
    before, end, moves = len(viewer.said()), time.monotonic() + ORBIT_SECONDS, 0
    while time.monotonic() < end:
        step = 6 if moves // 10 % 2 == 0 else -6
        viewer.do(*(["mousemove_relative", "--", step, 0, "sleep", "0.01"] * 10))
        moves += 10
    said = viewer.said()[before:]
    viewer.do("mouseup", 1)
    return said


def wait_for_line(viewer, pattern, start):
    """Milliseconds from `start` until the viewer says it."""
    while viewer.count(pattern) == 0:
        if viewer.process.poll() is not None or time.monotonic() - start > window_support.PATIENCE:
            raise SystemExit(f"the viewer did not say '{pattern}': {viewer.said()}")
        time.sleep(0.01)
    return round(1e3 * (time.monotonic() - start))


def measure(scene, display):
    with tempfile.TemporaryDirectory(prefix="catoptric-figures-") as folder:
        if os.environ.get("CATOPTRIC_COLD"):
            os.environ["MESA_SHADER_CACHE_DIR"] = os.environ["MESA_GLSL_CACHE_DIR"] = os.path.join(folder, "shaders")
        start = time.monotonic()
        viewer = window_support.Viewer(folder, display, scene, "--size", "960x720")
        try:
            picture = wait_for_line(viewer, "first (picture, ray-traced,|frame) after", start)
            first = wait_for_line(viewer, "first frame after", start)
            full = wait_for_line(viewer, "first frame in full after", start)
            viewer.wait_for_window()
            viewer.do("key", "p")
            said = orbit(viewer)
            viewer.do("key", "ctrl+q")
            code = viewer.end()
        finally:
            viewer.kill()
    frames = [tuple(map(int, match)) for match in MOVING.findall(said)]
    latencies = [frame[3] for frame in frames]
    widths = [frame[0] for frame in frames]
    if code != 0 or not frames:
        return f"| {scene} | the viewer ended with {code}, {len(frames)} pictures |"
    width = int(statistics.median(widths))
    return (f"| {os.path.basename(scene)} | {picture} | {first} | {full} | {len(frames) / ORBIT_SECONDS:.1f} | {width}x{width * 3 // 4} | "
            f"{statistics.median(latencies):.0f} | {percentile(latencies, 0.95):.0f} |")


def main():
    window_support.skip_without_tools()
    print("| scene | first picture, ms | first frame, ms | in full, ms | orbiting, pictures/s | their size | input to picture, ms | 95 %, ms |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for scene in sys.argv[1:] or ["four-spheres"]:
        path = os.path.abspath(scene) if os.path.exists(scene) else scene
        with window_support.Display(1000, 800) as display:
            print(measure(path, display), flush=True)


if __name__ == "__main__":
    main()
