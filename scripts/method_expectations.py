#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""method_expectations.py CATOPTRIC [--size WxH]... [--repeat N] [--no-errors]: what `auto` expects, beside what is measured.

For one curved mirror of each of some built-in scenes and each way of drawing it: the expected 95th percentile of the displacement (`info`) and
the measured one (`compare`, the worse of mirror and object pixels), the expected time and the measured one (`bench`, the frame's reflections).
Then the constants of src/catoptric/renderer/expected_cost.cpp as this run would have them: least squares of relative errors, none negative."""
import argparse
import json
import os
import subprocess
import tempfile

MIRRORS = (("four-spheres", "large sphere"), ("four-spheres", "rose sphere"), ("cylinder", None), ("fender", None),
           ("drivers-view", "left wing mirror"), ("drivers-view", "right wing mirror"), ("tv", None), ("cone", None), ("columns", None), ("vase", None),
           ("concave-bowl", None), ("mixed", None), ("mask", None), ("wavy-wall", None), ("teapot", None))
WAYS = {("environment", "auto"): "environment", ("virtual", "refined"): "virtual-refined", ("virtual", "exact"): "virtual-exact"}


def run_json(catoptric, folder, *arguments):
    path = os.path.join(folder, "out.json")
    subprocess.run([catoptric, *arguments, "-q", "--json", path], check=True, stdout=subprocess.DEVNULL)
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def ask(catoptric, folder, scene, mirror, size, repeat, with_errors):
    """A row for each way of drawing the scene's largest curved mirror, the only one that is a mirror."""
    found = run_json(catoptric, folder, "info", scene, "--size", size)["reflectors"]
    curved = [r for r in found if r["auto"]["candidates"] and mirror in (None, r["name"])]
    name = max(curved, key=lambda r: r["auto"]["view"]["pixels"])["name"]
    given = ("--size", size, "--reflector", name)
    reflector = next(r for r in run_json(catoptric, folder, "info", scene, *given)["reflectors"] if r["name"] == name)
    candidates = {WAYS[c["method"], c["solver"]]: c for c in reflector["auto"]["candidates"]}
    methods = ",".join(candidates)
    times = {row["name"]: row["reflection_ms"] for row in
             run_json(catoptric, folder, "bench", scene, *given, "--methods", methods, "--repeat", str(repeat))["results"]}
    errors = {}
    if with_errors:
        for row in run_json(catoptric, folder, "compare", scene, *given, "--methods", methods, "--repeat", "1",
                            "-o", os.path.join(folder, "report"))["results"]:
            errors[row["name"]] = max(row["displacement"][k]["p95_px"] for k in ("mirror_pixels", "object_pixels"))
    return [{"scene": scene, "mirror": name, "size": size, "way": way, "convex": reflector["convex"], "view": reflector["auto"]["view"],
             "expected": c, "ms": times[way], "px": errors.get(way)} for way, c in candidates.items()]


def fit(rows, features):
    """Weights of the features, none negative, by coordinate descent on squares of relative errors."""
    table = [[f(row["view"]) / row["ms"] for f in features] for row in rows]
    weights = [0.0] * len(features)
    for _ in range(20000):
        for j in range(len(weights)):
            above = sum(x[j] * (1 - sum(w * v for w, v in zip(weights, x)) + weights[j] * x[j]) for x in table)
            weights[j] = max(0.0, above / max(sum(x[j] ** 2 for x in table), 1e-300))
    return weights


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("catoptric")
    parser.add_argument("--size", action="append")
    parser.add_argument("--repeat", type=int, default=7)
    parser.add_argument("--no-errors", action="store_true")
    options = parser.parse_args()
    rows = []
    print(f"{'scene':14} {'mirror':18} {'size':>9} {'pixels':>7} {'way':15}   px expected  measured   ms expected  measured")
    with tempfile.TemporaryDirectory() as folder:
        for scene, mirror in MIRRORS:
            for size in options.size or ["960x720", "480x360"]:
                for row in ask(options.catoptric, folder, scene, mirror, size, options.repeat, not options.no_errors):
                    rows.append(row)
                    measured = "" if row["px"] is None else f"{row['px']:.3f}"
                    print(f"{scene:14} {row['mirror'][:18]:18} {size:>9} {row['view']['pixels']:7.0f} {row['way']:15} "
                          f"{row['expected']['expected_error_px']:12.3f} {measured:>9} {row['expected']['expected_ms']:13.1f} "
                          f"{row['ms']:9.1f}", flush=True)
    ratios = sorted(max(r["expected"]["expected_ms"] / r["ms"], r["ms"] / r["expected"]["expected_ms"]) for r in rows)
    print(f"expected : measured time, or the other way round: median {ratios[len(ratios) // 2]:.2f}, 90 % within {ratios[len(ratios) * 9 // 10]:.2f}")
    one, pixels = (lambda v: 1), (lambda v: v["pixels"])
    for way, wanted, features in (("environment", (True, False), (one, pixels)),
                                  ("virtual-refined", (True,), (one, pixels, lambda v: v["triangles"])),
                                  ("virtual-exact", (True, False), (one, pixels, lambda v: v["offered"]))):
        of_way = [r for r in rows if r["way"] == way and r["convex"] in wanted]
        print(f"{way}: " + ", ".join(f"{w:.3g}" for w in fit(of_way, features)))


if __name__ == "__main__":
    main()
