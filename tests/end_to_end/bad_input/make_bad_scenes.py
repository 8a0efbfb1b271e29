#!/usr/bin/env python3
"""Writes nan.glb, a triangle with a corner that is not a number, and points.glb, a scene without triangles."""

import json
import struct


def write(path, positions, mode):
    binary = b"".join(struct.pack("<3f", *p) for p in positions)
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": mode}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": len(binary)}],
        "buffers": [{"byteLength": len(binary)}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


write("nan.glb", [(0, 0, 0), (1, float("nan"), 0), (0, 1, 0)], 4)
write("points.glb", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], 0)
