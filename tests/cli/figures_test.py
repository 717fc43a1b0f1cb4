#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`make figures`: no figure of the papers is forgotten, one is made whole, and what it says follows from what was measured."""
import os
import subprocess
import sys
import unittest

import support

SCRIPTS = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "scripts", "figures")
sys.path.insert(0, SCRIPTS)
import checklist  # noqa: E402
import page  # noqa: E402


class Figures(support.CommandTest):
    def make(self, *words):
        return subprocess.run([sys.executable, "-B", SCRIPTS, support.CATOPTRIC, self.path("pages"), "--size", "96x72", *words],
                              capture_output=True, text=True, timeout=300, check=False)

    def test_every_figure_of_the_list_has_something_that_makes_it(self):
        for paper in checklist.PAPERS:
            self.assertEqual(sorted(checklist.WANTED[paper.key]), sorted(paper.figures), paper.title)

    def test_a_figure_is_made_with_its_pictures(self):
        done = self.make("--only", "1998-18")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = self.read("pages", "1998-ofek-rappoport.md").decode()
        self.assertIn("catoptric compare hall-of-mirrors", text)
        self.assertIn("- **seen**: recursive reflections in flat mirrors", text)
        for name in ("virtual-refined", "raytrace", "virtual-refined-error"):
            self.assertIn(f"(images/1998-18-{name}.jpg)", text)
            self.assertEqual(self.read("pages", "images", f"1998-18-{name}.jpg")[:2], b"\xff\xd8")
        self.assertIn("1998: Interactive reflections", self.read("pages", "README.md").decode())

    def test_a_figure_that_is_not_there_is_refused(self):
        done = self.make("--only", "1998-99")
        self.assertEqual(done.returncode, 1)
        self.assertIn("no figure 1998-99", done.stderr)

    def test_a_verdict_follows_from_the_figures(self):
        section = page.Section("title", "what it shows")
        section.claim("two is more than one:", 2 > 1, "by one.")
        section.claim("one is more than two:", 1 > 2, "by none.")
        self.assertIn("**seen**: two is more than one: by one.", section.markdown([]))
        self.assertIn("**not seen**: one is more than two: by none.", section.markdown([]))


if __name__ == "__main__":
    unittest.main()
