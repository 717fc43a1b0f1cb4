#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""structure_test.py layers|headers COMPILER STRUCTURE.json

layers:  for each folder of the library, a file that links to it compiles an include of each folder below it and fails
         to compile an include of any other. The table of what may see what stands here a second time on purpose: an
         arrow added in CMake alone fails.
headers: each header compiles alone, with what its own target gives it, twice in one file.

STRUCTURE.json, written by CMake: folder -> include directories of a target that links to it.
"""
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

SOURCE = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "src", "catoptric")
SCENE = {"core", "geometry", "scene"}
RASTER = SCENE | {"gl", "raster"}
METHODS = {"planar_mirror", "virtual_object", "environment_map", "reflection_morphing", "depth_reflection_map"}
# core <- geometry <- scene <- raster <- methods <- renderer; no method sees another, nor the judge, and it sees none.
SEES = {"core": set(), "geometry": {"core"}, "scene": {"core", "geometry"}, "gl": {"core"}, "metrics": {"core"},
        "raster": SCENE | {"gl"}, "reference": SCENE, **{method: RASTER for method in METHODS},
        "renderer": RASTER | METHODS | {"reference"},
        # It looks into methods and draws what it finds; nothing in the library looks back.
        "sketch": RASTER | {"virtual_object", "reflection_morphing", "depth_reflection_map"}}


def compile_text(compiler, directories, text):
    """True when `text` compiles; else the first line that says why not."""
    command = [compiler, "-std=c++20", "-fsyntax-only", "-x", "c++", "-", "-Wall", "-Wextra", "-Werror"]
    command += [f"-I{d}" for d in directories if d and d != "/usr/include"]
    done = subprocess.run(command, input=text, capture_output=True, text=True)
    lines = [line for line in done.stderr.splitlines() if "error:" in line] or [done.stderr[:300]]
    return done.returncode == 0 or lines[0]


def headers_of(folder):
    found = []
    for root, _, names in os.walk(os.path.join(SOURCE, folder)):
        found += [os.path.relpath(os.path.join(root, name), SOURCE) for name in names if name.endswith(".h")]
    return sorted(found)


def check_layers(compiler, structure):
    jobs = []
    for folder, directories in structure.items():
        for other in structure:
            headers = headers_of(other)
            if headers:
                text = f'#if __has_include("catoptric/{headers[0]}")\nint seen;\n#else\n#error not seen\n#endif\n'
                jobs.append((folder, other, directories, text))

    def run(job):
        folder, other, directories, text = job
        allowed = other == folder or other in SEES[folder]
        seen = compile_text(compiler, directories, text) is True
        return None if seen == allowed else f"{folder} {'must not see' if seen else 'should see'} {other}"

    if set(structure) != set(SEES):
        return 0, [f"folders of CMake and of this table differ: {sorted(set(structure) ^ set(SEES))}"]
    breach = '#include "catoptric/renderer/frame.h"\n'
    if compile_text(compiler, structure["core"], breach) is True:
        return 0, ["core compiles an include of renderer/frame.h"]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return len(jobs), [error for error in pool.map(run, jobs) if error]


def check_headers(compiler, structure):
    jobs = [(header, directories) for folder, directories in structure.items() for header in headers_of(folder)]

    def run(job):
        header, directories = job
        include = f'#include "catoptric/{header}"\n'
        result = compile_text(compiler, directories, include + include)
        return None if result is True else f"{header}: {result}"

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return len(jobs), [error for error in pool.map(run, jobs) if error]


def main():
    what, compiler, table = sys.argv[1:4]
    with open(table, encoding="utf-8") as file:
        structure = json.load(file)
    folders = {name for name in os.listdir(SOURCE) if os.path.isdir(os.path.join(SOURCE, name))}
    errors = [f"src/catoptric/{name} is not in the structure test" for name in sorted(folders - set(structure))]
    count, found = {"layers": check_layers, "headers": check_headers}[what](compiler, structure)
    errors += found
    print("\n".join(errors), file=sys.stderr)
    print(f"{what}: {count} compilations, {len(errors)} errors")
    sys.exit(1 if errors or count == 0 else 0)


if __name__ == "__main__":
    main()
