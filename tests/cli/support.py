# SPDX-License-Identifier: Apache-2.0
"""What the tests of the command share: running it, a small scene, readers for what it writes."""
import base64
import collections.abc
import json
import os
import struct
import subprocess
import tempfile
import unittest
import zlib

CATOPTRIC = os.environ.get("CATOPTRIC", "catoptric")
SMALL = ("--size", "64x48")


def make_gltf(mirror_roughness=0.0, color=(0.8, 0.1, 0.1)):
    """A square mirror in the plane z = 0 that faces +z, a coloured square in front of it, a camera."""
    corners = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    positions = b"".join(struct.pack("<3f", *c) for c in corners)
    indices = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    data = base64.b64encode(positions + indices).decode()
    return {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64," + data}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "materials": [
            {"name": "silver", "pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": mirror_roughness}},
            {"name": "paint", "doubleSided": True, "pbrMetallicRoughness":
                {"metallicFactor": 0, "roughnessFactor": 1, "baseColorFactor": [*color, 1]}}],
        "meshes": [{"name": "mirror", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]},
                   {"name": "board", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 1}]}],
        "cameras": [{"type": "perspective", "name": name, "perspective": {"yfov": 0.8, "znear": 0.1}}
                    for name in ("front", "side")],
        "nodes": [{"name": "Mirror", "mesh": 0},
                  {"name": "Board", "mesh": 1, "translation": [0.6, 0.3, 1.0], "scale": [0.3, 0.3, 0.3]},
                  {"name": "front", "camera": 0, "translation": [0, 0, 4]},
                  {"name": "side", "camera": 1, "translation": [1, 0, 4]}],
        "scenes": [{"nodes": [0, 1, 2, 3]}], "scene": 0}


def make_glb(document):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sII", b"glTF", 2, 20 + len(text)) + struct.pack("<I4s", len(text), b"JSON") + text


class Picture(collections.abc.Sequence):
    """(width, height, channels, rows of bytes) of an 8-bit PNG that is not interlaced. Rows are decoded, which takes a
    while in Python, when they are first asked for; to compare pictures that the command has written they need not be:
    its encoder is deterministic, so they are equal where the filtered bytes are."""

    def __init__(self, width, height, channels, filtered):
        self.shape, self.filtered, self.rows = (width, height, channels), filtered, None

    def __eq__(self, other):
        return (self.shape, self.filtered) == (other.shape, other.filtered)

    def __len__(self):
        return 4

    def __getitem__(self, i):
        if isinstance(i, slice):
            return tuple(self[k] for k in range(*i.indices(4)))
        return self.shape[i] if i in (0, 1, 2) else self.decode_rows(i)

    def decode_rows(self, i):
        if i not in (3, -1):
            raise IndexError(i)
        if self.rows is None:
            width, height, channels = self.shape
            self.rows, stride = [], width * channels
            previous = bytes(stride)
            for y in range(height):
                kind, line = self.filtered[y * (stride + 1)], self.filtered[y * (stride + 1) + 1:(y + 1) * (stride + 1)]
                previous = undo_filter(kind, bytearray(line), previous, channels)
                self.rows.append(previous)
        return self.rows


def undo_filter(kind, line, previous, channels):
    for i in range(len(line) if kind else 0):
        a = line[i - channels] if i >= channels else 0
        b, c = previous[i], previous[i - channels] if i >= channels else 0
        nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2] if kind == 4 else 0
        line[i] = (line[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
    return bytes(line)


def read_png(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack_from(">IIBB", body)
            assert depth == 8
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    return Picture(width, height, {2: 3, 6: 4, 0: 1}[color], zlib.decompress(packed))


def exr_channels(data):
    """name -> pixel type (1 half, 2 float, 0 unsigned integer) from the header of an EXR."""
    assert data[:4] == b"\x76\x2f\x31\x01"
    at, channels = 8, {}

    def text():
        nonlocal at
        end = data.index(b"\0", at)
        value, at = data[at:end].decode(), end + 1
        return value

    while data[at]:
        name = text()
        text()
        size = struct.unpack_from("<i", data, at)[0]
        at += 4
        end = at + size
        if name == "channels":
            while data[at]:
                channel = text()
                channels[channel] = struct.unpack_from("<i", data, at)[0]
                at += 16
        at = end
    return channels


class CommandTest(unittest.TestCase):
    """A test with a folder of its own, in which the command runs."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="catoptric-test-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.write("scene.gltf", json.dumps(make_gltf()).encode())

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)
        return name

    def read(self, *names):
        with open(self.path(*names), "rb") as file:
            return file.read()

    def run_command(self, *arguments, stdin=None, stdout=subprocess.PIPE, env=None):
        return subprocess.run([CATOPTRIC, *arguments], cwd=self.folder, input=stdin, stdout=stdout,
                              stderr=subprocess.PIPE, timeout=300, env={**os.environ, **(env or {})}, check=False)

    def succeed(self, *arguments, **options):
        done = self.run_command(*arguments, **options)
        self.assertEqual(done.returncode, 0, f"{arguments}: {done.stderr.decode()}")
        return done

    def refuse(self, code, says, *arguments, **options):
        """The command exits with `code` and one line of error, which holds each of the words `says`."""
        done = self.run_command(*arguments, **options)
        error = done.stderr.decode()
        self.assertEqual(done.returncode, code, f"{arguments}: {error}")
        lines = [line for line in error.splitlines() if line.startswith("catoptric: error: ")]
        self.assertEqual(len(lines), 1, error)
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, lines[0])
        return done

    def json_of(self, *arguments, **options):
        document = json.loads(self.succeed(*arguments, "--json", "-", **options).stdout)
        self.assertEqual(document["schema"], 1)
        return document
