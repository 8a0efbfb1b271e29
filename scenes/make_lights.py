#!/usr/bin/env python3
"""Writes lights/SCENE-N.json: N point lights in the free space of a scene, random but always the same."""

import functools
import json
import math
import random
from pathlib import Path

import make_bedroom
import make_cornell
import make_fiveballs
import make_twotoy
from shapes import add, cross, dot, scaled, subtract

# scene, number of lights, region (low and high corner, metres), luminous intensity (lowest and highest, candela),
# least distance between two lights as a part of the scene's diagonal, seed
FIVEBALLS = (make_fiveballs.build, ((-2.7, 0.6, -2.7), (2.7, 2.8, 2.7)))
SETS = {
    "fiveballs-1": (*FIVEBALLS, 1, (16.0, 20.0), 0.08, 5),
    "fiveballs-3": (*FIVEBALLS, 3, (4.0, 16.0), 0.08, 2),
    "fiveballs-5": (*FIVEBALLS, 5, (2.5, 12.0), 0.08, 1),
    "fiveballs-6": (*FIVEBALLS, 6, (2.0, 10.0), 0.08, 1),
    "fiveballs-7": (*FIVEBALLS, 7, (2.0, 10.0), 0.08, 1),
    "fiveballs-9": (*FIVEBALLS, 9, (2.0, 8.0), 0.05, 1),
    "fiveballs-11": (*FIVEBALLS, 11, (2.0, 8.0), 0.05, 1),
    "twotoy-2": (make_twotoy.build, ((-2.5, 0.6, -2.7), (2.5, 2.8, 2.7)), 2, (6.0, 14.0), 0.08, 7),
    "bedroom-3": (make_bedroom.build, ((-2.0, 0.6, -2.1), (2.0, 2.3, 2.1)), 3, (4.0, 10.0), 0.08, 3),
    "cornell-1": (make_cornell.build, ((-0.6, 0.9, -0.3), (0.6, 1.75, 0.8)), 1, (2.0, 4.0), 0.08, 5),
}
SURFACE_CLEARANCE = 0.03  # of the diagonal

# Rec.709; brought to the same luminance before use. Lights take one of the first and one of the second in turn.
WHITES = {
    "candle": (1.0, 0.62, 0.30),
    "bulb": (1.0, 0.78, 0.52),
    "daylight": (0.82, 0.92, 1.0),
    "sky": (0.52, 0.72, 1.0),
    "amber": (1.0, 0.66, 0.22),
    "white": (1.0, 1.0, 1.0),
}
COLORS = {
    "rose": (1.0, 0.50, 0.58),
    "mint": (0.50, 1.0, 0.68),
    "lilac": (0.74, 0.56, 1.0),
    "coral": (1.0, 0.52, 0.36),
    "aqua": (0.42, 0.90, 0.96),
}
LUMINANCE = (0.2126, 0.7152, 0.0722)


def make_set(name):
    build, region, count, candela, spacing, seed = SETS[name]
    triangles = _triangles(build)
    diagonal = _diagonal(triangles)
    dice = random.Random(f"{name} {seed}")
    tints = _tints(dice, count)
    lights = []
    while len(lights) < count:
        position = tuple(round(dice.uniform(low, high), 3) for low, high in zip(*region))
        if any(math.dist(position, other["position"]) < spacing * diagonal for other in lights):
            continue
        if not _is_free(position, triangles, SURFACE_CLEARANCE * diagonal):
            continue
        tint, color = tints[len(lights)]
        level = candela[0] * (candela[1] / candela[0]) ** dice.random() / dot(color, LUMINANCE)
        lights.append(
            {
                "name": f"{tint} {len(lights) + 1}",
                "type": "point",
                "position": list(position),
                "intensity": [round(level * c, 3) for c in color],
            }
        )
    return lights


def _tints(dice, count):
    whites, colors = list(WHITES.items()), list(COLORS.items())
    dice.shuffle(whites)
    dice.shuffle(colors)
    return [(colors if i % 2 else whites)[i // 2] for i in range(count)]


@functools.cache
def _triangles(build):
    return list(build().world_triangles())


def _diagonal(triangles):
    points = [p for t in triangles for p in t]
    return math.dist([min(p[i] for p in points) for i in range(3)], [max(p[i] for p in points) for i in range(3)])


def _is_free(position, triangles, clearance):
    """Away from every surface, and outside every solid: the nearest surface each way turns its front to us."""
    near = (t for t in triangles if math.dist(position, t[0]) - _longest_edge(t) < clearance)
    if any(_distance(position, t) < clearance for t in near):
        return False
    ways = [
        (0.97, 0.13, 0.21),
        (-0.96, 0.17, -0.22),
        (0.15, 0.98, 0.11),
        (0.12, -0.97, 0.19),
        (0.19, 0.14, 0.97),
        (-0.16, 0.11, -0.98),
    ]
    return all(_sees_a_front(position, way, triangles) for way in ways)


def _sees_a_front(origin, way, triangles):
    nearest, front = math.inf, True
    for a, b, c in triangles:
        normal = cross(subtract(b, a), subtract(c, a))
        slope = dot(normal, way)
        if slope == 0:
            continue
        t = dot(normal, subtract(a, origin)) / slope
        if 0 < t < nearest and _inside(add(origin, scaled(way, t)), (a, b, c), normal):
            nearest, front = t, slope < 0
    return front


def _inside(point, triangle, normal):
    return all(
        dot(cross(subtract(triangle[(i + 1) % 3], triangle[i]), subtract(point, triangle[i])), normal) >= 0
        for i in range(3)
    )


def _distance(point, triangle):
    a, b, c = triangle
    normal = cross(subtract(b, a), subtract(c, a))
    area = dot(normal, normal)
    if area > 0:
        height = dot(subtract(point, a), normal) / area
        if _inside(subtract(point, scaled(normal, height)), triangle, normal):
            return abs(height) * math.sqrt(area)
    return min(_distance_to_edge(point, p, q) for p, q in ((a, b), (b, c), (c, a)))


@functools.cache
def _longest_edge(triangle):
    return max(math.dist(triangle[i], triangle[i - 1]) for i in range(3))


def _distance_to_edge(point, start, end):
    edge = subtract(end, start)
    part = min(max(dot(subtract(point, start), edge) / max(dot(edge, edge), 1e-30), 0.0), 1.0)
    return math.dist(point, add(start, scaled(edge, part)))


def _json(lights):
    return '{"lights": [\n' + ",\n".join("  " + json.dumps(light) for light in lights) + "\n]}\n"


def main():
    folder = Path(__file__).with_name("lights")
    folder.mkdir(exist_ok=True)
    for name in SETS:
        (folder / f"{name}.json").write_text(_json(make_set(name)))
        print(f"lights/{name}.json")


if __name__ == "__main__":
    main()
