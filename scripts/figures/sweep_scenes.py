# SPDX-License-Identifier: Apache-2.0
"""Scenes for the figures on tessellation (1998, 13 and 14), and for drawings in which cells have to be large enough to be seen: a
mirroring ball of so many triangles, normals exact, beside a checkered board cut into so many squares."""
import base64
import json
import math
import struct
import zlib

BALL_RADIUS, BALL_CENTRE = 0.5, (0.0, 0.5, 0.0)
BOARD_CENTRE, BOARD_SIZE = (0.95, 0.6, 0.8), 1.6  # before the ball, a little to the right
EYE = ("--eye", "-0.5,0.75,2.6", "--target", "0.12,0.5,0.1", "--fov", "28")


def make_ball(halvings):
    """An octahedron whose triangles are cut into four so many times, on the sphere: 8 * 4^halvings triangles."""
    x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    minus = [tuple(-c for c in v) for v in (x, y, z)]
    ring = [x, z, minus[0], minus[2]]
    triangles = [(y, ring[(k + 1) % 4], ring[k]) for k in range(4)]
    triangles += [(minus[1], ring[k], ring[(k + 1) % 4]) for k in range(4)]

    def middle(a, b):
        m = [p + q for p, q in zip(a, b)]
        length = math.sqrt(sum(c * c for c in m))
        return tuple(c / length for c in m)

    for _ in range(halvings):
        cut = []
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            cut += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = cut
    numbers, indices = {}, []
    for triangle in triangles:
        indices += [numbers.setdefault(tuple(round(c, 9) for c in v), len(numbers)) for v in triangle]
    normals = list(numbers)
    positions = [tuple(BALL_RADIUS * c + m for c, m in zip(n, BALL_CENTRE)) for n in normals]
    return positions, normals, None, indices


def make_board(cuts):
    """A square that faces the ball."""
    towards = [b - c for b, c in zip(BALL_CENTRE, BOARD_CENTRE)]
    length = math.hypot(towards[0], towards[2])
    normal = (towards[0] / length, 0.0, towards[2] / length)
    right = (normal[2], 0.0, -normal[0])
    positions, uvs, indices = [], [], []
    for j in range(cuts + 1):
        for i in range(cuts + 1):
            u, v = i / cuts, j / cuts
            positions.append(tuple(c + BOARD_SIZE * ((u - 0.5) * r + (v - 0.5) * (k == 1))
                                   for k, (c, r) in enumerate(zip(BOARD_CENTRE, right))))
            uvs.append((u, 1 - v))
    for j in range(cuts):
        for i in range(cuts):
            a = j * (cuts + 1) + i
            indices += [a, a + 1, a + cuts + 2, a, a + cuts + 2, a + cuts + 1]
    return positions, [normal] * len(positions), uvs, indices


def make_checker(squares=8, size=256):
    """PNG: a checkerboard, each quarter in colours of its own."""
    rows = b""
    for y in range(size):
        row = b"\0"
        for x in range(size):
            dark = (x * squares // size + y * squares // size) % 2
            colour = ((200, 60, 40), (40, 90, 190), (40, 140, 70), (220, 160, 30))[(2 * x // size) + 2 * (2 * y // size)]
            row += bytes(colour if dark else (235, 232, 225))
        rows += row

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


class Document:
    """A glTF with everything in it."""

    def __init__(self):
        self.binary, self.views, self.accessors, self.meshes, self.nodes = b"", [], [], [], []

    def add(self, values, kind):
        self.views.append({"buffer": 0, "byteOffset": len(self.binary)})
        if kind == "SCALAR":
            data, component = struct.pack(f"<{len(values)}I", *values), 5125
        else:
            data, component = b"".join(struct.pack(f"<{len(v)}f", *v) for v in values), 5126
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(values), "type": kind}
        if kind == "VEC3":
            accessor.update(min=[min(c) for c in zip(*values)], max=[max(c) for c in zip(*values)])
        self.views[-1]["byteLength"] = len(data)
        self.binary += data
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def add_mesh(self, name, mesh, material):
        positions, normals, uvs, indices = mesh
        attributes = {"POSITION": self.add(positions, "VEC3"), "NORMAL": self.add(normals, "VEC3")}
        if uvs:
            attributes["TEXCOORD_0"] = self.add(uvs, "VEC2")
        self.meshes.append({"name": name, "primitives": [
            {"attributes": attributes, "indices": self.add(indices, "SCALAR"), "material": material}]})
        self.nodes.append({"name": name, "mesh": len(self.meshes) - 1})

    def text(self):
        def address(kind, data):
            return f"data:{kind};base64," + base64.b64encode(data).decode()
        mirror = {"name": "mirror", "pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0,
                                                             "baseColorFactor": [0.95, 0.95, 0.95, 1]}}
        board = {"name": "board", "doubleSided": True, "pbrMetallicRoughness": {
            "metallicFactor": 0, "roughnessFactor": 0.9, "baseColorTexture": {"index": 0}}}
        return json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(self.nodes)))}], "nodes": self.nodes,
            "meshes": self.meshes, "materials": [mirror, board], "accessors": self.accessors, "bufferViews": self.views,
            "textures": [{"source": 0}], "images": [{"uri": address("image/png", make_checker())}],
            "buffers": [{"byteLength": len(self.binary), "uri": address("application/octet-stream", self.binary)}]})


def write_sweep(path, halvings, cuts):
    document = Document()
    document.add_mesh("ball", make_ball(halvings), 0)
    document.add_mesh("board", make_board(cuts), 1)
    with open(path, "w", encoding="utf-8") as file:
        file.write(document.text())
