#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Files that a person lets go of over the viewer's window: scenes, folders, surroundings, and what is neither."""
import json
import os
import unittest

import drag_and_drop
import support
import window_support
from view_test import SETTLED, WindowTest

GREEN, SKY_PIXEL = (20, 200, 20), (2, 2)


def make_hdr(color, width=16, height=8):
    """Radiance .hdr of one colour, 0..255 times 2 / 256."""
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    return header + bytes((*color, 129)) * (width * height)


class Dropping(WindowTest):
    def open(self, *arguments):
        viewer = self.view("scene.gltf", "--size", "320x240", "--camera", "front", *arguments)
        viewer.wait_for_window()
        viewer.wait_for_line(SETTLED)
        return viewer

    def drop(self, viewer, *names):
        with drag_and_drop.Source(self.display) as source:
            source.drop(int(viewer.window), [self.path(name) for name in names])

    def screenshot_of(self, viewer, name, number):
        viewer.after("wrote ", lambda: viewer.do("key", "F12"))
        return support.read_png(self.read(f"{name}-{number:04}.png"))

    def pixel(self, picture, place):
        return tuple(picture[3][place[1]][3 * place[0]:3 * place[0] + 3])

    def assert_green(self, picture):
        red, green, blue = self.pixel(picture, SKY_PIXEL)
        self.assertGreater(green, 2 * max(red, blue))

    def title(self, viewer):
        return viewer.do("getwindowname", viewer.window).strip()

    def write_blue_scene(self, name):
        return self.write(name, json.dumps(support.make_gltf(color=(0.1, 0.1, 0.9))).encode())

    def test_a_scene(self):
        viewer = self.open()
        first = self.screenshot(viewer, 1)
        self.write_blue_scene("blue & größer, 100%.gltf")
        viewer.after(SETTLED, lambda: self.drop(viewer, "blue & größer, 100%.gltf"))
        self.assertEqual(self.title(viewer), "blue & größer, 100% - catoptric")
        self.assertNotEqual(self.screenshot_of(viewer, "blue & größer, 100%", 1), first)
        self.close(viewer)

    def test_surroundings_stay_for_the_next_scene(self):
        viewer = self.open()
        viewer.do("key", "p")
        viewer.after(SETTLED, lambda: viewer.drag((250, 180), (240, 170)))
        first = self.screenshot(viewer, 1)
        self.write("green.HDR", make_hdr(GREEN))
        viewer.after(SETTLED, lambda: self.drop(viewer, "green.HDR"))
        green = self.screenshot(viewer, 2)
        self.assertNotEqual(green, first)
        self.assert_green(green)
        self.write_blue_scene("blue.gltf")
        viewer.after(SETTLED, lambda: self.drop(viewer, "blue.gltf"))
        self.assert_green(self.screenshot_of(viewer, "blue", 1))
        self.close(viewer)

    def test_all_at_once(self):
        viewer = self.open()
        self.write("green.hdr", make_hdr(GREEN))
        os.mkdir(self.path("more"))
        for name in ("more/b.gltf", "more/a.gltf", "c.gltf"):
            self.write_blue_scene(name)
        self.write("c.bin", b"of no interest")
        viewer.after(SETTLED, lambda: self.drop(viewer, "c.bin", "green.hdr", "c.gltf"))
        self.assert_green(self.screenshot_of(viewer, "c", 1))
        viewer.after(SETTLED, lambda: self.drop(viewer, "more"))
        self.assertEqual(self.title(viewer), "a - catoptric")
        viewer.after(SETTLED, lambda: viewer.do("key", "Next"))
        self.assertEqual(self.title(viewer), "b - catoptric")
        self.close(viewer)

    def test_what_is_neither_changes_nothing(self):
        viewer = self.open()
        first = self.screenshot(viewer, 1)
        self.write("notes.txt", b"remember the milk")
        self.write("broken.glb", b"glTF?")
        self.write("broken.exr", b"EXR?")
        os.mkdir(self.path("empty"))
        for name in ("notes.txt", "broken.glb", "broken.exr", "empty"):
            viewer.after(f"failed: .*{name}", lambda: self.drop(viewer, name))
        self.assertEqual(viewer.count("failed: "), 4)
        self.assertEqual(self.screenshot(viewer, 2), first)
        # A broken one is not what the next one is added to.
        self.write("green.hdr", make_hdr(GREEN))
        viewer.after(SETTLED, lambda: self.drop(viewer, "green.hdr"))
        self.assert_green(self.screenshot(viewer, 3))
        self.close(viewer)


if __name__ == "__main__":
    window_support.skip_without_tools()
    unittest.main()
