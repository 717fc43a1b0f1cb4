#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The viewer as a person meets it: a real window, keys, mouse, screenshots; and every way in which it may end."""
import json
import os
import random
import shlex
import unittest

import motion_test
import support
import window_support

NO_DISPLAY = {"DISPLAY": "", "WAYLAND_DISPLAY": ""}
SETTLED = "settled: "
INPUTS = int(os.environ.get("CATOPTRIC_VIEW_INPUTS", "60"))


class WithoutDisplay(support.CommandTest):
    def test_one_clear_error_with_the_remedy(self):
        self.refuse(1, ("no window can be opened", "catoptric render"), "view", "scene.gltf", env=NO_DISPLAY)

    def test_a_file_alone_is_viewed(self):
        self.refuse(1, "no window can be opened", "scene.gltf", env=NO_DISPLAY)
        self.refuse(1, "no window can be opened", "./scene.gltf", env=NO_DISPLAY)

    def test_what_is_wrong_is_said_before_a_window_is_sought(self):
        self.refuse(1, "no such file", "view", "missing.gltf", env=NO_DISPLAY)
        self.refuse(2, "--watch", "view", "-", "--watch", env=NO_DISPLAY)
        os.mkdir(self.path("empty"))
        self.refuse(1, "empty", "view", "empty", env=NO_DISPLAY)

    def test_other_commands_need_none(self):
        for display in (NO_DISPLAY, {"DISPLAY": ":987"}):
            self.succeed("render", "scene.gltf", "-o", "x.png", *support.SMALL, env=display)


class WindowTest(support.CommandTest):
    """On a display of its own."""

    @classmethod
    def setUpClass(cls):
        cls.server = window_support.Display()
        cls.display = cls.server.__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.server.__exit__()

    def view(self, *arguments):
        viewer = window_support.Viewer(self.folder, self.display, *arguments)
        self.addCleanup(viewer.kill)
        return viewer

    def screenshot(self, viewer, number):
        viewer.after("wrote ", lambda: viewer.do("key", "F12"))
        return support.read_png(self.read(f"scene-{number:04}.png"))

    def close(self, viewer):
        viewer.do("key", "ctrl+q")
        self.assertEqual(viewer.end(), 0, viewer.said())
        self.assertNotIn("error", viewer.said())


class WithDisplay(WindowTest):
    def test_session(self):
        viewer = self.view("scene.gltf", "--size", "320x240", "--camera", "front")
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        first = self.screenshot(viewer, 1)
        self.assertEqual(first[:2], (320, 240))

        # The copied command draws the same picture.
        viewer.do("key", "ctrl+c")
        window_support.wait_for(lambda: viewer.read(viewer.output), "command line")
        words = shlex.split(viewer.read(viewer.output))
        self.assertEqual(words[:2], ["catoptric", "render"])
        self.assertIn(b"Description\0" + viewer.read(viewer.output).strip().encode(), self.read("scene-0001.png"))
        self.succeed(*words[1:])
        self.assertEqual(support.read_png(self.read("picture.png")), first)

        # Without the panels, which fill a window this small, the mouse moves the camera; R brings it back.
        viewer.do("key", "p")
        viewer.after(SETTLED, lambda: viewer.drag((300, 200), (250, 180)))
        self.assertNotEqual(self.screenshot(viewer, 2), first)
        viewer.after(SETTLED, lambda: viewer.do("key", "r"))
        self.assertEqual(self.screenshot(viewer, 3), first)

        # The next method, and the one before; the split line shows the truth.
        viewer.after(SETTLED + "none", lambda: viewer.do("key", "m"))
        none = self.screenshot(viewer, 4)
        self.assertNotEqual(none, first)
        viewer.after("truth: pass 3", lambda: viewer.do("key", "s"))
        split = self.screenshot(viewer, 5)
        self.assertEqual([row[:150 * 3] for row in split[3]], [row[:150 * 3] for row in none[3]])
        self.assertNotEqual(split, none)
        viewer.drag((160, 120), (310, 120))
        dragged = self.screenshot(viewer, 6)
        self.assertEqual([row[:300 * 3] for row in dragged[3]], [row[:300 * 3] for row in none[3]])
        viewer.do("key", "d")
        self.assertNotEqual(self.screenshot(viewer, 7), dragged)
        self.close(viewer)

    def test_broken_scenes_end_it_at_the_start_and_are_survived_later(self):
        self.write("broken.gltf", b"{")
        viewer = self.view("broken.gltf")
        self.assertEqual(viewer.end(), 1)
        self.assertEqual(viewer.count("catoptric: error: "), 1, viewer.said())

        viewer = self.view("scene.gltf", "--watch", "--size", "320x240")
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        self.write("scene.gltf", b"{")
        viewer.after(SETTLED, self.write_another_scene)
        self.close(viewer)

    def write_another_scene(self):
        text = json.dumps(support.make_gltf(color=(0.1, 0.1, 0.9))).encode()
        os.utime(self.path(self.write("scene.gltf", text)), (2e9, 2e9))

    def test_closed_while_it_loads(self):
        viewer = self.view("-", "--size", "320x240")  # loading lasts as long as standard input does
        viewer.wait_for_window()
        viewer.do("key", "Escape")
        window_support.wait_for(lambda: not viewer.find_windows(), "end of the window")
        self.assertIsNone(viewer.process.poll())
        viewer.process.stdin.close()
        self.assertEqual(viewer.end(), 0, viewer.said())
        self.assertEqual(viewer.count("first "), 0)

    def test_closed_while_it_bakes_and_traces(self):
        viewer = self.view("scene.gltf", "--size", "320x240", "--method", "morphing")
        viewer.wait_for_window()
        window_support.wait_for(lambda: viewer.count("reflectors"), "scene")  # rays are traced from now on
        self.close(viewer)
        viewer = self.view("scene.gltf", "--size", "320x240")
        viewer.wait_for_window()
        viewer.after("truth: pass 1", lambda: viewer.do("key", "s"))
        self.close(viewer)

    def test_the_truth_is_shown_until_shaders_are_compiled(self):
        os.environ["MESA_SHADER_CACHE_DISABLE"] = "true"  # as on the first day
        self.addCleanup(os.environ.pop, "MESA_SHADER_CACHE_DISABLE", None)
        viewer = self.view("scene.gltf", "--size", "320x240")
        viewer.wait_for_window()
        viewer.wait_for_line("first picture, ray-traced, after")
        viewer.drag((300, 200), (250, 180))  # the eye moves all the same
        viewer.wait_for_line(SETTLED)
        said = viewer.said()
        self.assertEqual(viewer.count("first "), 3)
        self.assertLess(said.index("first picture, ray-traced,"), said.index("first frame after"))
        self.close(viewer)

    def test_no_opengl(self):
        os.environ["MESA_GL_VERSION_OVERRIDE"] = "2.1"
        self.addCleanup(os.environ.pop, "MESA_GL_VERSION_OVERRIDE", None)
        viewer = self.view("scene.gltf")
        self.assertEqual(viewer.end(), 1, viewer.said())
        self.assertEqual(viewer.count("catoptric: error: no window can be opened: it needs OpenGL 3.3"), 1, viewer.said())

    def test_random_inputs(self):
        chance = random.Random(6)
        self.write("scene.gltf", json.dumps(motion_test.make_moving()).encode())
        viewer = self.view("scene.gltf", "--size", "320x240")
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        keys = ("m shift+m s d h f r 1 3 7 bracketleft bracketright p i Prior Next x space ctrl+z ctrl+shift+z ctrl+y "
                "shift+F12 ctrl+c").split()
        for _ in range(INPUTS):
            kind = chance.randrange(5)
            x, y = chance.randrange(320), chance.randrange(240)
            if kind == 0:
                viewer.do("mousemove", x, y, "click", chance.choice((1, 2, 3, 4, 5)))
            elif kind == 1:
                viewer.do("mousemove", x, y, "mousedown", chance.choice((1, 2)), "mousemove_relative", "--",
                          chance.randrange(-50, 50), chance.randrange(-50, 50), "mouseup", 1, "mouseup", 2)
            elif kind == 2:
                viewer.do("keydown", "ctrl", "mousemove", x, y, "mousedown", 1, "mousemove_relative", "--",
                          chance.randrange(-50, 50), chance.randrange(-50, 50), "mouseup", 1, "keyup", "ctrl")
            else:
                viewer.do("key", chance.choice(keys))
        self.assertIsNone(viewer.process.poll(), viewer.said())
        self.close(viewer)
        self.assertNotIn("failed: ", viewer.said())  # with CATOPTRIC_GL_DEBUG any error of OpenGL is one


if __name__ == "__main__":
    window_support.skip_without_tools()
    unittest.main()
