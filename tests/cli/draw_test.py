#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""catoptric draw: every drawing is made, says what it must, and refuses what it cannot do."""
import json
import os
import unittest

import support

# Each takes a second or two, most of it for the scene; those left out share all but a few lines with one that is here.
CURVED = ("explosion-maps", "subdivision", "mapping", "look-up", "cell", "camera-rays", "ray-octree", "reflection-mesh")
FLAT = ("reflection-cell", "mapped-rays", "zexels", "exposures")


class Draw(support.CommandTest):
    def draw(self, scene, what, *words):
        self.succeed("draw", scene, "-o", f"{what}.png", "--show", what, "--size", "64x48", "--json", "facts.json", *words)
        self.assertEqual(json.loads(self.read("facts.json"))["show"], what)
        width, height, _, rows = support.read_png(self.read(f"{what}.png"))
        self.assertGreater(len(set(bytes(b"".join(rows)))), 8, f"{what} is empty")
        return width, height, json.loads(self.read("facts.json"))["facts"]

    def test_structures_of_a_curved_mirror(self):
        for what in CURVED:
            width, height, _ = self.draw("columns", what)
            if what != "explosion-maps":
                self.assertEqual((width, height), (64, 48), what)

    def test_structures_of_a_flat_mirror(self):
        for what in FLAT:
            zexels = ("--zexel-size", "64", "--zexel-hemisphere", "16") if what in ("zexels", "exposures") else ()
            self.assertEqual(self.draw("checker-box", what, *zexels)[:2], (64, 48))

    def test_exposures_are_the_pixels_that_the_method_counts_as_uncovered(self):
        # 512 zexels on few pixels: a 3x3 splat reaches many zexels far, and must still show its zexel.
        for splat in ("point", "square"):
            facts = self.draw("checker-box", "exposures", "--zexel-splat", splat, "--zexel-references", "1")[2]
            self.assertEqual(facts["exposures"], facts["uncovered_pixels"], splat)
            self.assertGreater(facts["zexel_pixels"], 10 * facts["exposures"])
            self.assertTrue(facts["exposures"] > 0 or splat != "point")

    def test_one_object_alone(self):
        whole, cube = (self.draw("columns", "virtual-object", *words)[2]["virtual_triangles"] for words in ((), ("--object", "cube")))
        self.assertGreater(whole, cube)
        self.assertGreater(cube, 0)
        self.refuse(1, "has no object 'no such thing'", "draw", "columns", "-o", "a.png", "--show", "virtual-object",
                    "--object", "no such thing")

    def test_what_cannot_be_drawn_is_refused(self):
        self.refuse(1, "no curved mirror", "draw", "checker-box", "-o", "a.png", "--show", "cell")
        self.refuse(1, "no flat mirror", "draw", "columns", "-o", "a.png", "--show", "zexels")
        self.refuse(2, "there is no 'nothing'", "draw", "columns", "-o", "a.png", "--show", "nothing")
        self.refuse(2, "what to draw is missing", "draw", "columns", "-o", "a.png")
        for what, option, value in (("explosion-maps", "--samples", "4"), ("mapping", "--point", "0,0,0"), ("cell", "--object", "cube"),
                                    ("look-up", "--from", "1,2,3"), ("cell", "--bounces", "2"), ("sampling-cell", "--width", "2"),
                                    ("look-up", "--zexel-size", "64"), ("camera-rays", "--max-error", "2")):
            self.refuse(2, (option[:7], f"--show {what} has no use for it"), "draw", "columns", "-o", "a.png", "--show", what, option, value)
        self.refuse(2, "no radiance", "draw", "columns", "-o", "a.exr", "--show", "cell")
        self.assertFalse(os.path.exists(self.path("a.png")))


if __name__ == "__main__":
    unittest.main()
