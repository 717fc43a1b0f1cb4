# SPDX-License-Identifier: Apache-2.0
"""What the pages work with: the command, run and remembered so that the page can say how it was made, and its reports."""
import json
import os
import shutil
import struct
import subprocess
import sys
import zlib

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import report_pictures  # noqa: E402  (in the folder above)
from page import px, share, milliseconds  # noqa: E402

NAMES = {"environment": "environment map, box-corrected", "environment-plain": "environment map",
         "virtual-explosion": "explosion maps, as published", "virtual-layered": "layered explosion maps",
         "virtual-refined": "virtual objects", "virtual-exact": "virtual objects, each pixel tested",
         "virtual-analytic": "virtual objects, closed form", "morphing": "reflection morphing", "zexel": "zexels",
         "none": "no reflections", "raytrace": "ray-traced truth"}


def decode_png(data):
    """Bytes of an 8-bit RGB or RGBA PNG that is not interlaced, as the command writes them; alpha is left out."""
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"IHDR":
            width, height, _, color = struct.unpack_from(">IIBB", data, at + 8)
        elif kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, step = zlib.decompress(packed), 4 if color == 6 else 3
    stride, before, rows = width * step, bytearray(width * step), []
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride if kind else 0):
            left, above, corner = (row[x - step], before[x], before[x - step]) if x >= step else (0, before[x], 0)
            if kind == 4:
                guess = left + above - corner
                near = min((abs(guess - left), 0, left), (abs(guess - above), 1, above), (abs(guess - corner), 2, corner))[2]
            else:
                near = (left, above, (left + above) // 2)[kind - 1]
            row[x] = (row[x] + near) & 255
        rows.append(row)
        before = row
    whole = b"".join(rows)
    return whole if step == 3 else bytes(value for i, value in enumerate(whole) if i % 4 != 3)


def mean_difference(a, b):
    """Of two pictures' bytes."""
    return sum(map(abs, map(int.__sub__, a, b))) / len(a)


class Comparison:
    """One view by several methods: rows of the report, and pictures in the page's folder."""

    def __init__(self, rows, files):
        self.rows, self.files = rows, files

    def __getitem__(self, method):
        return self.rows[method]

    def objects(self, method, figure):
        return self.rows[method]["displacement"]["object_pixels"][figure]

    def mirrors(self, method, figure):
        return self.rows[method]["displacement"]["mirror_pixels"][figure]

    def picture(self, method, caption=None):
        return caption or NAMES[method], self.files[method, "picture"]

    def error(self, method, caption=None):
        return caption or f"error of {NAMES[method]}", self.files[method, "displacement"]

    def beside_truth(self, method, caption=None):
        return [self.picture(method, caption), self.picture("raytrace"), self.error(method, "error map")]

    def table(self):
        head = ["method", "median px, objects", "95 %", "≤ 1 px", "lost", "frame", "of which reflections"]
        rows = []
        for name, row in self.rows.items():
            cells = ["truth", "–", "–", "–"]
            if name != "raytrace":
                part = row["displacement"]["object_pixels"]
                cells = [px(part["median_px"]), px(part["p95_px"]), share(part["share_le_1px"]), share(part["share_lost"])]
            rows.append([NAMES[name], *cells, milliseconds(row["median_ms"]), milliseconds(row["reflection_ms"])])
        return head, rows


class Shop:
    """`out`: where the pages go; pictures go to out/images, everything else to a folder that is thrown away."""

    def __init__(self, command, out, work, size):
        self.command, self.out, self.work, self.size = command, out, work, size
        self.facts = {}
        self.said = []  # command lines since the last section
        os.makedirs(os.path.join(out, "images"), exist_ok=True)

    def run(self, *words):
        """Runs the command in the work folder; what it printed. A failure of its ends everything, with its own line."""
        self.said.append("catoptric " + " ".join(words))
        done = subprocess.run([self.command, *words, "--quiet"], cwd=self.work, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"make figures: `{self.said[-1]}` ended with {done.returncode}: {done.stderr.strip()}")
        return done.stdout

    def compare(self, name, scene, methods, *options, size=None, repeat=1):
        """Every method against the truth; pictures are called NAME-METHOD.jpg."""
        self.run("compare", scene, "-o", name, "--methods", ",".join(methods), "--size", size or self.size, "--repeat",
                 str(repeat), *options)
        folder = os.path.join(self.work, name)
        pictures, rows, files = report_pictures.read_pictures(folder), {}, {}
        for row in report_pictures.read_rows(folder):
            rows[row["name"]] = row
            for kind in ("picture", "displacement"):
                if row["files"].get(kind):
                    suffix = "" if kind == "picture" else "-error"
                    files[row["name"], kind] = self.keep(f"{name}-{row['name']}{suffix}.jpg", pictures[row["files"][kind]])
        shutil.rmtree(folder)
        return Comparison(rows, files)

    def render(self, name, scene, *options, size=None):
        """One picture, images/NAME.jpg, and what --json says of the frame."""
        target = f"{name}.jpg"
        self.run("render", scene, "-o", target, "--size", size or self.size, "--json", "frame.json", *options)
        with open(os.path.join(self.work, target), "rb") as file:
            kept = self.keep(target, file.read())
        return kept, self.read_json("frame.json")

    def draw(self, name, scene, what, *options, size=None):
        """A structure, images/NAME.jpg; what --json says of it is kept in `facts`."""
        target = f"{name}.jpg"
        self.run("draw", scene, "-o", target, "--show", what, "--size", size or self.size, "--json", "facts.json", *options)
        self.facts = self.read_json("facts.json")["facts"]
        with open(self.path(target), "rb") as file:
            return self.keep(target, file.read())

    def pixels(self, scene, *options, size=None):
        """Bytes of the picture's pixels, red, green, blue; not shown anywhere."""
        self.run("render", scene, "-o", "pixels.png", "--size", size or self.size, *options)
        with open(self.path("pixels.png"), "rb") as file:
            return decode_png(file.read())

    def path(self, name):
        return os.path.join(self.work, name)

    def read_json(self, name):
        with open(os.path.join(self.work, name), encoding="utf-8") as file:
            return json.load(file)

    def keep(self, name, content):
        """Bytes or text as a file of images/; its address from a page."""
        path = os.path.join(self.out, "images", name)
        with open(path, "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return "images/" + name

    def take_commands(self):
        said, self.said = self.said, []
        return said
