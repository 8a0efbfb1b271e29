"""Builds a scene of shapes, cameras and point lights and writes it as a binary glTF 2.0 file, always the same."""

import json
import math
import struct
from pathlib import Path

from shapes import add, cross, dot, scaled, subtract, unit

FLOAT, UINT16, UINT32 = 5126, 5123, 5125
VERTICES, INDICES = 34962, 34963  # bufferView targets


def tidy(values, digits=6):
    """Micrometres are enough; rounding also drops the last bits in which mathematics libraries differ."""
    return [round(v, digits) + 0.0 for v in values]


def quaternion(x=0.0, y=0.0, z=0.0):
    """Of turns in degrees about the x axis, then y, then z."""
    result = (0.0, 0.0, 0.0, 1.0)
    for axis, angle in (((1, 0, 0), x), ((0, 1, 0), y), ((0, 0, 1), z)):
        half = math.radians(angle) / 2
        result = _product((*scaled(axis, math.sin(half)), math.cos(half)), result)
    return result


def look_at_quaternion(eye, target):
    """Turns -Z to the target and keeps +Y up."""
    z = unit(subtract(eye, target))
    x = unit(cross((0, 1, 0), z))
    pitch = math.degrees(math.atan2(-z[1], math.hypot(z[0], z[2])))
    yaw = math.degrees(math.atan2(-x[2], x[0]))
    return quaternion(x=pitch, y=yaw)


def _product(a, b):
    v = add(add(scaled(b[:3], a[3]), scaled(a[:3], b[3])), cross(a[:3], b[:3]))
    return (*v, a[3] * b[3] - dot(a[:3], b[:3]))


def _rotated(q, v):
    t = scaled(cross(q[:3], v), 2)
    return add(add(v, scaled(t, q[3])), cross(q[:3], t))


class Scene:
    def __init__(self, title):
        self.title = title
        self.nodes, self.materials, self.cameras, self.lights, self.images = [], [], [], [], []
        self.shapes, self.meshes = [], []  # shapes: (name, Shape); meshes: (shape, material)
        self.parents = {}

    def material(self, name, color, **options):
        """color: linear Rec.709 albedo. options: roughness (1), metallic (0), texture (PNG bytes)."""
        surface = {
            "baseColorFactor": [*color, 1.0],
            "metallicFactor": options.get("metallic", 0.0),
            "roughnessFactor": options.get("roughness", 1.0),
        }
        if "texture" in options:
            surface["baseColorTexture"] = {"index": len(self.images)}
            self.images.append(options["texture"])
        self.materials.append({"name": name, "pbrMetallicRoughness": surface})
        return len(self.materials) - 1

    def shape(self, name, shape):
        """A shape kept once in the file, however many nodes show it."""
        self.shapes.append((name, shape))
        return len(self.shapes) - 1

    def group(self, name, parent=None, **placement):
        return self._node({"name": name, **_transform(**placement)}, parent)

    def place(self, name, shape, material, parent=None, **placement):
        """placement: at (metres), turn (degrees about x, y, z, in this order), scale (a number or three)."""
        if not isinstance(shape, int):
            shape = self.shape(name, shape)
        if (shape, material) not in self.meshes:
            self.meshes.append((shape, material))
        mesh = self.meshes.index((shape, material))
        return self._node({"name": name, "mesh": mesh, **_transform(**placement)}, parent)

    def camera(self, name, eye, target, vertical_fov, aspect_ratio):
        self.cameras.append(
            {
                "name": name,
                "type": "perspective",
                "perspective": {
                    "yfov": round(math.radians(vertical_fov), 6),
                    "aspectRatio": round(aspect_ratio, 6),
                    "znear": 0.01,
                },
            }
        )
        self._node(
            {
                "name": name,
                "camera": len(self.cameras) - 1,
                "translation": tidy(eye),
                "rotation": tidy(look_at_quaternion(eye, target), 8),
            }
        )

    def point_light(self, name, position, color, candela):
        self.lights.append({"name": name, "type": "point", "color": list(color), "intensity": candela})
        self._node(
            {
                "name": name,
                "translation": tidy(position),
                "extensions": {"KHR_lights_punctual": {"light": len(self.lights) - 1}},
            }
        )

    def _node(self, node, parent=None):
        self.nodes.append(node)
        if parent is not None:
            self.nodes[parent].setdefault("children", []).append(len(self.nodes) - 1)
            self.parents[len(self.nodes) - 1] = parent
        return len(self.nodes) - 1

    def world_triangles(self):
        """Every triangle drawn, as three points in world space."""
        for index, node in enumerate(self.nodes):
            if "mesh" not in node:
                continue
            shape = self.shapes[self.meshes[node["mesh"]][0]][1]
            points = [self._to_world(index, tidy(p)) for p in shape.positions]
            yield from (tuple(points[i] for i in t) for t in shape.triangles)

    def _to_world(self, index, point):
        while index is not None:
            node = self.nodes[index]
            point = [p * s for p, s in zip(point, node.get("scale", (1, 1, 1)))]
            point = _rotated(node.get("rotation", (0, 0, 0, 1)), point)
            point = add(point, node.get("translation", (0, 0, 0)))
            index = self.parents.get(index)
        return point

    def write(self, path):
        data = _Buffer()
        shapes = [data.shape(name, shape) for name, shape in self.shapes]
        document = {
            "asset": {"version": "2.0", "generator": "chiaro scenes/gltf_builder.py", "copyright": "Apache-2.0"},
            "scene": 0,
            "scenes": [{"name": self.title, "nodes": [i for i in range(len(self.nodes)) if i not in self.parents]}],
            "nodes": self.nodes,
            "meshes": [
                {"name": self.shapes[s][0], "primitives": [{**shapes[s], "material": m}]} for s, m in self.meshes
            ],
            "materials": self.materials,
            "cameras": self.cameras,
        }
        if self.images:
            document["images"] = [{"bufferView": data.view(png), "mimeType": "image/png"} for png in self.images]
            document["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}]
            document["textures"] = [{"sampler": 0, "source": i} for i in range(len(self.images))]
        if self.lights:
            document["extensionsUsed"] = ["KHR_lights_punctual"]
            document["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
        document |= {
            "accessors": data.accessors,
            "bufferViews": data.views,
            "buffers": [{"byteLength": len(data.bytes)}],
        }
        _write_glb(path, document, bytes(data.bytes))
        print(
            f"{Path(path).name}: {sum(1 for _ in self.world_triangles())} triangles in {len(self.nodes)} nodes, "
            f"{Path(path).stat().st_size} bytes"
        )


def _transform(at=None, turn=None, scale=None):
    node = {}
    if at is not None:
        node["translation"] = tidy(at)
    if turn is not None:
        node["rotation"] = tidy(quaternion(*turn), 8)
    if scale is not None:
        node["scale"] = tidy(scale if isinstance(scale, (tuple, list)) else [scale] * 3)
    return node


class _Buffer:
    def __init__(self):
        self.bytes, self.views, self.accessors = bytearray(), [], []

    def view(self, data, target=None):
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        if target is not None:
            self.views[-1]["target"] = target
        self.bytes += data + b"\0" * (-len(data) % 4)
        return len(self.views) - 1

    def floats(self, rows, kind, bounded=False):
        flat = [v for row in rows for v in tidy(row)]
        packed = struct.pack(f"<{len(flat)}f", *flat)
        self.accessors.append(
            {"bufferView": self.view(packed, VERTICES), "componentType": FLOAT, "count": len(rows), "type": kind}
        )
        if bounded:
            columns = list(zip(*[iter(struct.unpack(f"<{len(flat)}f", packed))] * 3))
            self.accessors[-1] |= {"min": [min(c) for c in zip(*columns)], "max": [max(c) for c in zip(*columns)]}
        return len(self.accessors) - 1

    def shape(self, name, shape):
        assert len(shape.normals) == len(shape.positions) and len(shape.uvs) in (0, len(shape.positions)), name
        attributes = {
            "POSITION": self.floats(shape.positions, "VEC3", bounded=True),
            "NORMAL": self.floats(shape.normals, "VEC3"),
        }
        if shape.uvs:
            attributes["TEXCOORD_0"] = self.floats(shape.uvs, "VEC2")
        flat = [i for t in shape.triangles for i in t]
        code, kind = ("H", UINT16) if len(shape.positions) < 65536 else ("I", UINT32)
        view = self.view(struct.pack(f"<{len(flat)}{code}", *flat), INDICES)
        self.accessors.append({"bufferView": view, "componentType": kind, "count": len(flat), "type": "SCALAR"})
        return {"attributes": attributes, "indices": len(self.accessors) - 1}


def _write_glb(path, document, binary):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    header = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary))
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    Path(path).write_bytes(header + chunks)
