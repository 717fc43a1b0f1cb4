#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""catoptric compare and catoptric bench: documents, pages, limits."""
import json
import os
import re
import unittest

import support

ALL = ["none", "environment-plain", "environment", "virtual-explosion", "virtual-layered",
       "virtual-refined", "virtual-analytic", "virtual-exact", "raytrace"]
QUICK = ("--size", "96x72", "--repeat", "1")


class Compare(support.CommandTest):
    def compare(self, *arguments):
        document = self.json_of("compare", *arguments, "-o", "report", *QUICK)
        self.assertEqual(document, json.loads(self.read("report", "report.json")))
        return document

    def test_time_against_resolution(self):
        self.succeed("compare", "scene.gltf", "-o", "sized", *support.SMALL, "--repeat", "1", "--methods", "none,environment",
                     "--sizes", "32x24,128x96", "-q")
        for row in json.loads(self.read("sized", "report.json"))["results"]:
            self.assertEqual([(size["width"], size["height"]) for size in row["sizes"]], [(32, 24), (128, 96)])
            self.assertTrue(all(size["median_ms"] > 0 for size in row["sizes"]))
            self.assertEqual(row["width"], 64)
        self.refuse(2, "--sizes", "compare", "scene.gltf", "-o", "bad", "--sizes", "32x24,large")
        self.assertFalse(os.path.exists(self.path("bad")))

    def test_report(self):
        document = self.compare("scene.gltf")
        rows = {row["name"]: row for row in document["results"]}
        self.assertEqual(list(rows), ALL)
        for row in rows.values():
            self.assertEqual((row["scene"], row["width"], row["height"], row["bounces"]), ("scene", 96, 72, 1))
            self.assertGreater(row["median_ms"], 0)
            for pixels in row["displacement"].values():
                self.assertGreater(pixels["pixels"], 0)
                self.assertLessEqual(pixels["share_le_1px"], pixels["share_le_2px"])
                self.assertLessEqual(pixels["median_px"], pixels["p95_px"])
            for file in row["files"].values():
                self.assertEqual(support.read_png(self.read("report", file))[:2], (96, 72))
        self.assertEqual(rows["raytrace"]["displacement"]["object_pixels"]["p95_px"], 0)
        self.assertIsNone(rows["raytrace"]["image"]["psnr_db"])
        self.assertGreater(rows["raytrace"]["rays_per_s"], 0)
        self.assertEqual(set(rows["none"]["files"]), {"picture", "displacement", "difference"})
        # The board is gone from the mirror when nothing is mirrored: its pixels are lost.
        self.assertGreater(rows["none"]["displacement"]["object_pixels"]["share_lost"], 0.5)
        self.assertLess(rows["virtual-refined"]["displacement"]["object_pixels"]["median_px"], 0.5)
        self.assertLess(rows["virtual-exact"]["displacement"]["object_pixels"]["p95_px"], 0.1)
        self.assertEqual(rows["virtual-exact"]["solver"], "exact")

    def test_page_is_whole_and_offline(self):
        self.compare("scene.gltf", "--methods", "none,virtual-refined")
        page = self.read("report", "index.html").decode()
        self.assertTrue(page.startswith("<!doctype html>"))
        self.assertTrue(page.rstrip().endswith("</html>"))
        self.assertNotRegex(page, r'(?:src|href)="?[a-z]+://')
        self.assertNotRegex(page, r'@import|url\(')
        files = set(re.findall(r'href="([^"]+)"', page))
        self.assertEqual(len(files), 2 * 3 + 1)
        for file in files:
            self.assertTrue(os.path.exists(self.path("report", file)), file)
        self.assertIn("catoptric compare scene.gltf --methods none,virtual-refined", page)
        self.assertEqual(sorted(os.listdir(self.path("report"))), ["index.html", "report.json", "scene"])

    def test_table_says_where_to_look(self):
        text = self.succeed("compare", "scene.gltf", "-o", "report", "--methods", "none", *QUICK).stdout.decode()
        self.assertIn("report/index.html", text)
        self.assertRegex(text, r"(?m)^scene +none ")
        self.assertRegex(text, r"(?m)^scene +raytrace +0.00 +100.0 +0.0 ")

    def test_several_scenes_and_cameras(self):
        self.write("a b&c.gltf", self.read("scene.gltf"))
        os.mkdir(self.path("other"))
        self.write("other/scene.gltf", self.read("scene.gltf"))
        document = self.compare("scene.gltf", "other/scene.gltf", "a b&c.gltf", "--methods", "none", "--all-cameras")
        self.assertEqual(len(document["results"]), 3 * 2 * 2)
        files = [row["files"]["picture"] for row in document["results"]]
        self.assertEqual(len(set(files)), len(files))
        for file in files:
            self.assertTrue(os.path.exists(self.path("report", file)), file)
        self.assertIn("a b&amp;c", self.read("report", "index.html").decode())
        self.assertEqual({row["camera"]["name"] for row in document["results"]}, {"front", "side"})

    def test_limits(self):
        def compare(code, *limits):
            done = self.run_command("compare", "scene.gltf", "-o", "report", *QUICK, *limits)
            self.assertEqual(done.returncode, code, done.stderr.decode())
            return done

        compare(0, "--methods", "virtual-refined", "--max-median", "0.5", "--max-lost", "10%")
        done = compare(3, "--methods", "none", "--max-lost", "1%")
        self.assertRegex(done.stderr.decode(), r"catoptric: error: scene .*, none, object pixels: .* lost, limit 1 %")
        self.assertTrue(json.loads(self.read("report", "report.json"))["exceeded"])
        self.assertTrue(os.path.exists(self.path("report", "index.html")))
        compare(3, "--methods", "none", "--max-median", "0.001")
        compare(3, "--methods", "none", "--min-within-1px", "100%")
        compare(3, "--methods", "none,virtual-refined", "--limit-method", "none", "--max-lost", "1%")
        compare(0, "--methods", "none,virtual-refined", "--max-lost", "10%")

    def test_curved_mirrors_in_curved_mirrors(self):
        """Spheres in spheres: `exact` follows the chain, also for `refined`; `layered` has an environment map there."""
        for method, code in (("virtual-exact", 0), ("virtual-refined", 0), ("virtual-layered", 3)):
            done = self.run_command("compare", "four-spheres", "-o", "report", "--methods", method, "--bounces", "3",
                                    "--size", "160x120", "--repeat", "1", "--max-median", "0.1", "--min-within-1px",
                                    "99%", "--max-lost", "0.5%")
            self.assertEqual(done.returncode, code, done.stdout.decode() + done.stderr.decode())
            row = json.loads(self.read("report", "report.json"))["results"][0]
            self.assertEqual((row["name"], row["fragment_tests"] > 0), (method, code == 0))

    def test_limits_on_nothing_are_exceeded(self):
        done = self.run_command("compare", "scene.gltf", "-o", "report", *QUICK, "--no-reflectors", "--methods", "none",
                                "--max-median", "5")
        self.assertEqual(done.returncode, 3)
        self.assertIn("no mirror pixels", done.stderr.decode())

    def test_scene_without_mirrors(self):
        document = self.compare("scene.gltf", "--no-reflectors", "--methods", "none")
        row = document["results"][0]
        self.assertEqual(row["displacement"]["mirror_pixels"]["pixels"], 0)
        self.assertIsNone(row["displacement"]["mirror_pixels"]["median_px"])
        self.assertEqual(row["primary"]["pixels"], 96 * 72)
        self.assertGreater(row["primary"]["share_within_4"], 0.99)


class Bench(support.CommandTest):
    def test_table_and_document(self):
        done = self.succeed("bench", "scene.gltf", "--repeat", "2", "--json", "bench.json", *support.SMALL)
        table = done.stdout.decode()
        document = json.loads(self.read("bench.json"))
        self.assertEqual((document["schema"], document["command"]), (1, "bench"))
        self.assertEqual([row["name"] for row in document["results"]], ALL)
        for row in document["results"]:
            self.assertRegex(table, rf"(?m)^{row['name']} ")
            self.assertEqual((row["width"], row["height"], row["frames"]), (64, 48, 2))
            self.assertGreater(row["median_ms"], 0)
            self.assertGreaterEqual(row["p95_ms"], row["median_ms"])
            for key in ("method", "solver", "primary_ms", "reflection_ms", "virtual_vertices_per_s"):
                self.assertIn(key, row)
        self.assertGreater(document["results"][-1]["rays_per_s"], 0)
        self.assertIn("Embree", document["environment"]["embree"])
        self.assertIn(document["environment"]["gl_renderer"], table)

    def test_chosen_methods_in_their_order(self):
        document = self.json_of("bench", "scene.gltf", "--repeat", "1", "--methods", "raytrace,none", *support.SMALL)
        self.assertEqual([row["name"] for row in document["results"]], ["raytrace", "none"])


if __name__ == "__main__":
    unittest.main()
