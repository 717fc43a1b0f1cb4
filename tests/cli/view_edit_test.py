#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The viewer changes scenes: objects are dragged, edits undone, time plays, frames are recorded, sessions return."""
import json
import os
import unittest

import motion_test
import support
import window_support
from view_test import NO_DISPLAY, SETTLED, WindowTest

SESSION = "scene-0001.session.json"


class Sessions(support.CommandTest):
    def refuse_session(self, change, says):
        session = {"schema": 1, "scene": "scene.gltf"}
        change(session)
        self.write("bad.json", json.dumps(session).encode())
        self.refuse(1, says, "view", "--session", "bad.json", env=NO_DISPLAY)

    def test_what_is_wrong_is_said_before_a_window_is_sought(self):
        self.write("bad.json", b"{")
        self.refuse(1, "JSON", "view", "--session", "bad.json", env=NO_DISPLAY)
        self.refuse(1, "missing.json", "view", "--session", "missing.json", env=NO_DISPLAY)
        self.refuse(2, "one too many", "view", "scene.gltf", "--session", "bad.json", env=NO_DISPLAY)
        self.refuse_session(lambda s: s.pop("scene"), "missing")
        self.refuse_session(lambda s: s.update(schema=2), "/schema")
        self.refuse_session(lambda s: s.update(scene="lost.gltf"), "lost.gltf")
        self.refuse_session(lambda s: s.update(camera={"eye": [0, 0, "1"]}), "/camera/eye/2")
        self.refuse_session(lambda s: s.update(camera={"eye": [1, 1, 1], "target": [1, 1, 1]}), "/camera")
        self.refuse_session(lambda s: s.update(options={"bounces": 1e9}), "/options/bounces")
        self.refuse_session(lambda s: s.update(options={"method": "magic"}), "raytrace")
        self.refuse_session(lambda s: s.update(options={"bounce": 1}), "/options/bounce")
        self.refuse_session(lambda s: s.update(options={"zexels": {"references": 3}}), "/options/zexels/references")
        self.refuse_session(lambda s: s.update(materials=[{"material": 0, "roughness": 2}]), "/materials/0/roughness")
        self.refuse_session(lambda s: s.update(moved={"object": 0}), "/moved")
        self.refuse_session(lambda s: s.update(scene_options=["--nonsense"]), "/scene_options")
        # As it should be, only the window is missing.
        self.refuse_session(lambda s: None, "no window can be opened")


class Editing(WindowTest):
    def drag_with_control(self, viewer, start, end):
        viewer.do("keydown", "ctrl")
        viewer.drag(start, end)
        viewer.do("keyup", "ctrl")

    def test_a_dragged_object_is_undone_and_saved(self):
        viewer = self.view("scene.gltf", "--size", "320x240", "--camera", "front", "--max-error", "1000",
                           "--merge", "texture", "--texture-scale", "0.5", "--backend", "cpu")
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        viewer.do("key", "p")
        first = self.screenshot(viewer, 1)
        viewer.after(SETTLED, lambda: self.drag_with_control(viewer, (220, 90), (100, 150)))
        dragged = self.screenshot(viewer, 2)
        self.assertNotEqual(dragged, first)
        # Where it was taken to, and only there: the board is red.
        _, _, channels, rows = dragged
        self.assertGreater(rows[150][100 * channels], 2 * rows[150][100 * channels + 1])
        self.assertLess(rows[90][220 * channels], 2 * rows[90][220 * channels + 1])
        viewer.after(SETTLED, lambda: viewer.do("key", "ctrl+z"))
        self.assertEqual(self.screenshot(viewer, 3), first)
        viewer.after(SETTLED, lambda: viewer.do("key", "ctrl+shift+z"))
        self.assertEqual(self.screenshot(viewer, 4), dragged)
        viewer.after("wrote ", lambda: viewer.do("key", "ctrl+s"))
        self.close(viewer)

        # The session shows the same, from another folder as well.
        session = json.loads(self.read(SESSION))
        self.assertEqual([edit["name"] for edit in session["moved"]], ["Board"])
        options = session["options"]
        self.assertEqual((options["max_error_px"], options["merge"], options["texture_scale"], options["backend"]),
                         (1000, "texture", 0.5, "cpu"))
        os.mkdir(self.path("other"))
        viewer = window_support.Viewer(self.path("other"), self.display, "--session", "../" + SESSION)
        self.addCleanup(viewer.kill)
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        viewer.after("wrote ", lambda: viewer.do("key", "F12"))
        self.assertEqual(support.read_png(self.read("other", "scene-0001.png")), dragged)
        self.close(viewer)

        # Of a scene that has changed since it says so.
        session["moved"][0]["name"] = "Plank"
        self.write(SESSION, json.dumps(session).encode())
        viewer = self.view("--session", SESSION)
        self.assertEqual(viewer.end(), 1)
        self.assertEqual(viewer.count("catoptric: error: .*'Plank'"), 1, viewer.said())

    def assert_rescued(self, number):
        session = json.loads(self.read(f"scene-rescued-{number:04}.session.json"))
        self.assertEqual([edit["name"] for edit in session["moved"]], ["Board"])

    def edit(self, viewer):
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        viewer.do("key", "p")
        viewer.after(SETTLED, lambda: self.drag_with_control(viewer, (220, 90), (100, 150)))

    def test_a_driver_that_resets(self):
        """No software renderer does: its answer is put in the place where it is asked for (gl/reset_status.h)."""
        resets = self.path("resets")
        os.mkdir(resets)
        os.environ["CATOPTRIC_FAKE_GL_RESET"] = resets
        self.addCleanup(os.environ.pop, "CATOPTRIC_FAKE_GL_RESET")
        viewer = self.view("scene.gltf", "--size", "320x240", "--camera", "front")
        self.edit(viewer)
        edited = self.screenshot(viewer, 1)
        # The drawer's context is made anew, and shows the same.
        self.write("resets/renderer", b"")
        viewer.after(SETTLED, lambda: viewer.do("key", "7"))
        self.assertEqual(viewer.count("has reset the renderer's OpenGL context"), 1, viewer.said())
        viewer.after(SETTLED, lambda: viewer.do("key", "r"))
        self.assertEqual(self.screenshot(viewer, 2), edited)
        # The window's ends the viewer, but not what was edited.
        self.write("resets/window", b"")
        viewer.do("mousemove", 100, 100)
        self.assertEqual(viewer.end(), 1, viewer.said())
        self.assertEqual(viewer.count("catoptric: error: .* has reset the window's OpenGL context"), 1, viewer.said())
        self.assert_rescued(1)

    def test_a_display_that_goes(self):
        with window_support.Display() as display:
            viewer = window_support.Viewer(self.folder, display, "scene.gltf", "--size", "320x240", "--camera", "front")
            self.addCleanup(viewer.kill)
            self.edit(viewer)
        self.assertEqual(viewer.end(), 1, viewer.said())
        self.assertEqual(viewer.count("catoptric: error: the connection to the display was lost"), 1, viewer.said())
        self.assert_rescued(1)

    def test_surroundings_are_picked_from_the_list(self):
        red = bytes((200, 20, 20, 128))  # radiance, with its exponent
        self.write("red.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + 32 * red)
        viewer = self.view("scene.gltf", "--size", "640x480", "--camera", "front")
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        sky = self.screenshot(viewer, 1)
        # The sixth row of the panel; in the list the sky is the first, the one file beside the scene the second.
        viewer.do("mousemove", 100, 162, "sleep", "0.2", "click", 1, "sleep", "0.3")
        viewer.after(SETTLED, lambda: viewer.do("mousemove", 100, 204, "sleep", "0.2", "click", 1))
        picked = self.screenshot(viewer, 2)
        channels = picked[2]
        red, green = picked[3][470][channels * 600:channels * 600 + 2]
        self.assertGreater(red, 2 * green)
        self.assertNotEqual(picked, sky)
        # The eye stays where it was, and the session names the file.
        viewer.after("wrote ", lambda: viewer.do("key", "ctrl+s"))
        session = json.loads(self.read(SESSION))
        self.assertEqual(session["environment"], "red.hdr")
        viewer.do("mousemove", 100, 162, "sleep", "0.2", "click", 1, "sleep", "0.3")
        viewer.after(SETTLED, lambda: viewer.do("mousemove", 100, 187, "sleep", "0.2", "click", 1))
        self.assertEqual(self.screenshot(viewer, 3), sky)
        self.close(viewer)

    def test_inside_the_method(self):
        viewer = self.view("scene.gltf", "--size", "700x560", "--camera", "front", "--method", "zexel", "--zexel-mark",
                           "--zexel-size", "64", "--zexel-without", "coherence")
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        viewer.after("from elsewhere", lambda: viewer.do("key", "i"))
        viewer.after("from elsewhere", lambda: viewer.drag((400, 400), (450, 420)))  # the second camera alone moves
        self.assertEqual(viewer.count(SETTLED), 1, viewer.said())
        viewer.do("key", "i")
        # Options of the method are in the copied command and in the session.
        viewer.do("key", "ctrl+c")
        window_support.wait_for(lambda: viewer.read(viewer.output), "command line")
        self.assertIn(" --zexel-size=64 --zexel-without=coherence --zexel-mark ", viewer.read(viewer.output))
        viewer.after("wrote ", lambda: viewer.do("key", "ctrl+s"))
        zexels = json.loads(self.read(SESSION))["options"]["zexels"]
        self.assertEqual((zexels["size"], zexels["mark"], zexels["coherence"], zexels["splat"]), (64, True, False, "footprint"))
        self.close(viewer)

    def test_time_plays_and_frames_are_recorded(self):
        self.write("scene.gltf", json.dumps(motion_test.make_moving()).encode())
        viewer = self.view("scene.gltf", "--size", "160x120", "--camera", "front", "--time", "1")
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        self.succeed("render", "scene.gltf", "-o", "at1.png", "--size", "160x120", "--camera", "front", "--time", "1")
        still = self.screenshot(viewer, 1)
        self.assertEqual(still, support.read_png(self.read("at1.png")))
        viewer.do("key", "shift+F12")
        viewer.do("key", "space")
        frames = self.path("scene-frames-0001")
        window_support.wait_for(lambda: len(os.listdir(frames)) >= 4, "recorded frames")
        viewer.do("key", "space")
        viewer.after("recorded", lambda: viewer.do("key", "shift+F12"))
        pictures = [support.read_png(self.read("scene-frames-0001", name)) for name in sorted(os.listdir(frames))]
        self.assertEqual(pictures[0], still)
        self.assertEqual(len({picture[3][40] for picture in pictures[:4]}), 4, "each frame shows another moment")
        # The second frame is a 25th of a second later, however long it took to draw.
        self.succeed("render", "scene.gltf", "-o", "next.png", "--size", "160x120", "--camera", "front", "--time", "1.04")
        self.assertEqual(pictures[1], support.read_png(self.read("next.png")))
        self.close(viewer)


if __name__ == "__main__":
    window_support.skip_without_tools()
    unittest.main()
