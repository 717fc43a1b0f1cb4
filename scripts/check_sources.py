#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_sources.py: the rules of CONTRIBUTING.md that a machine can check by reading.

- the first lines of each source file name the licence (SPDX);
- no source file over 400 lines, no shader over 200; over 300 and 150 is said, not refused;
- a third-party library is seen by one folder only (Embree by reference, GL by gl, nlohmann-json by scene and app, CLI11 by app,
  GLFW and ImGui by app/viewer);
- includes are written "catoptric/FOLDER/file.h": no way around the targets through "..";
- GLSL lives in shaders/, not in C++ strings; a header is included once (#pragma once);
- no disabled test without a reason on the same or the line before.
"""
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FOLDERS = ["src", "app", "tests", "bench", "examples", "shaders", "scripts", "cmake", "packaging", ".ci"]
SPDX = "SPDX-License-Identifier: Apache-2.0"
LIMITS = {"cpp": (300, 400), "h": (300, 400), "py": (300, 400), "sh": (150, 300), "glsl": (150, 200),
          "vert": (150, 200), "frag": (150, 200), "cmake": (150, 300)}
# Header pattern -> the only folders that may include it.
OWNERS = {r"embree\d*/": ["src/catoptric/reference"], r"meshoptimizer": ["src/catoptric/geometry"], r"glad/|EGL/|GL/|GLES\d/": ["src/catoptric/gl"],
          r"nlohmann/": ["src/catoptric/scene", "app", "tests"], r"CLI/": ["app"], r"GLFW/|imgui": ["app/viewer"],
          r"(png|jpeglib)\.h|webp/|OpenEXR/|Imf": ["src/catoptric/core"]}


def check(path, text, errors, notes):
    lines = text.splitlines()
    kind = path.rsplit(".", 1)[-1] if "." in os.path.basename(path) else ""
    if kind in ("cpp", "h", "py", "sh", "glsl", "vert", "frag", "cmake", "txt") and "data/" not in path:
        needed = kind != "txt" or os.path.basename(path) == "CMakeLists.txt"
        if needed and not any(SPDX in line for line in lines[:3]):
            errors.append(f"{path}:1: no SPDX line in the first three lines")
    if kind in LIMITS:
        say, refuse = LIMITS[kind]
        if len(lines) > refuse:
            errors.append(f"{path}: {len(lines)} lines, more than {refuse}: split it")
        elif len(lines) > say:
            notes.append(f"{path}: {len(lines)} lines, more than {say}")
    if kind not in ("cpp", "h"):
        return
    if kind == "h" and "#pragma once" not in text:
        errors.append(f"{path}: no #pragma once")
    for number, line in enumerate(lines, 1):
        include = re.match(r'\s*#\s*include\s+[<"]([^>"]+)[>"]', line)
        if include:
            for pattern, owners in OWNERS.items():
                inside = any(path.startswith(owner + "/") for owner in owners)
                name = owners[0].split("/")[-1]
                in_test = path.startswith((f"tests/unit/{name}/", f"tests/{name}/"))
                if re.match(pattern, include.group(1)) and not inside and not in_test:
                    errors.append(f"{path}:{number}: {include.group(1)} may be included only in {owners[0]}")
            if ".." in include.group(1).split("/"):
                errors.append(f'{path}:{number}: include through ".."')
        if re.search(r"#version\s+\d|gl_Position|gl_FragCoord", line) and not line.lstrip().startswith("//"):
            if not path.startswith(("src/catoptric/gl/", "app/viewer/window.cpp", "tests/")):  # ImGui's is told a version
                errors.append(f"{path}:{number}: GLSL in C++; shaders are files in shaders/")
        if re.search(r"\bDISABLED_\w+", line) and "//" not in line + lines[max(0, number - 2)]:
            errors.append(f"{path}:{number}: a disabled test without a reason")


def main():
    errors, notes, count = [], [], 0
    for folder in FOLDERS:
        for root, folders, names in os.walk(os.path.join(ROOT, folder)):
            folders[:] = sorted(f for f in folders if not f.startswith((".", "__pycache__")))
            for name in sorted(names):
                path = os.path.relpath(os.path.join(root, name), ROOT)
                try:
                    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
                        text = file.read()
                except UnicodeDecodeError:
                    continue  # pictures and other test data
                count += 1
                check(path, text, errors, notes)
    for note in notes:
        print(f"note: {note}")
    for error in errors:
        print(error, file=sys.stderr)
    print(f"sources: {count} files, {len(errors)} errors, {len(notes)} notes")
    sys.exit(1 if errors else 0)


if __name__ == "__main__":
    main()
