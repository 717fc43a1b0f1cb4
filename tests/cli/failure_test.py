#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Failures of the world: exit code 1, one line, nothing left behind."""
import json
import os
import unittest

import support


class Failures(support.CommandTest):
    def render(self, source, *more):
        return ("render", source, "-o", "x.png", *support.SMALL, *more)

    def assert_nothing_left(self):
        self.assertEqual([n for n in os.listdir(self.folder) if n.startswith("x") or n.endswith(".tmp")], [])

    def test_scenes_that_cannot_be_read(self):
        os.mkdir(self.path("folder"))
        self.write("empty.glb", b"")
        self.write("text.glb", b"this is no glTF at all, only some text that goes on for a while")
        self.write("half.glb", support.make_glb(support.make_gltf())[:200])
        self.write("bad.gltf", b'{"asset": {"version": "2.0"}, ')
        for source in ("folder", "empty.glb", "text.glb", "half.glb", "bad.gltf", "/dev/null"):
            self.refuse(1, source.split("/")[-1], *self.render(source))
            self.refuse(1, source.split("/")[-1], "info", source)
        self.refuse(1, ("nowhere.glb", "no such file"), *self.render("nowhere.glb"))
        self.refuse(1, ("fendr", "did you mean 'fender'?"), *self.render("fendr"))
        self.refuse(1, "", *self.render("-"), stdin=b"nothing good")
        self.assert_nothing_left()

    def test_index_out_of_range_names_the_element(self):
        document = support.make_gltf()
        document["nodes"][0]["mesh"] = 77
        self.write("range.gltf", json.dumps(document).encode())
        done = self.refuse(1, "/nodes/0", "info", "range.gltf", "--json", "-")
        error = json.loads(done.stdout)["error"]
        self.assertTrue(error["pointer"].startswith("/nodes/0"), error)
        self.assertTrue(error["code"].startswith("gltf."), error)

    def test_required_extension_is_named(self):
        document = support.make_gltf()
        document["extensionsRequired"] = document["extensionsUsed"] = ["ACME_unheard_of"]
        self.write("extension.gltf", json.dumps(document).encode())
        self.refuse(1, "ACME_unheard_of", *self.render("extension.gltf"))

    def test_caps(self):
        self.refuse(1, "", *self.render("scene.gltf", "--max-memory", "10"))

    def test_names_that_are_not_there(self):
        self.refuse(1, ("camera", "'rear'", "front"), *self.render("scene.gltf", "--camera", "rear"))
        self.refuse(1, "'9'", *self.render("scene.gltf", "--camera", "9"))
        self.refuse(1, "nothing", *self.render("scene.gltf", "--reflector", "nothing"))
        self.refuse(1, "nothing", *self.render("scene.gltf", "--scene", "nothing"))
        self.refuse(1, "nonsense", "scenes", "nonsense", "-o", "d")
        self.refuse(1, "did you mean", "scenes", "fendr", "-o", "d")

    def test_surroundings_that_cannot_be_read(self):
        self.write("bad.hdr", b"#?RADIANCE\nnonsense")
        self.write("bad.exr", b"v/1\x01 and then nothing")
        for name in ("bad.hdr", "bad.exr", "missing.hdr", "scene.gltf"):
            self.refuse(1, name, *self.render("scene.gltf", "--environment", name))
        self.assert_nothing_left()

    def test_output_that_cannot_be_written(self):
        self.refuse(1, "nowhere/x.png", "render", "scene.gltf", "-o", "nowhere/x.png", *support.SMALL)
        self.refuse(1, "x.json", *self.render("scene.gltf"), "--json", "nowhere/x.json")
        self.refuse(1, "/dev/full", "render", "scene.gltf", "--aov", "x.exr", "-o", "/dev/full", *support.SMALL)
        self.refuse(1, "scene.gltf", "compare", "scene.gltf", "-o", "scene.gltf", *support.SMALL)
        self.refuse(1, "scene.gltf", "scenes", "-o", "scene.gltf/sub")

    def test_old_file_stays_when_the_new_one_cannot_be_made(self):
        self.write("x.png", b"old")
        self.refuse(1, "nothing", *self.render("scene.gltf", "--scene", "nothing"))
        self.assertEqual(self.read("x.png"), b"old")

    def test_a_driver_that_resets(self):
        os.mkdir(self.path("resets"))
        self.write("resets/renderer", b"")
        self.refuse(1, ("has reset the renderer's OpenGL context", "--size"), *self.render("scene.gltf"),
                    env={"CATOPTRIC_FAKE_GL_RESET": self.path("resets")})
        self.assert_nothing_left()

    def test_no_opengl(self):
        """One line with the remedy; ray tracing needs none of it."""
        without = {"__EGL_VENDOR_LIBRARY_FILENAMES": self.path("nowhere.json")}
        self.refuse(1, ("OpenGL 3.3", "libgl1-mesa-dri", "--method raytrace"), *self.render("scene.gltf"), env=without)
        self.assert_nothing_left()
        self.succeed("render", "scene.gltf", "-o", "a.png", "--method", "raytrace", *support.SMALL, env=without)

    def test_full_standard_output(self):
        with open("/dev/full", "wb") as full:
            for arguments in (("scenes",), ("info", "scene.gltf"), ("--help",), ("--version",),
                              ("info", "scene.gltf", "--json", "-")):
                self.refuse(1, "standard output", *arguments, stdout=full)


if __name__ == "__main__":
    unittest.main()
