#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Shoal authors
# SPDX-License-Identifier: Apache-2.0
"""Draws particles of one moment of a 2D run as a PNG picture; needs nothing but Python.

    docs/pictures/draw.py RESULTS BODY NUMBER FIELD MAXIMUM PICTURE [WALL|- [RADIUS]]
    docs/pictures/draw.py results/dam_break_2d water 25 velocity 5 docs/pictures/dam_break_2d.png tank

RADIUS is that of the dots, in spacings: 0.71 leaves no gaps on a lattice.
"""
import base64
import struct
import sys
import xml.etree.ElementTree as xml
import zlib

WIDTH = 1400
NUMBERS = {"Float32": ("f", 4), "Float64": ("d", 8), "Int64": ("q", 8)}
# Colours from slow to fast: deep blue, turquoise, foam.
RAMP = [(11, 37, 84), (16, 94, 140), (30, 152, 166), (128, 204, 180), (240, 246, 230)]


def read_arrays(path):
    """Arrays of a VTP file with zlib-compressed data in base64, by name."""
    arrays = {}
    for piece in xml.parse(path).iter("Piece"):
        for array in list(piece.find("PointData")) + list(piece.find("Points")):
            text = array.text.strip()
            blocks, = struct.unpack("<Q", base64.b64decode(text[:12])[:8])
            # Number, length and last length of the blocks, and how long each is compressed; encoded by itself.
            head = 4 * ((24 + 8 * blocks + 2) // 3)
            sizes = struct.unpack(f"<{3 + blocks}Q", base64.b64decode(text[:head]))[3:]
            data, at, raw = base64.b64decode(text[head:]), 0, b""
            for size in sizes:
                raw += zlib.decompress(data[at:at + size])
                at += size
            code, width = NUMBERS[array.get("type")]
            values = struct.unpack(f"<{len(raw) // width}{code}", raw)
            n = int(array.get("NumberOfComponents", "1"))
            arrays[array.get("Name")] = [values[k:k + n] for k in range(0, len(values), n)]
    return arrays


def colour(fraction):
    at = min(max(fraction, 0.0), 1.0) * (len(RAMP) - 1)
    k = min(int(at), len(RAMP) - 2)
    return tuple(round(a + (at - k) * (b - a)) for a, b in zip(RAMP[k], RAMP[k + 1]))


def write_png(path, pixels, width, height):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = b"".join(b"\0" + bytes(pixels[3 * width * y:3 * width * (y + 1)]) for y in range(height))
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)) +
                  chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def main(results, body, number, field, maximum, picture, wall="-", radius=0.55):
    bodies = []
    if wall != "-":
        bodies.append((read_arrays(f"{results}/vtk/{wall}_{0:05d}.vtp"), None))
    bodies.append((read_arrays(f"{results}/vtk/{body}_{int(number):05d}.vtp"), field))
    points = [p for arrays, _ in bodies for p in arrays["Points"]]
    low = [min(p[k] for p in points) for k in (0, 1)]
    high = [max(p[k] for p in points) for k in (0, 1)]
    margin = 0.01 * (high[0] - low[0])
    scale = WIDTH / (high[0] - low[0] + 2 * margin)
    height = round((high[1] - low[1] + 2 * margin) * scale)
    pixels = bytearray(b"\xff" * (3 * WIDTH * height))
    spacing = min(abs(a[0] - b[0]) + abs(a[1] - b[1]) for a, b in zip(bodies[0][0]["Points"], bodies[0][0]["Points"][1:]))
    radius = max(1.5, float(radius) * spacing * scale)
    for arrays, name in bodies:
        values = arrays[name] if name else [None] * len(arrays["Points"])
        for point, value in zip(arrays["Points"], values):
            rgb = (196, 199, 204)
            if value is not None:
                rgb = colour((value[0] if len(value) == 1 else sum(v * v for v in value) ** 0.5) / float(maximum))
            x, y = (point[0] - low[0] + margin) * scale, height - (point[1] - low[1] + margin) * scale
            for row in range(max(0, int(y - radius)), min(height, int(y + radius) + 2)):
                reach = radius * radius - (row - y) ** 2
                if reach < 0:
                    continue
                first = max(0, round(x - reach ** 0.5))
                last = min(WIDTH - 1, round(x + reach ** 0.5))
                if last >= first:
                    pixels[3 * (row * WIDTH + first):3 * (row * WIDTH + last + 1)] = bytes(rgb) * (last - first + 1)
    write_png(picture, pixels, WIDTH, height)


if __name__ == "__main__":
    if len(sys.argv) < 7:
        sys.exit(__doc__)
    main(*sys.argv[1:])
