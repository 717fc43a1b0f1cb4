#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bake_figures.py COMMAND [KILLS [LOCATIONS]]: what `catoptric bake` costs, and that it can be stopped at any moment.

Prints, for the scene `columns` at 256^2 rays, depth 5 and one bounce, seconds, bytes and rays a leaf of a location; kills a
bake at KILLS (10) moments, resumes it and compares the bytes; bakes LOCATIONS (1000) and prints the largest memory that it
took beside that of 8 locations, and the estimates of its progress bar beside the time it took.
"""
import json
import os
import random
import statistics
import subprocess
import sys
import tempfile
import time

BOX = ("--box=-0.5,0.8,2,0.7,1.4,2.6",)


def bake(command, folder, name, counts, *words):
    """Seconds, largest memory in MB, lines of progress with the time at which they came."""
    start, lines = time.monotonic(), []
    process = subprocess.Popen([command, "bake", "columns", "-o", name, *BOX, "--counts", counts, *words], cwd=folder,
                               stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    for line in process.stderr:
        lines.append((time.monotonic() - start, line.strip()))
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"bake of {counts} ended with {status}")
    return time.monotonic() - start, usage.ru_maxrss / 1024, lines


def print_location(command, folder):
    bake(command, folder, "a.bake", "4x2x2", "--json", "a.json", "-q")
    with open(os.path.join(folder, "a.json"), encoding="utf-8") as file:
        rows = json.load(file)["locations"]
    print(f"a location: {statistics.median(r['seconds'] for r in rows):.3f} s of one thread, "
          f"at most {max(r['bytes'] for r in rows) / 1e6:.2f} MB, "
          f"{statistics.mean(r['mean_leaf_rays'] for r in rows):.1f} rays a leaf on average, "
          f"at most {max(r['most_leaf_rays'] for r in rows)}")


def print_kills(command, folder, kills):
    words = ("--rays", "96", "-q")
    whole, _, _ = bake(command, folder, "whole.bake", "6x5x4", *words)
    moments = random.Random(4)
    killed, same = 0, 0
    for _ in range(kills):
        process = subprocess.Popen([command, "bake", "columns", "-o", "killed.bake", *BOX, "--counts", "6x5x4", *words],
                                   cwd=folder)
        time.sleep(moments.uniform(0, whole))
        process.kill()
        killed += process.wait() != 0
        bake(command, folder, "killed.bake", "6x5x4", *words)
        with open(os.path.join(folder, "whole.bake"), "rb") as a, open(os.path.join(folder, "killed.bake"), "rb") as b:
            same += a.read() == b.read()
        os.remove(os.path.join(folder, "killed.bake"))
    print(f"{kills} bakes stopped at random moments ({killed} before they were done) and resumed: {same} with the same bytes")


def print_large(command, folder, locations):
    edge = round(locations ** (1 / 3))
    _, few, _ = bake(command, folder, "few.bake", "2x2x2", "-q")
    seconds, many, lines = bake(command, folder, "many.bake", f"{edge}x{edge}x{edge}")
    size = os.path.getsize(os.path.join(folder, "many.bake")) / 1e6
    print(f"{edge ** 3} locations: {seconds:.1f} s, file {size:.0f} MB, memory at most {many:.1f} MB (8 locations: {few:.1f} MB)")
    for at, line in lines:
        if "left" in line:
            print(f"  after {at:5.1f} s: '{line}'; in truth {seconds - at:.1f} s")


def main():
    command = os.path.abspath(sys.argv[1])
    kills, locations = (int(sys.argv[i]) if len(sys.argv) > i else default for i, default in ((2, 10), (3, 1000)))
    with tempfile.TemporaryDirectory() as folder:
        print_location(command, folder)
        print_kills(command, folder, kills)
        print_large(command, folder, locations)


if __name__ == "__main__":
    main()
