#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""validate_shaders.py: every file in shaders/ compiles as `330 core` and as `300 es` (glslangValidator).

A .vert or .frag file is put together as gl/Program does it: the version, the definitions of the GLSL side, then the
file with each `#include "path"` replaced by shaders/path. A .glsl file of lib/ is compiled alone too, with an empty
main; any other .glsl file is a part of the shaders that include it, and there must be one. A variant is one feature switch `#if FEATURE` / `#ifdef FEATURE` a file, so each file is compiled with the
switch off and on. Prints one line a failure, then the count; exit 1 on any failure.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

FOLDER = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "shaders")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"\s*$', re.M)
SWITCH = re.compile(r"^\s*#\s*(?:if|ifdef|ifndef)\s+(?:defined\s*\(?\s*)?([A-Z][A-Z0-9_]*)\b", re.M)
SAMPLERS = [p + s for p in ("", "i", "u") for s in ("sampler2D", "sampler3D", "samplerCube", "sampler2DArray")]
SAMPLERS += ["sampler2DShadow", "samplerCubeShadow", "sampler2DArrayShadow"]
PREAMBLE = ("#define Real float\n#define Real2 vec2\n#define Real3 vec3\n#define choose(c, a, b) ((c) ? (a) : (b))\n"
            "#define anyLane(c) (c)\n#define CATOPTRIC_FN\n")  # src/catoptric/gl/program.cpp
DIALECTS = {
    "330 core": "#version 330 core\n",
    "300 es": "#version 300 es\nprecision highp float;\nprecision highp int;\n"
              + "".join(f"precision highp {sampler};\n" for sampler in SAMPLERS),
}


def expand(path, depth, lines, sources):
    """Appends the file with its includes to `lines`, and (file, line) of each to `sources`."""
    if depth > 8:
        raise FileNotFoundError(f"includes nest too deeply at shaders/{path}")
    full = os.path.join(FOLDER, path)
    if not os.path.isfile(full):
        raise FileNotFoundError(f"shaders/{path} is included but does not exist")
    with open(full, encoding="utf-8") as file:
        for number, line in enumerate(file.read().splitlines(), 1):
            match = INCLUDE.match(line)
            if match is None:
                lines.append(line)
                sources.append((path, number))
            else:
                expand(match.group(1), depth + 1, lines, sources)


def compile_one(job):
    """Returns the error lines of one file in one dialect with one set of switches."""
    path, dialect, switches = job
    lines, sources = [], []
    try:
        expand(path, 0, lines, sources)
    except FileNotFoundError as error:
        return [f"shaders/{path}: {error}"]
    head = DIALECTS[dialect] + PREAMBLE + "".join(f"#define {s} 1\n" for s in switches)
    stage = {".vert": "vert", ".frag": "frag"}.get(os.path.splitext(path)[1])
    tail = "" if stage else "\nvoid main() {}\n"
    with tempfile.NamedTemporaryFile("w", suffix=".glsl", encoding="utf-8") as file:
        file.write(head + "\n".join(lines) + "\n" + tail)
        file.flush()
        done = subprocess.run(["glslangValidator", "-S", stage or "frag", file.name], capture_output=True, text=True)
    if done.returncode == 0:
        return []
    errors = []
    for line in (done.stdout + done.stderr).splitlines():
        match = re.match(r"(?:ERROR|WARNING): .*?:(\d+): (.*)", line)
        at = int(match.group(1)) - head.count("\n") - 1 if match else -1
        if match and 0 <= at < len(sources):
            errors.append(f"shaders/{sources[at][0]}:{sources[at][1]}: [{dialect}{''.join(' ' + s for s in switches)}] "
                          f"{match.group(2)}")
        elif line.startswith("ERROR") and not errors:
            errors.append(f"shaders/{path}: [{dialect}] {line}")
    return errors or [f"shaders/{path}: [{dialect}] glslangValidator exit {done.returncode}"]


def main():
    if shutil.which("glslangValidator") is None:
        sys.exit("validate_shaders: glslangValidator is missing (apt-get install glslang-tools)")
    jobs, parts, used = [], set(), set()
    for root, _, names in os.walk(FOLDER):
        for name in sorted(names):
            if not name.endswith((".vert", ".frag", ".glsl")):
                continue
            path = os.path.relpath(os.path.join(root, name), FOLDER)
            with open(os.path.join(FOLDER, path), encoding="utf-8") as file:
                text = file.read()
            switches = sorted(set(SWITCH.findall(text)) - {"GL_ES", "CATOPTRIC_FN", "CATOPTRIC_LANES"})
            used.update(INCLUDE.findall(text))
            if name.endswith(".glsl") and not path.startswith("lib/"):
                parts.add(path)
                continue
            for dialect in DIALECTS:
                for chosen in [[]] + [[switch] for switch in switches]:
                    jobs.append((path, dialect, chosen))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        errors = [error for result in pool.map(compile_one, jobs) for error in result]
    errors += [f"shaders/{path}: no shader includes it" for path in sorted(parts - used)]
    print("\n".join(dict.fromkeys(errors)), file=sys.stderr, end="\n" if errors else "")
    print(f"shaders: {len({path for path, _, _ in jobs} | parts)} files, {len(jobs)} compilations, {len(errors)} errors")
    sys.exit(1 if errors or not jobs else 0)


if __name__ == "__main__":
    main()
