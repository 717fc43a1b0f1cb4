#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The report of compare in a real browser, without a window: no error, pictures, charts, sorting, slider."""
import html
import json
import os
import re
import shutil
import subprocess
import sys
import unittest

import support

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

# The first goes before everything else in the page, the second behind it.
WATCH = """<script>window.errors = [];
addEventListener("error", (e) => errors.push(e.message || "failed: " + (e.target.src || "").slice(0, 60)), true);
const complain = console.error; console.error = (...words) => { errors.push(words.join(" ")); complain(...words); };
</script>"""
USE = """<script>function useThePage(found) {
  const table = document.querySelector("table"), headings = [...table.querySelectorAll("th")];
  const read = (column) => [...table.querySelectorAll("tr")].slice(1).map((row) => row.children[column].textContent);
  const sortBy = (heading) => {
    const column = headings.findIndex((cell) => cell.textContent === heading);
    headings[column].click();
    return read(column);
  };
  Object.assign(found, {before: read(0), ascending: sortBy("obj. lost %"), descending: sortBy("obj. lost %"),
                        names: sortBy("method")});
  const slider = document.querySelector(".slider"), [below, above] = slider.querySelectorAll("img");
  found.pictures = [above.src === below.src, above.naturalWidth, below.naturalWidth];
  const [left, right] = slider.querySelectorAll("select");
  left.value = right.value; left.dispatchEvent(new Event("change")); found.same = above.src === below.src;
  const range = slider.querySelector("input"), clipBefore = above.style.clipPath;
  range.value = 20; range.dispatchEvent(new Event("input"));
  found.clip = [clipBefore, above.style.clipPath];
  found.broken = [...document.images].filter((image) => !image.complete || image.naturalWidth === 0).length;
  found.charts = [...document.querySelectorAll("canvas")].map((canvas) => {
    const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    return pixels.some((value) => value !== 0);
  });
}
addEventListener("load", () => {
  const found = {errors};
  try { useThePage(found); } catch (error) { errors.push(String(error)); }
  document.body.append(Object.assign(document.createElement("pre"), {id: "found", textContent: JSON.stringify(found)}));
});</script>"""


class Report(support.CommandTest):
    def browse(self, page):
        self.write("page.html", page.replace("<head>", "<head>" + WATCH, 1).replace("</body>", USE + "</body>", 1).encode())
        done = subprocess.run(
            [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=10000", "--dump-dom",
             f"--user-data-dir={self.path('profile')}", "file://" + self.path("page.html")],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=300, check=False)
        found = re.search(r'<pre id="found">(.*?)</pre>', done.stdout.decode(), re.S)
        self.assertIsNotNone(found, done.stdout.decode()[-2000:])
        return json.loads(html.unescape(found.group(1)))

    def test_slider_sorting_and_charts_work_from_a_file(self):
        self.succeed("compare", "scene.gltf", "-o", "report", "--size", "96x72", "--repeat", "1", "--sizes", "48x36,96x72,192x144",
                     "--methods", "none,virtual-refined,environment")
        page = self.read("report", "index.html").decode()
        shutil.rmtree(self.path("report"))  # the page alone is the report
        found = self.browse(page)
        self.assertEqual(found["errors"], [])
        self.assertEqual(found["broken"], 0)
        self.assertEqual(found["before"], ["none", "virtual-refined", "environment", "raytrace"])
        lost = [float(text) for text in found["ascending"]]
        self.assertEqual(lost, sorted(lost))
        self.assertGreater(lost[-1], 50)
        self.assertEqual([float(text) for text in found["descending"]], lost[::-1])
        self.assertEqual(found["names"], ["environment", "none", "raytrace", "virtual-refined"])
        self.assertEqual(found["pictures"], [False, 96, 96])
        self.assertTrue(found["same"])
        self.assertNotEqual(*found["clip"])
        self.assertEqual(found["charts"], [True, True, True])  # errors, error against time, time against resolution
        self.assertIn("<th>192x144</th>", page)
        self.assertIn("catoptric compare scene.gltf -o report", page)

        # The twin: the same page, its script cut short, is found out.
        broken = self.browse(page.replace("fillPictures();\n", "fillNothing();\n"))
        self.assertNotEqual(broken["errors"], [])


if __name__ == "__main__":
    if BROWSER is None:
        print("skipped: no chromium (apt-get install chromium)")
        sys.exit(77)
    unittest.main()
