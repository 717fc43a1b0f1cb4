#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_docs.py [COMMAND]: what the documentation says is there, is there.

- each relative link of a Markdown file leads to a file or folder of the tree;
- with the built command: each option that `catoptric COMMAND --help` names stands in docs/command-line.md in a table for that
  command, and the reverse. (The man page and the completions are made from that page.)
"""
import os
import re
import subprocess
import sys

import command_docs

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LINK = re.compile(r"!?\[[^\]]*\]\(([^)#\s]+)[^)]*\)")
IMAGE = re.compile(r'<img[^>]*src="([^"]+)"')


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


def help_options(command, name):
    """Long option names in --help; what follows an option's own column is prose."""
    text = subprocess.run([command, name, "--help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^\s+(?:-\w,\s*)?(--[a-z][a-z0-9-]+)", text, re.M))


def differing_options(command):
    commands, options = command_docs.read_page(read("docs/command-line.md"))
    top = subprocess.run([command, "--help"], capture_output=True, text=True, check=True).stdout
    section = top.split("Commands:", 1)[-1].split("\n\n", 1)[0]
    existing = re.findall(r"^  (\w+) ", section, re.M)
    if sorted(existing) != sorted(commands):
        yield f"docs/command-line.md: commands {sorted(commands)}, but --help has {sorted(existing)}"
        return
    for name in commands:
        described = {option.long for option in options if name in option.commands}
        taken = help_options(command, name)
        yield from (f"docs/command-line.md: {o} of `catoptric {name}` is missing" for o in sorted(taken - described))
        yield from (f"docs/command-line.md: `catoptric {name}` takes no {o}" for o in sorted(described - taken))


def main():
    errors = list(broken_links())
    if len(sys.argv) > 1:
        errors += differing_options(sys.argv[1])
    print("\n".join(errors), file=sys.stderr, end="\n" if errors else "")
    print(f"docs: {len(errors)} errors")
    sys.exit(1 if errors else 0)


if __name__ == "__main__":
    main()
