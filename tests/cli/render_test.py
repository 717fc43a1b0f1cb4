#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""catoptric render: formats, channels, cameras, methods, the same bytes on two runs."""
import json
import os
import unittest

import support

METHODS = (("none",), ("environment",), ("environment", "--plain-environment-map"), ("virtual",),
           ("virtual", "--solver", "explosion"), ("virtual", "--solver", "layered"),
           ("virtual", "--solver", "analytic"), ("virtual", "--solver", "subdivision"),
           ("virtual", "--solver", "refined"), ("virtual", "--solver", "exact"), ("raytrace",), ("auto",))
CHANNELS = {**{c: 2 for c in ("R", "G", "B", "A", "seen.X", "seen.Y", "seen.Z", "pathLength")},
            **{c: 0 for c in ("object.id", "triangle.id", "reflector.id", "bounces")}}


class Render(support.CommandTest):
    def picture(self, *more, source="scene.gltf", stdin=None):
        """Rows of an RGB(A) picture of 64x48."""
        self.succeed("render", source, "-o", "picture.png", *support.SMALL, *more, stdin=stdin)
        return support.read_png(self.read("picture.png"))

    @staticmethod
    def redness(picture, x, y):
        _, _, channels, rows = picture
        red, green = rows[y][x * channels], rows[y][x * channels + 1]
        return int(red) - int(green)

    def test_formats_by_extension(self):
        for name, magic in (("a.png", b"\x89PNG"), ("a.PNG", b"\x89PNG"), ("a.jpg", b"\xff\xd8\xff"),
                            ("a.jpeg", b"\xff\xd8\xff"), ("a.exr", b"\x76\x2f\x31\x01")):
            done = self.succeed("render", "scene.gltf", "-o", name, *support.SMALL)
            self.assertTrue(self.read(name).startswith(magic), name)
            self.assertEqual(done.stdout, b"")
            self.assertIn(f"wrote {name}", done.stderr.decode())
        width, height, _, _ = support.read_png(self.read("a.png"))
        self.assertEqual((width, height), (64, 48))
        self.assertEqual(set(support.exr_channels(self.read("a.exr"))), set("RGBA"))

    def test_quiet_is_quiet(self):
        done = self.succeed("render", "scene.gltf", "-o", "a.png", "--quiet", *support.SMALL)
        self.assertEqual(done.stdout + done.stderr, b"")

    def test_every_method_writes_what_is_seen_and_the_same_bytes_on_two_runs(self):
        for method in METHODS:
            files = []
            for name in ("a", "b"):
                self.succeed("render", "scene.gltf", "-o", name + ".png", "--aov", name + ".exr", "--method", *method,
                             "--size", "160x120")
                files.append([self.read(name + end) for end in (".png", ".exr")])
            self.assertEqual(files[0], files[1], method)
            self.assertEqual(support.exr_channels(files[0][1]), CHANNELS, method)
            self.assertEqual(support.read_png(files[0][0])[:2], (160, 120))

    def test_radiance_is_the_same_bytes_on_two_runs(self):
        for method in ("virtual", "raytrace"):
            files = []
            for name in ("a.exr", "b.exr"):
                self.succeed("render", "scene.gltf", "-o", name, "--method", method, "--size", "160x120")
                files.append(self.read(name))
            self.assertEqual(files[0], files[1], method)

    def test_the_mirror_shows_the_back_of_the_board(self):
        """The board stands in front of the mirror, to the upper right; its image is nearer to the middle."""
        for method in ("virtual", "raytrace"):
            with_mirror = self.picture("--method", method)
            without = self.picture("--method", "none")
            board = self.redness(with_mirror, 48, 17)
            self.assertGreater(board, 60, method)
            image = [(x, y) for y in range(48) for x in range(64)
                     if self.redness(with_mirror, x, y) > 60 and self.redness(without, x, y) < 20]
            self.assertGreater(len(image), 5, method)

    def test_scene_from_standard_input_and_picture_to_standard_output(self):
        glb = support.make_glb(support.make_gltf())
        piped = self.succeed("render", "-", "-o", "-", *support.SMALL, stdin=glb).stdout
        self.succeed("render", "scene.gltf", "-o", "a.png", *support.SMALL)
        self.assertEqual(piped, self.read("a.png"))

    def test_a_file_goes_before_the_built_in_scene_of_its_name(self):
        self.write("fender", support.make_glb(support.make_gltf()))
        document = self.json_of("render", "fender", "-o", "a.png", *support.SMALL)
        self.assertFalse(document["scene"]["built_in"])
        document = self.json_of("render", "checker-box", "-o", "a.png", *support.SMALL)
        self.assertTrue(document["scene"]["built_in"])

    def test_cameras(self):
        def camera(*more):
            return self.json_of("render", "scene.gltf", "-o", "a.png", *support.SMALL, *more)["camera"]

        self.assertEqual(camera()["name"], "front")
        self.assertEqual(camera("--camera", "side")["eye"], [1, 0, 4])
        self.assertEqual(camera("--camera", "1"), camera("--camera", "side"))
        self.assertAlmostEqual(camera("--fov", "30")["fov_degrees"], 30)
        free = camera("--eye", "-1,2,5", "--target=-1,2,0", "--fov", "60")
        self.assertEqual((free["eye"], free["target"]), ([-1, 2, 5], [-1, 2, 0]))
        above = camera("--elevation", "90", "--azimuth", "0")
        self.assertGreater(above["eye"][1], 1)
        self.assertAlmostEqual(above["eye"][0], above["target"][0])
        document = support.make_gltf()
        document["scenes"][0]["nodes"] = [0, 1]
        self.write("no-camera.gltf", json.dumps(document).encode())
        done = self.json_of("render", "no-camera.gltf", "-o", "a.png", *support.SMALL)
        self.assertEqual(done["camera"]["name"], "frame-all")

    def test_json_says_what_was_done(self):
        document = self.json_of("render", "scene.gltf", "-o", "a.png", "--aov", "b.exr", "--method", "virtual",
                                "--bounces", "2", "--samples", "4", *support.SMALL)
        self.assertEqual((document["method"], document["bounces"], document["samples"]), ("virtual", 2, 4))
        self.assertEqual((document["width"], document["height"]), (64, 48))
        self.assertEqual(document["files"], {"picture": "a.png", "aov": "b.exr"})
        self.assertGreater(document["timings"]["total_ms"], 0)
        self.assertEqual(document["scene"]["reflectors"], 1)
        for key in ("version", "commit", "gl_renderer", "embree", "threads"):
            self.assertIn(key, document["environment"])
        self.assertNotIn("not available", document["environment"]["gl_renderer"])
        self.succeed("render", "scene.gltf", "-o", "a.png", "--json", "done.json", *support.SMALL)
        self.assertEqual(json.loads(self.read("done.json"))["command"], "render")

    def test_reflectors_can_be_chosen(self):
        rough = support.make_gltf(mirror_roughness=0.2)
        self.write("rough.gltf", json.dumps(rough).encode())

        def count(source, *more):
            document = self.json_of("render", source, "-o", "a.png", *support.SMALL, *more)
            return document["scene"]["reflectors"]

        self.assertEqual(count("scene.gltf"), 1)
        self.assertEqual(count("scene.gltf", "--reflector", "Mirror"), 1)
        self.assertEqual(count("scene.gltf", "--no-reflectors"), 0)
        self.assertEqual(count("rough.gltf"), 0)
        self.assertEqual(count("rough.gltf", "--reflector-roughness", "0.3"), 1)
        self.assertEqual(count("scene.gltf", "--reflector-metallic", "1"), 1)

    def test_surroundings_and_exposure(self):
        # A flat Radiance picture: 8x4 pixels of pure red, one run of four bytes each.
        header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n"
        self.write("red.hdr", header + bytes((128, 0, 0, 129)) * 32)
        red = self.picture("--environment", "red.hdr", "--method", "none")
        self.assertGreater(self.redness(red, 1, 1), 100)
        dark = self.picture("--environment", "red.hdr", "--method", "none", "--exposure", "0.05")
        self.assertLess(self.redness(dark, 1, 1), self.redness(red, 1, 1) - 50)

    def test_smallest_picture_and_one_thread(self):
        for method in ("virtual", "raytrace"):
            self.succeed("render", "scene.gltf", "-o", "dot.png", "--size", "1x1", "--threads", "1", "--method", method)
            self.assertEqual(support.read_png(self.read("dot.png"))[:2], (1, 1))

    def test_warnings_go_to_stderr_and_into_the_document(self):
        document = support.make_gltf()
        document["extensionsUsed"] = ["ACME_unheard_of"]
        document["nodes"][1]["extensions"] = {"ACME_unheard_of": {}}
        self.write("extension.gltf", json.dumps(document).encode())
        done = self.succeed("render", "extension.gltf", "-o", "a.png", "--json", "-", *support.SMALL)
        self.assertIn("ACME_unheard_of", done.stderr.decode())
        self.assertIn("ACME_unheard_of", " ".join(json.loads(done.stdout)["scene"]["warnings"]))
        self.assertNotIn("ACME", self.succeed("render", "extension.gltf", "-o", "a.png", "--quiet",
                                              *support.SMALL).stderr.decode())

    def test_nothing_but_the_outputs_is_left(self):
        self.succeed("render", "scene.gltf", "-o", "a.png", "--aov", "a.exr", *support.SMALL)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.exr", "a.png", "scene.gltf"])


if __name__ == "__main__":
    unittest.main()
