#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every example of the documentation and of --help runs. The files they speak of are made first; pictures are made
small, which changes nothing in how the line is read."""
import os
import re
import shlex
import unittest

import motion_test
import support

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PAGES = ("docs/command-line.md", "docs/quick-start.md", "README.md")
EXAMPLE = re.compile(r"^(?: {2,}|\$ )?((?:build/release/)?catoptric (?:info|render|compare|bench|bake|scenes|--version)\b(?:[^|>#\n]|(?<=[#_])#|_#)*)",
                     re.M)
BUILT_IN = ("four-spheres", "cylinder", "fender", "polyhedra-and-sphere", "hall-of-mirrors", "drivers-view",
            "columns")
SMALLER = {"render": ("--size", "96x72"), "bench": ("--size", "96x72", "--repeat", "1"),
           "compare": ("--size", "96x72", "--repeat", "1")}


def examples_in(text):
    lines = [line for line in EXAMPLE.findall(text) if not re.search(r"SCENE|FILE|DIR|OPTIONS|NAME|\.\.\.", line)]
    return [shlex.split(line.strip())[1:] for line in lines]


class Examples(support.CommandTest):
    done = []  # the pages repeat some lines

    def run_example(self, words):
        # Making some of the built-in scenes takes many seconds. A file goes first, so a small one stands in for them.
        for word in words:
            if word in BUILT_IN and words[0] != "scenes":
                self.write(word, support.make_glb(support.make_gltf()))
        for word in words:  # somebody's own scene
            if word.endswith((".glb", ".gltf")) and not os.path.exists(self.path(word)):
                os.makedirs(os.path.dirname(self.path(word)), exist_ok=True)
                moves = "--frames" in words or "--time" in words
                self.write(word, support.make_glb(motion_test.make_moving() if moves else support.make_gltf()))
        if words in self.done:
            return
        self.done.append(words)
        smaller = [] if "--size" in words else list(SMALLER.get(words[0], ()))[:2]
        if words[0] in ("compare", "bench") and "--repeat" not in words:
            smaller += ["--repeat", "1"]
        done = self.run_command(*words, *smaller)
        # A limit meant for 960x720 may fail at this size: that is an answer, too.
        allowed = (0, 3) if words[0] == "compare" else (0,)
        self.assertIn(done.returncode, allowed, f"{words}: {done.stderr.decode()}")

    def test_examples_of_the_pages(self):
        found = 0
        for page in PAGES:
            if not os.path.exists(os.path.join(ROOT, page)):
                continue
            with open(os.path.join(ROOT, page), encoding="utf-8") as file:
                for words in examples_in(file.read()):
                    with self.subTest(page=page, line=" ".join(words)):
                        self.run_example(words)
                    found += 1
        self.assertGreaterEqual(found, 5)

    def test_examples_of_the_help(self):
        for command in ("info", "render", "compare", "bench", "bake", "scenes"):
            text = self.succeed(command, "--help").stdout.decode()
            examples = examples_in(text.split("Examples:")[1])
            self.assertGreaterEqual([words[0] for words in examples].count(command), 1 if command == "bake" else 2)
            for words in examples:
                with self.subTest(line=" ".join(words)):
                    self.run_example(words)


if __name__ == "__main__":
    unittest.main()
