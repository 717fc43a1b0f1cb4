#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scenes that move: --time, --animation, sequences of frames."""
import base64
import json
import os
import struct
import unittest

import support


def make_moving():
    """The scene of support.py with a board that slides by 1.2 m to the left in two seconds."""
    document = support.make_gltf()
    data = base64.b64decode(document["buffers"][0]["uri"].split(",")[1])
    data += struct.pack("<2f", 0, 2) + struct.pack("<6f", 0.6, 0.3, 1.0, -0.6, 0.3, 1.0)
    document["buffers"] = [{"byteLength": len(data),
                            "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]
    document["bufferViews"] += [{"buffer": 0, "byteOffset": 60, "byteLength": 8},
                                {"buffer": 0, "byteOffset": 68, "byteLength": 24}]
    document["accessors"] += [
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2]},
        {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}]
    document["animations"] = [{"name": "slide", "samplers": [{"input": 2, "output": 3}],
                               "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}]
    return document


class Motion(support.CommandTest):
    def setUp(self):
        super().setUp()
        self.write("moving.gltf", json.dumps(make_moving()).encode())

    def test_info_lists_them(self):
        self.assertIn('animation 0 "slide", 2 s', self.succeed("info", "moving.gltf").stdout.decode())
        self.assertEqual(self.json_of("info", "moving.gltf")["animations"], [{"name": "slide", "duration_s": 2}])

    def test_a_time_between_the_key_frames(self):
        self.succeed("render", "moving.gltf", "-o", "rest.png", *support.SMALL)
        self.succeed("render", "moving.gltf", "-o", "0.png", "--time", "0", *support.SMALL)
        self.assertEqual(self.read("rest.png"), self.read("0.png"))
        for method in ("virtual", "raytrace"):
            self.succeed("render", "moving.gltf", "-o", "1.png", "--time", "1", "--method", method, *support.SMALL)
            _, _, channels, rows = support.read_png(self.read("1.png"))
            # The board stands above the middle, and so does its image in the mirror.
            row = rows[17]
            self.assertGreater(int(row[32 * channels]) - int(row[32 * channels + 1]), 60, method)
            self.assertLess(int(row[48 * channels]) - int(row[48 * channels + 1]), 20, method)

    def test_morphing_keeps_what_stands_still(self):
        words = ("--method", "morphing", "--mapped-below", "0", "--bounces", "1", "--size", "96x72", "--json", "a.json")
        self.succeed("render", "facing-mirrors", "-o", "out_#.png", "--frames", "3", "--fps", "2", *words)
        frames = json.loads(self.read("a.json"))["frames"]
        self.succeed("render", "facing-mirrors", "-o", "one.png", "--time", "1", *words)
        self.assertEqual(self.read("out_2.png"), self.read("one.png"))
        self.assertNotEqual(self.read("out_0.png"), self.read("one.png"))
        looked_up = [frame["counters"]["looked_up_vertices"] for frame in frames]
        # What moves is known from the second frame on.
        self.assertLess(looked_up[2], looked_up[0] / 5)
        self.assertGreater(looked_up[2], 0)

    def test_a_sequence_shows_what_single_pictures_show(self):
        for method in (("--method", "auto"), ("--solver", "exact"), ("--method", "zexel"), ("--method", "environment"),
                       ("--method", "raytrace")):
            document = self.json_of("render", "moving.gltf", "-o", "out_####.png", "--frames", "3", "--fps", "1", *method,
                                    *support.SMALL)
            self.assertEqual([frame["time_s"] for frame in document["frames"]], [0, 1, 2])
            self.assertEqual([frame["files"]["picture"] for frame in document["frames"]],
                             ["out_0000.png", "out_0001.png", "out_0002.png"])
            for i in range(3):
                self.succeed("render", "moving.gltf", "-o", "one.png", "--time", str(i), *method, *support.SMALL)
                self.assertEqual(self.read("one.png"), self.read(f"out_{i:04}.png"), (method, i))
            self.assertNotEqual(self.read("out_0000.png"), self.read("out_0002.png"), method)

    def test_wrong_use(self):
        self.refuse(2, "out_####.png", "render", "moving.gltf", "-o", "a.png", "--frames", "2", *support.SMALL)
        self.refuse(2, "standard output", "render", "moving.gltf", "-o", "-", "--frames", "2", *support.SMALL)
        self.refuse(2, "--time", "render", "moving.gltf", "-o", "a.png", "--time", "soon", *support.SMALL)
        self.refuse(1, "no animations", "render", "scene.gltf", "-o", "a.png", "--time", "1", *support.SMALL)
        self.refuse(1, ("walk", "slide"), "render", "moving.gltf", "-o", "a.png", "--animation", "walk", *support.SMALL)
        self.assertEqual(sorted(os.listdir(self.folder)), ["moving.gltf", "scene.gltf"])


if __name__ == "__main__":
    unittest.main()
