#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""catoptric info and catoptric scenes."""
import json
import os
import re
import unittest

import support

BUILT_IN = {"four-spheres", "cylinder", "fender", "polyhedra-and-sphere", "checker-box", "hall-of-mirrors",
            "drivers-view", "concave-bowl", "mask", "mixed", "tv", "cone", "vase", "wavy-wall",
            "lenses", "columns", "teapot", "facing-mirrors", "dome", "reflector-sweep", "object-sweep"}


class Info(support.CommandTest):
    def test_table(self):
        text = self.succeed("info", "scene.gltf").stdout.decode()
        self.assertIn("4 triangles", text)
        self.assertIn('camera 0 "front"', text)
        row = next(line for line in text.splitlines() if line.startswith("Mirror "))
        self.assertIn("plane", row)
        self.assertRegex(text, r"Mirror: a mirror by .*; \S+ because \S+")

    def test_no_reflectors_says_what_would_be_one(self):
        self.assertIn("no reflectors", self.succeed("info", "scene.gltf", "--no-reflectors").stdout.decode())

    def test_json(self):
        document = self.json_of("info", "scene.gltf")
        self.assertEqual((document["objects"], document["meshes"], document["triangles"]), (2, 2, 4))
        self.assertEqual([c["name"] for c in document["cameras"]], ["front", "side"])
        mirror, = document["reflectors"]
        self.assertEqual((mirror["name"], mirror["shape"], mirror["material"]), ("Mirror", "plane", "silver"))
        self.assertAlmostEqual(mirror["area"], 4)
        self.assertEqual(mirror["fit_error"], 0)
        self.assertTrue(mirror["reason"])
        self.assertTrue(mirror["auto"]["reason"])

    def test_ways_of_drawing_a_mirror(self):
        """What auto expects of each, and that the bound has a say."""
        def ask(*options):
            mirror, = self.json_of("info", "fender", "--size", "240x180", *options)["reflectors"]
            return mirror["auto"]
        strict, lenient = ask(), ask("--max-error", "1000")
        ways = [(way["method"], way["solver"]) for way in strict["candidates"]]
        self.assertEqual(ways, [("environment", "auto"), ("virtual", "refined"), ("virtual", "exact")])
        for way in strict["candidates"]:
            self.assertGreater(way["expected_ms"], 0)
        self.assertLess(max(way["expected_error_px"] for way in strict["candidates"][1:]), 0.5)
        self.assertEqual((strict["method"], lenient["method"]), ("virtual", "environment"))
        text = self.succeed("info", "fender", "--size", "240x180").stdout.decode()
        self.assertRegex(text, r"(?m)^reflector +pixels +way +expected error px +expected ms +picked$")
        self.assertEqual(len(re.findall(r"(?m)^fender .* yes$", text)), 1)

    def test_names_cannot_write_to_the_terminal(self):
        document = support.make_gltf()
        document["nodes"][0]["name"] = "Mirror\x1b[31m\nred"
        document["nodes"][2]["name"] = document["cameras"][0]["name"] = "cam\x1b]0;title\x07"
        self.write("evil.gltf", json.dumps(document).encode())
        done = self.succeed("info", "evil.gltf")
        self.assertNotIn(b"\x1b", done.stdout + done.stderr)
        self.assertIn("\x1b[31m", self.json_of("info", "evil.gltf")["reflectors"][0]["name"])


class Scenes(support.CommandTest):
    def test_list(self):
        lines = self.succeed("scenes").stdout.decode().splitlines()
        self.assertLessEqual(BUILT_IN, {line.split()[0] for line in lines})
        for line in lines:
            self.assertGreater(len(line.split()), 3)
        document = self.json_of("scenes")
        self.assertEqual([row["name"] for row in document["results"]], [line.split()[0] for line in lines])

    def test_write_one(self):
        self.succeed("scenes", "checker-box", "-o", "one/deeper")
        self.assertEqual(os.listdir(self.path("one", "deeper")), ["checker-box.glb"])
        self.succeed("scenes", "checker-box", "-o", "again", "--quiet")
        self.assertEqual(self.read("one", "deeper", "checker-box.glb"), self.read("again", "checker-box.glb"))

    def test_an_unknown_name_leaves_nothing_behind(self):
        self.refuse(1, ('"no-such"', "four-spheres"), "scenes", "no-such", "-o", "folder")
        self.assertFalse(os.path.exists(self.path("folder")))

    def test_write_all(self):
        """Making them takes its time, so what they hold is looked at here, too."""
        document = self.json_of("scenes", "-o", "all")
        self.assertLessEqual({name + ".glb" for name in BUILT_IN}, set(os.listdir(self.path("all"))))
        shapes = {}
        for row in document["results"]:
            self.assertEqual(self.read(row["file"])[:4], b"glTF")
            scene = self.json_of("info", row["file"])
            self.assertEqual(scene["warnings"], [], row["name"])
            self.assertGreater(len(scene["reflectors"]), 0, row["name"])
            self.assertGreater(len(scene["cameras"]), 0, row["name"])
            shapes[row["name"]] = {reflector["shape"] for reflector in scene["reflectors"]}
        self.assertIn("sphere", shapes["four-spheres"])
        self.assertIn("cylinder", shapes["cylinder"])
        self.assertEqual(shapes["checker-box"], {"plane"})
        self.assertEqual(shapes["hall-of-mirrors"], {"plane"})
        self.assertEqual(shapes["fender"], {"mesh"})
        self.assertEqual(shapes["concave-bowl"], {"sphere"})
        self.assertEqual(shapes["cone"], {"cone"})
        self.assertEqual(shapes["dome"], {"aspheric", "torus"})


if __name__ == "__main__":
    unittest.main()
