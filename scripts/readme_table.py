#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""readme_table.py [--update FILE] REPORT.json...: the figures of comparisons as Markdown tables.

Each report is one that `catoptric compare` wrote. With --update, the part of FILE between the lines
`<!-- figures -->` and `<!-- /figures -->` is replaced; otherwise the tables are printed. Figures come from the reports
only, so every one in the README was printed by a command of this repository (`make demo`, then `make readme-figures`).
"""
import json
import re
import sys

HEAD = ["scene", "method", "median px", "≤ 1 px", "lost", "median px, objects", "≤ 1 px, objects", "lost, objects",
        "frame, ms", "of which reflections, ms"]


def number(value, form):
    return "–" if value is None else form.format(value)


def share(value):
    return "–" if value is None else f"{100 * value:.1f} %"


def row_cells(row):
    every, objects = (row["displacement"][name] for name in ("mirror_pixels", "object_pixels"))
    cells = [row["scene"], row["name"]]
    for part in (every, objects):
        cells += [number(part["median_px"], "{:.2f}"), share(part["share_le_1px"]), share(part["share_lost"])]
    return cells + [number(row["median_ms"], "{:.0f}"), number(row["reflection_ms"], "{:.0f}")]


def table(head, rows):
    widths = [max(len(cell) for cell in column) for column in zip(head, *rows)]
    lines = [" | ".join(cell.ljust(width) for cell, width in zip(row, widths)) for row in [head, *rows]]
    lines.insert(1, " | ".join("-" * width for width in widths))
    return "\n".join("| " + line + " |" for line in lines)


def mirror_table(results):
    """One row for each scene and method; the truth is compared with nothing, but its time belongs beside the others."""
    rows, last = [], None
    for row in results:
        cells = row_cells(row)
        if row["method"] == "raytrace":
            cells[2:8] = ["truth"] + ["–"] * 5
        cells[0] = "" if cells[0] == last else cells[0]
        last = row["scene"]
        rows.append(cells)
    return table(HEAD, rows)


def plain_table(results):
    """Pictures without mirrors: only the share of pixels that agree says something."""
    rows = [[row["scene"], row["name"], share(row["primary"]["share_within_4"]),
             number(row["primary"]["mean_difference"], "{:.3f}")]
            for row in results if row["method"] != "raytrace"]
    return table(["scene", "method", "pixels within 4/255 of the truth", "mean difference, 1/255"], rows)


def speeds(results):
    vertices = [r["virtual_vertices_per_s"] for r in results if r.get("virtual_vertices_per_s")
                and r["solver"] == "refined"]
    rays = [r["rays_per_s"] for r in results if r.get("rays_per_s")]
    if not vertices or not rays:
        return ""
    return (f"Speed over these frames: {min(vertices) / 1e6:.1f} to {max(vertices) / 1e6:.1f} million virtual vertices "
            f"per second (`refined`), {min(rays) / 1e6:.1f} to {max(rays) / 1e6:.1f} million rays per second "
            f"(`raytrace`).\n")


def describe(report):
    results, environment = report["results"], report["environment"]
    first = results[0]
    machine = [environment.get("gl_renderer"), environment.get("embree"), f"{environment.get('threads')} threads"]
    return (f"{first['width']} × {first['height']}, {first['bounces']} bounce{'s' if first['bounces'] != 1 else ''}. "
            + "; ".join(str(part) for part in machine if part) + ".")


def render_report(path):
    with open(path, encoding="utf-8") as file:
        report = json.load(file)
    results = report["results"]
    if not results:
        return ""
    has_mirrors = any(row["displacement"]["mirror_pixels"]["pixels"] for row in results)
    body = mirror_table(results) if has_mirrors else plain_table(results)
    return "\n\n".join(part for part in (describe(report), body, speeds(results) if has_mirrors else "") if part)


def main():
    paths, target = sys.argv[1:], None
    if len(paths) > 1 and paths[0] == "--update":
        target, paths = paths[1], paths[2:]
    if not paths:
        sys.exit("usage: readme_table.py [--update FILE] REPORT.json...")
    text = "\n\n".join(render_report(path).strip() for path in paths)
    if target is None:
        sys.stdout.write(text + "\n")
        return
    with open(target, encoding="utf-8") as file:
        old = file.read()
    new, count = re.subn(r"(<!-- figures -->\n).*(<!-- /figures -->)", lambda m: m[1] + "\n" + text + "\n\n" + m[2], old,
                         flags=re.S)
    if count != 1:
        sys.exit(f"readme_table: {target} has no place marked for figures")
    with open(target, "w", encoding="utf-8") as file:
        file.write(new)


if __name__ == "__main__":
    main()
