"""Writes room.glb, three walls of a room with a lightmap layout in TEXCOORD_1, and the lightmap of each: the direct light of
one lamp, in closed form.

Usage: make_room.py LIGHTS.json
"""

import json
import math
import struct
import sys

# Corner, u, v, normal; v of the picture runs down along v.
WALLS = {
    "floor": ((0, 0, 0), (4, 0, 0), (0, 0, 3), (0, 1, 0)),
    "back": ((0, 2.5, 0), (4, 0, 0), (0, -2.5, 0), (0, 0, 1)),
    "side": ((0, 2.5, 3), (0, 0, -3), (0, -2.5, 0), (1, 0, 0)),
}
WIDTH, HEIGHT = 48, 40


def point(wall, u, v):
    corner, along, down, _ = wall
    return [c + u * a + v * d for c, a, d in zip(corner, along, down)]


def illumination(place, normal, light):
    way = [l - p for l, p in zip(light["position"], place)]
    distance = math.hypot(*way)
    cosine = max(0, sum(n * w for n, w in zip(normal, way)) / distance)
    return [i * cosine / (math.pi * distance**2) for i in light["intensity"]]


def rgbe(color):
    mantissa, exponent = math.frexp(max(color))
    return bytes(int(c * 256 / 2**exponent) for c in color) + bytes([exponent + 128])


def write_lightmap(name, wall, light):
    with open(name + ".hdr", "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode())
        for y in range(HEIGHT):
            for x in range(WIDTH):
                place = point(wall, (x + 0.5) / WIDTH, (y + 0.5) / HEIGHT)
                file.write(rgbe(illumination(place, wall[3], light)))


def write_scene():
    blob, views, accessors, meshes, nodes = b"", [], [], [], []

    def add(values, kind, count):
        nonlocal blob
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 4 * len(values)})
        code = "I" if kind == "SCALAR" else "f"
        accessors.append({"bufferView": len(views) - 1, "componentType": 5125 if code == "I" else 5126, "count": count,
                          "type": kind})
        if kind == "VEC3":
            accessors[-1].update(min=[min(values[a::3]) for a in range(3)], max=[max(values[a::3]) for a in range(3)])
        blob += struct.pack(f"<{len(values)}{code}", *values)
        return len(accessors) - 1

    for name, wall in WALLS.items():
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        attributes = {
            "POSITION": add([c for uv in corners for c in point(wall, *uv)], "VEC3", 4),
            "NORMAL": add([float(c) for c in wall[3] * 4], "VEC3", 4),
            "TEXCOORD_0": add([0.5] * 8, "VEC2", 4),
            "TEXCOORD_1": add([float(c) for uv in corners for c in uv], "VEC2", 4),
        }
        order = [0, 2, 1, 0, 3, 2]
        meshes.append({"primitives": [{"attributes": attributes, "indices": add(order, "SCALAR", 6)}]})
        nodes.append({"name": name, "mesh": len(meshes) - 1})
    gltf = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
                       "nodes": nodes, "meshes": meshes, "accessors": accessors, "bufferViews": views,
                       "buffers": [{"byteLength": len(blob)}]}).encode()
    gltf += b" " * (-len(gltf) % 4)
    with open("room.glb", "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(gltf) + len(blob)))
        file.write(struct.pack("<I4s", len(gltf), b"JSON") + gltf)
        file.write(struct.pack("<I4s", len(blob), b"BIN\0") + blob)


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as lights:
        lamp = json.load(lights)["lights"][0]
    write_scene()
    for wall_name, wall_shape in WALLS.items():
        write_lightmap(wall_name, wall_shape, lamp)
