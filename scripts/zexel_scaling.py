#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""zexel_scaling.py CATOPTRIC [-o PLOT.svg] [--most TRIANGLES]: frames of the furnished room by polygon count, with zexels and
with the scene drawn again for each of the two mirrors.

The room is made smaller by leaving out what is finely cut, and larger by cutting each triangle into k x k: the picture stays
the same. Also prints the time of the warp alone for checker-box as it is and cut to about 190,000 triangles."""
import argparse
import array
import json
import math
import os
import struct
import subprocess
import tempfile

FINE = ("plant", "ball", "ring", "teapot", "second teapot", "chair", "bookshelf", "sofa", "red sofa")
STEPS = [(5, True), (9, True), (1, False), (2, False), (4, False), (7, False)]  # k, fine things left out
METHODS = ("virtual-refined", "zexel")


class Glb:
    """A .glb as the command writes it: every accessor has a view of its own."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        size = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + size])
        self.binary = bytearray(data[28 + size:])

    def read(self, accessor):
        a = self.json["accessors"][accessor]
        view = self.json["bufferViews"][a["bufferView"]]
        values = array.array("f" if a["componentType"] == 5126 else "I")
        values.frombytes(self.binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]])
        return values

    def add(self, values, like):
        a = dict(self.json["accessors"][like])
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": 4 * len(values)})
        self.binary += values.tobytes()
        a.update(bufferView=len(self.json["bufferViews"]) - 1,
                 count=len(values) // {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[a["type"]])
        self.json["accessors"].append(a)
        return len(self.json["accessors"]) - 1

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(self.binary), len(text), 0x4E4F534A))
            file.write(text + struct.pack("<II", len(self.binary), 0x004E4942) + self.binary)


def cut(glb, primitive, k):
    """Cuts each triangle of a primitive into k x k."""
    indices = glb.read(primitive["indices"])
    weights = [((k - i - j) / k, i / k, j / k) for i in range(k + 1) for j in range(k + 1 - i)]
    number = {(i, j): n for n, (i, j) in enumerate((i, j) for i in range(k + 1) for j in range(k + 1 - i))}
    pattern = []
    for i in range(k):
        for j in range(k - i):
            pattern += [number[i, j], number[i + 1, j], number[i, j + 1]]
            if i + j < k - 1:
                pattern += [number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]]
    for name, accessor in primitive["attributes"].items():
        old, new = glb.read(accessor), array.array("f")
        width = {"VEC2": 2, "VEC3": 3, "VEC4": 4}[glb.json["accessors"][accessor]["type"]]
        for t in range(0, len(indices), 3):
            a, b, c = (old[width * i:width * i + width] for i in indices[t:t + 3])
            for wa, wb, wc in weights:
                values = [wa * x + wb * y + wc * z for x, y, z in zip(a, b, c)]
                if name == "NORMAL":
                    length = math.hypot(*values) or 1.0
                    values = [v / length for v in values]
                new.extend(values)
        primitive["attributes"][name] = glb.add(new, accessor)
    count = len(weights)
    primitive["indices"] = glb.add(
        array.array("I", (t * count + n for t in range(len(indices) // 3) for n in pattern)), primitive["indices"])


def make_scene(source, target, k, without_fine):
    """Returns the number of triangles."""
    glb = Glb(source)
    if without_fine:
        for node in glb.json["nodes"]:
            if "mesh" in node and node.get("name", "").rstrip(" 0123456789") in FINE:
                del node["mesh"]
    used = {node["mesh"] for node in glb.json["nodes"] if "mesh" in node}
    mirrors = {node["mesh"] for node in glb.json["nodes"]
               if "mesh" in node and node.get("name", "").endswith("mirror")}
    for index in used - mirrors if k > 1 else ():
        for primitive in glb.json["meshes"][index]["primitives"]:
            cut(glb, primitive, k)
    glb.write(target)
    return sum(glb.json["accessors"][p["indices"]]["count"] // 3 for node in glb.json["nodes"] if "mesh" in node
               for p in glb.json["meshes"][node["mesh"]]["primitives"])


def bench(catoptric, scene, folder, *options):
    """Name of a method -> its row."""
    data = os.path.join(folder, "bench.json")
    subprocess.run([catoptric, "bench", scene, "--json", data, "--size", "640x480", "--max-memory", "16G", "--quiet", *options],
                   check=True, stdout=subprocess.DEVNULL)
    with open(data, encoding="utf-8") as file:
        return {row["name"]: row for row in json.load(file)["results"]}


def print_warps(catoptric, *scenes_and_counts_and_folder):
    """Time of the warp alone along the walk: of each frame the least of several rounds, taken in turn; their sum."""
    *scenes, folder = scenes_and_counts_and_folder
    data, least, zexels = os.path.join(folder, "frames.json"), {}, {}
    for _ in range(5):
        for scene, count in scenes:
            subprocess.run([catoptric, "render", scene, "-o", os.path.join(folder, "f_##.png"), "--json", data, "--method",
                            "zexel", "--camera", "walk", "--frames", "9", "--fps", "1.5", "--size", "640x480", "--quiet"],
                           check=True, stdout=subprocess.DEVNULL)
            with open(data, encoding="utf-8") as file:
                frames = json.load(file)["frames"]
            times = [frame["timings"]["warp_ms"] for frame in frames]
            least[count] = [min(pair) for pair in zip(times, least.get(count, times))]
            zexels[count] = sum(frame["counters"]["zexels"] for frame in frames)
    (few, few_ms), (many, many_ms) = ((count, sum(times)) for count, times in least.items())
    print(f"warp alone, nine frames of the walk through checker-box: {few_ms:.2f} ms at {few} triangles, {many_ms:.2f} ms at "
          f"{many}: {100 * (many_ms / few_ms - 1):+.1f} %; zexels {zexels[few]} and {zexels[many]}\n", flush=True)


def draw_plot(points, path):
    """Log-log: triangles to milliseconds a frame."""
    left, top, width, height = 70, 20, 430, 260
    most = 10 ** math.ceil(math.log10(max(p[1] for p in points)))
    least = 10 ** math.floor(math.log10(min(p[2] for p in points)))

    def place(triangles, ms):
        return (left + width * (math.log10(triangles) - 4) / 3,
                top + height * (1 - math.log10(ms / least) / math.log10(most / least)))

    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 560 330" font-family="sans-serif" font-size="12">',
           '<rect width="560" height="330" fill="#fff"/>']
    for power in range(4, 8):
        x = place(10 ** power, least)[0]
        out.append(f'<path d="M{x:.1f} {top}V{top + height}" stroke="#ddd"/>'
                   f'<text x="{x:.1f}" y="{top + height + 18}" text-anchor="middle">10{"⁴⁵⁶⁷"[power - 4]}</text>')
    for power in range(round(math.log10(least)), round(math.log10(most)) + 1):
        y = place(1e4, 10 ** power)[1]
        out.append(f'<path d="M{left} {y:.1f}H{left + width}" stroke="#ddd"/>'
                   f'<text x="{left - 8}" y="{y + 4:.1f}" text-anchor="end">{10 ** power} ms</text>')
    for column, colour, label in ((1, "#b5442e", "scene drawn again for each mirror"), (2, "#2e5fa3", "zexels")):
        at = [place(p[0], p[column]) for p in points]
        out.append(f'<path d="M{" L".join(f"{x:.1f} {y:.1f}" for x, y in at)}" fill="none" stroke="{colour}" '
                   f'stroke-width="2"/>' + "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in at)
                   + f'<text x="{left + 12}" y="{top + 4 + 16 * column}" fill="{colour}">{label}</text>')
    out.append(f'<text x="{left + width / 2}" y="{top + height + 40}" text-anchor="middle">triangles of the furnished room; '
               'a frame of 640x480</text></svg>')
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("catoptric")
    parser.add_argument("-o", dest="plot")
    parser.add_argument("--most", type=float, default=1e7)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for name in ("checker-box", "furnished-room"):
            subprocess.run([options.catoptric, "scenes", name, "-o", folder, "--quiet"], check=True)
        scene, source = os.path.join(folder, "cut.glb"), os.path.join(folder, "checker-box.glb")
        few = make_scene(source, scene, 1, False)
        k = round(math.sqrt(190000 / few))
        many = make_scene(source, scene, k, False)
        print_warps(options.catoptric, (source, few), (scene, many), folder)
        print("| triangles | drawn again, ms | zexels, ms | ratio of frames | ratio of reflections |\n"
              "| --- | --- | --- | --- | --- |")
        points, source = [], os.path.join(folder, "furnished-room.glb")
        for k, without_fine in STEPS:
            count = make_scene(source, scene, k, without_fine)
            if count > options.most:
                break
            rows = bench(options.catoptric, scene, folder, "--methods", ",".join(METHODS), "--camera", "1",
                         "--repeat", "3" if count > 1e6 else "15")
            again, zexel = (rows[m] for m in METHODS)
            points.append((count, again["median_ms"], zexel["median_ms"]))
            print(f"| {count:,} | {again['median_ms']:.0f} | {zexel['median_ms']:.0f} | "
                  f"{again['median_ms'] / zexel['median_ms']:.2f} | {again['reflection_ms'] / zexel['reflection_ms']:.2f} |",
                  flush=True)
        if options.plot:
            draw_plot(points, options.plot)


if __name__ == "__main__":
    main()
