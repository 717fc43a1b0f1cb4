#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""catoptric bake, and drawing from its files."""
import json
import os
import signal
import subprocess
import time
import unittest

import support

BOX = ("--box", "-0.1,1.0,2.2,0.2,1.3,2.4", "--counts", "2x2x2", "--rays", "64", "--depth", "3")
EYE = ("--eye", "0.06,1.15,2.3", "--target", "0,0.55,0", "--fov", "36", "--size", "96x72")


class Bake(support.CommandTest):
    scene = None  # the built-in scene as a file: making it takes longer than baking a corner of it

    def setUp(self):
        super().setUp()
        if Bake.scene is None:
            self.succeed("scenes", "columns", "-o", ".")
            Bake.scene = self.read("columns.glb")
        self.write("columns.glb", Bake.scene)

    def test_bake_info_and_render(self):
        self.succeed("bake", "columns.glb", "-o", "columns.bake", *BOX, "--json", "bake.json")
        locations = json.loads(self.read("bake.json"))["locations"]
        self.assertEqual(len(locations), 8)
        for location in locations:
            self.assertEqual(location["traces"], 1)
            self.assertGreater(location["rays"], 1000)
            self.assertGreaterEqual(location["mean_leaf_rays"], 1)
        self.assertFalse(os.path.exists(self.path("columns.bake.part")))
        self.assertIn("2x2x2 locations", self.succeed("info", "columns.bake").stdout.decode())
        self.assertEqual(self.json_of("info", "columns.bake")["baked"]["rays"], 64)
        self.succeed("render", "columns.glb", "-o", "a.png", "--method", "morphing", "--baked", "columns.bake", *EYE,
                     "--mapped-below", "0", "--json", "a.json")
        self.assertGreater(json.loads(self.read("a.json"))["counters"]["virtual_triangles"], 1000)

    def test_a_killed_bake_goes_on_to_the_same_bytes(self):
        counts = ("--box", "-0.1,1.0,2.2,0.2,1.3,2.4", "--counts", "5x4x3", "--rays", "96", "--depth", "3", "--quiet")
        self.succeed("bake", "columns.glb", "-o", "whole.bake", *counts)
        for delay in (0.3, 0.6, 0.9):
            bake = subprocess.Popen([support.CATOPTRIC, "bake", "columns.glb", "-o", "killed.bake", *counts],
                                    cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(delay)
            bake.send_signal(signal.SIGKILL)
            bake.wait()
        self.succeed("bake", "columns.glb", "-o", "killed.bake", *counts)
        self.assertTrue(self.read("whole.bake") == self.read("killed.bake"))

    def test_an_eye_outside_the_grid_sees_environment_maps_and_a_warning(self):
        self.succeed("bake", "columns.glb", "-o", "columns.bake", *BOX)
        outside = ("--eye", "0.06,1.15,2.6", *EYE[2:])
        done = self.succeed("render", "columns.glb", "-o", "a.png", "--method", "morphing", "--baked", "columns.bake",
                            "--mapped-below", "0", *outside)
        self.assertIn("outside the grid", done.stderr.decode())
        self.succeed("render", "columns.glb", "-o", "b.png", "--method", "environment", *outside)
        self.assertEqual(self.read("a.png"), self.read("b.png"))

    def test_files_that_do_not_fit_are_refused_in_one_line(self):
        self.succeed("bake", "columns.glb", "-o", "columns.bake", *BOX)
        self.write("other.bake", b"something else")
        self.write("short.bake", self.read("columns.bake")[:-5])
        draw = ("-o", "a.png", "--method", "morphing", "--baked")
        for name in ("other.bake", "short.bake"):
            self.refuse(1, name, "render", "columns.glb", *draw, name)
        self.refuse(1, "other mirrors", "render", "cylinder", *draw, "columns.bake")
        self.assertFalse(os.path.exists(self.path("a.png")))

    def test_wrong_boxes_and_counts(self):
        for words in (("--box", "0,0,0,1,1"), ("--box", "0,0,0,0,1,1"), ("--counts", "3x3"), ("--counts", "1x2x2"),
                      ("--counts", "2x2x2x2")):
            self.refuse(2, words[0], "bake", "columns.glb", "-o", "a.bake", *words)

    def test_counts_from_spacing_and_error(self):
        box = ("--box", "-0.1,1.0,2.2,0.2,1.3,2.4", "--rays", "16", "--depth", "1")
        for words, counts in ((("--spacing", "0.1"), [4, 4, 3]), (("--max-error", "0.1"), [4, 4, 3])):
            self.succeed("bake", "columns.glb", "-o", "a.bake", *box, *words)
            self.assertEqual(self.json_of("info", "a.bake")["baked"]["counts"], counts)
        self.refuse(2, "exclude", "bake", "columns.glb", "-o", "a.bake", "--counts", "2x2x2", "--spacing", "1")

    def test_hybrid_reflectors(self):
        morphing = ("render", "columns.glb", "-o", "a.png", "--method", "morphing", *EYE, "--json", "a.json")

        def triangles(*words):
            self.succeed(*morphing, *words)
            return json.loads(self.read("a.json"))["counters"]["virtual_triangles"]

        self.succeed("bake", "columns.glb", "-o", "columns.bake", *BOX, "--keep-static")
        self.assertIn("static objects", self.succeed("info", "columns.bake").stdout.decode())
        baked = ("--baked", "columns.bake")
        self.assertEqual(triangles(*baked, "--mapped-below", "100000"), 0)  # 96x72 pixels are fewer
        self.assertGreater(triangles(*baked, "--mapped-below", "100000", "--morphed", "sphere"), 1000)
        self.assertEqual(triangles(*baked, "--mapped", "sphere"), 0)
        self.refuse(1, "no reflector", *morphing, "--mapped", "ball")
        self.assertIn("by an environment map, by --mapped",
                      self.succeed("info", "columns.glb", "--mapped", "sphere").stdout.decode())
        self.succeed("bake", "columns.glb", "-o", "none.bake", *BOX, "--mapped", "sphere", "--json", "bake.json")
        self.assertEqual(json.loads(self.read("bake.json"))["locations"][0]["traces"], 0)
        self.assertEqual(self.json_of("info", "none.bake")["baked"]["mapped_reflectors"], 1)

    def test_only_a_file_is_written_to(self):
        os.mkfifo(self.path("pipe"))
        os.mkdir(self.path("folder"))
        for name in ("pipe", "folder"):
            self.refuse(1, (name, "no regular file"), "bake", "columns.glb", "-o", name, *BOX)
        self.refuse(2, "standard output", "bake", "columns.glb", "-o", "-", *BOX)
        self.assertEqual(sorted(os.listdir(self.folder)), ["columns.glb", "folder", "pipe", "scene.gltf"])


if __name__ == "__main__":
    unittest.main()
