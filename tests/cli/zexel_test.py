#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reference images of the zexel method in a file: taken once, refused where they do not fit. Exposures, marked."""
import json
import os
import unittest

import support

DRAW = ("--method", "zexel", "--zexel-size", "64", "--zexel-cache", "images.zexels", *support.SMALL)


class ZexelCache(support.CommandTest):
    def test_images_are_taken_once(self):
        pictures, captures = [], []
        for name in ("first", "second"):
            self.succeed("render", "scene.gltf", "-o", name + ".png", "--json", "data.json", *DRAW)
            pictures.append(self.read(name + ".png"))
            captures.append(json.loads(self.read("data.json"))["counters"]["zexel_captures"])
        self.assertEqual(pictures[0], pictures[1])
        self.assertEqual(captures, [2, 0])

    def test_files_that_do_not_fit_are_refused_in_one_line_and_left_alone(self):
        self.succeed("render", "scene.gltf", "-o", "whole.png", *DRAW)
        whole = self.read("images.zexels")
        self.write("other.gltf", json.dumps(support.make_gltf(color=(0.1, 0.8, 0.1))).encode())
        self.refuse(1, ["another scene"], "render", "other.gltf", "-o", "no.png", *DRAW)
        self.assertEqual(self.read("images.zexels"), whole)
        for says, data in (("damaged", whole[:5000] + b"damaged!" + whole[5008:]), ("not complete", whole[:-1]),
                           ("no file of reference images", b"picture"), ("format", whole[:8] + b"\7" + whole[9:])):
            self.write("images.zexels", data)
            self.refuse(1, [says, "images.zexels"], "render", "scene.gltf", "-o", "no.png", *DRAW)
            self.assertEqual(self.read("images.zexels"), data)
        self.assertFalse(os.path.exists(self.path("no.png")))

    def test_other_methods_refuse_it(self):
        self.refuse(2, ["--zexel-cache"], "render", "scene.gltf", "-o", "no.png", "--zexel-cache", "images.zexels")

    def test_as_many_pixels_are_marked_as_no_zexel_reached(self):
        self.succeed("render", "checker-box", "-o", "marked.png", "--method", "zexel", "--zexel-mark", "--zexel-splat", "point",
                     "--zexel-references", "1", "--zexel-size", "128", "--size", "120x90", "--json", "data.json")
        counters = json.loads(self.read("data.json"))["counters"]
        width, _, channels, rows = support.read_png(self.read("marked.png"))
        pixels = [row[channels * x:channels * x + 3] for row in rows for x in range(width)]
        marked = sum(red > 140 and green < 100 and blue > 140 for red, green, blue in pixels)
        self.assertEqual(marked, counters["uncovered_pixels"])
        self.assertGreater(marked, 50)


if __name__ == "__main__":
    unittest.main()
