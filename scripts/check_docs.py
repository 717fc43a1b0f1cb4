#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_docs.py [COMMAND]: what the documentation says is there, is there.

- each relative link of a Markdown file leads to a file or folder of the tree;
- with the built command: each command and each option that its --help names stands in the man page and in the
  completions of bash, zsh and fish, and each long option of the man page is one that some --help names.
"""
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LINK = re.compile(r"!?\[[^\]]*\]\(([^)#\s]+)[^)]*\)")
IMAGE = re.compile(r'<img[^>]*src="([^"]+)"')
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")
TEXTS = ["packaging/catoptric.1", "packaging/completions/catoptric.bash", "packaging/completions/_catoptric",
         "packaging/completions/catoptric.fish"]


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def broken_links():
    for root, folders, names in os.walk(ROOT):
        folders[:] = sorted(f for f in folders if f not in ("build", "out", ".git"))
        for name in sorted(names):
            if not name.endswith(".md"):
                continue
            path = os.path.relpath(os.path.join(root, name), ROOT)
            text = read(path)
            for target in LINK.findall(text) + IMAGE.findall(text):
                if "://" not in target and not os.path.exists(os.path.join(root, target)):
                    yield f"{path}: link to {target}, which is not there"


def options_by_command(command):
    """Option names by command name, from --help."""
    def ask(*words):
        return subprocess.run([command, *words, "--help"], capture_output=True, text=True, check=True).stdout

    top = ask()
    known = ["info", "render", "compare", "bench", "bake", "view", "scenes"]
    commands = [name for name in known if re.search(rf"^\s+{name}\b", top, re.M)]
    return {name: set(re.findall(r"^\s+(?:-\w,\s*)?(--[a-z][a-z-]+)", ask(name), re.M)) for name in commands}


def missing_options(command):
    options = options_by_command(command)
    if len(options) < 2:
        yield "--help of the command lists fewer than two commands"
    texts = {path: read(path) for path in TEXTS}
    for path, text in texts.items():
        plain = text.replace("\\-", "-")
        bare = re.sub(r"-l (\w[\w-]*)", r"--\1", plain)  # fish writes  -l name
        for name, names in options.items():
            if not re.search(rf"\b{name}\b", bare):
                yield f"{path}: command {name} is missing"
            for option in sorted(names):
                if not re.search(rf"(?<![\w-]){option}(?![\w-])", bare):
                    yield f"{path}: {option} of `catoptric {name}` is missing"
    every = set().union(*options.values()) | {"--help", "--version"}
    for option in sorted(set(OPTION.findall(texts[TEXTS[0]].replace("\\-", "-"))) - every):
        yield f"{TEXTS[0]}: {option} is described, but no command takes it"


def main():
    errors = list(broken_links())
    if len(sys.argv) > 1:
        errors += missing_options(sys.argv[1])
    print("\n".join(errors), file=sys.stderr, end="\n" if errors else "")
    print(f"docs: {len(errors)} errors")
    sys.exit(1 if errors else 0)


if __name__ == "__main__":
    main()
