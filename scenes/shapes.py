"""Triangle meshes of simple shapes: boxes, quads, spheres, surfaces of revolution, sheets.

Metres, +Y up, counter-clockwise seen from outside. Round shapes carry smooth normals and share vertices; flat ones
have vertices of their own on every face. Angles are degrees.
"""

import math
from dataclasses import dataclass, field


@dataclass
class Shape:
    positions: list = field(default_factory=list)
    normals: list = field(default_factory=list)
    triangles: list = field(default_factory=list)
    uvs: list = field(default_factory=list)  # empty, or one per position


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scaled(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(a, 1 / math.sqrt(dot(a, a)))


def joined(shapes):
    """One shape of several; no vertex is merged."""
    result = Shape()
    for shape in shapes:
        first = len(result.positions)
        result.positions += shape.positions
        result.normals += shape.normals
        result.uvs += shape.uvs
        result.triangles += [tuple(first + i for i in t) for t in shape.triangles]
    return result


# Flat shapes.


def quad(a, b, c, d, uvs=()):
    """Planar, corners counter-clockwise seen from its front."""
    normal = unit(cross(subtract(b, a), subtract(d, a)))
    return Shape([a, b, c, d], [normal] * 4, [(0, 1, 2), (0, 2, 3)], list(uvs))


def room_sides(low, high):
    """The corners of each side of a room by the side's name, as quad() wants them, seen from inside; front is +Z."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    return {
        "floor": [(x0, y0, z1), (x1, y0, z1), (x1, y0, z0), (x0, y0, z0)],
        "ceiling": [(x0, y1, z0), (x1, y1, z0), (x1, y1, z1), (x0, y1, z1)],
        "back wall": [(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0)],
        "front wall": [(x1, y0, z1), (x0, y0, z1), (x0, y1, z1), (x1, y1, z1)],
        "left wall": [(x0, y0, z1), (x0, y0, z0), (x0, y1, z0), (x0, y1, z1)],
        "right wall": [(x1, y0, z0), (x1, y0, z1), (x1, y1, z1), (x1, y1, z0)],
    }


def box(low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    return joined(
        [
            quad((x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)),
            quad((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)),
            quad((x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)),
            quad((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)),
            quad((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)),
            quad((x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)),
        ]
    )


def wall_with_opening(outer, inner, depth):
    """A planar wall with a rectangular opening and its reveal, `depth` deep behind the wall.

    outer, inner: four corners each, counter-clockwise from the front, in matching order. The ring around the opening
    shares its corners with the reveal, so that no edge ends in the middle of another.
    """
    behind = scaled(unit(cross(subtract(outer[1], outer[0]), subtract(outer[3], outer[0]))), -depth)
    ring = [(outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i]) for i in range(4)]
    reveal = [(inner[i], inner[(i + 1) % 4], add(inner[(i + 1) % 4], behind), add(inner[i], behind)) for i in range(4)]
    return joined([quad(*corners) for corners in ring + reveal])


# Round shapes.


def icosphere(subdivisions):
    """The unit sphere: 10·4^subdivisions + 2 vertices, one of them straight up and one straight down."""
    rings = [(1 / math.sqrt(5), 0), (-1 / math.sqrt(5), 36)]
    points = [(0.0, 1.0, 0.0)]
    for y, turn in rings:
        points += [
            (
                math.sqrt(1 - y * y) * math.cos(math.radians(72 * i + turn)),
                y,
                math.sqrt(1 - y * y) * math.sin(math.radians(72 * i + turn)),
            )
            for i in range(5)
        ]
    points.append((0.0, -1.0, 0.0))
    triangles = []
    for i in range(5):
        j = (i + 1) % 5
        triangles += [(0, 1 + j, 1 + i), (1 + i, 1 + j, 6 + i), (1 + j, 6 + j, 6 + i), (11, 6 + i, 6 + j)]
    for _ in range(subdivisions):
        triangles = _subdivided(points, triangles)
    return Shape(points, list(points), triangles)


def _subdivided(points, triangles):
    middles = {}

    def middle(a, b):
        edge = (min(a, b), max(a, b))
        if edge not in middles:
            middles[edge] = len(points)
            points.append(unit(add(points[a], points[b])))
        return middles[edge]

    result = []
    for a, b, c in triangles:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        result += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return result


# A profile is a list of pieces, each a list of (radius, height, normal_radial, normal_up), walked with the solid on the
# left: up along its outside. The surface is smooth within a piece and has a crease between pieces; line + arc is one
# piece of both.


def line(start, end):
    length = math.hypot(end[0] - start[0], end[1] - start[1])
    normal = ((end[1] - start[1]) / length, (start[0] - end[0]) / length)
    return [(*start, *normal), (*end, *normal)]


def arc(center, radius, start, end, steps):
    """Counter-clockwise from angle start to angle end; 0 points outwards, 90 up."""
    points = []
    for i in range(steps + 1):
        angle = math.radians(start + (end - start) * i / steps)
        c, s = math.cos(angle), math.sin(angle)
        reach = center[0] + radius * c
        points.append((reach if reach > 1e-9 else 0.0, center[1] + radius * s, c, s))
    return points


def curve(points):
    """Smooth through (radius, height) points; normals from the neighbours."""
    result = []
    for i, (r, y) in enumerate(points):
        before, after = points[max(i - 1, 0)], points[min(i + 1, len(points) - 1)]
        dr, dy = after[0] - before[0], after[1] - before[1]
        if r == 0:
            dr, dy = (1, 0) if i == 0 else (-1, 0)
        length = math.hypot(dr, dy)
        result.append((r, y, dy / length, -dr / length))
    return result


def revolve(profile, segments=32):
    """The surface that a profile sweeps around the y axis."""
    shape = Shape()
    for piece in profile:
        points = [p for i, p in enumerate(piece) if i == 0 or math.dist(p, piece[i - 1]) > 1e-9]
        closed = math.dist(points[0], points[-1]) < 1e-9
        rings = [_ring(shape, p, segments) for p in (points[:-1] if closed else points)]
        rings += rings[:1] if closed else []
        for low, high in zip(rings, rings[1:]):
            _stitch(shape, low, high, segments)
    return shape


def _ring(shape, point, segments):
    radius, height, normal_radial, normal_up = point
    first = len(shape.positions)
    smooth_pole = radius == 0 and abs(normal_radial) < 1e-6
    # The tip of a cone has no normal of its own: it gets one for every segment, in the segment's middle.
    turn = 0.5 if radius == 0 else 0.0
    for i in range(1 if smooth_pole else segments):
        angle = 2 * math.pi * (i + turn) / segments
        c, s = math.cos(angle), math.sin(angle)
        shape.positions.append((radius * c, height, radius * s))
        shape.normals.append((normal_radial * c, normal_up, normal_radial * s))
    return first, 0 if radius == 0 else segments, 1 if smooth_pole else segments


def _stitch(shape, low, high, segments):
    for i in range(segments):
        a, b = low[0] + i % low[2], low[0] + (i + 1) % segments % low[2]
        d, c = high[0] + i % high[2], high[0] + (i + 1) % segments % high[2]
        if high[1] > 0:
            shape.triangles.append((a, d, c))
        if low[1] > 0:
            shape.triangles.append((a, c, b) if high[1] > 0 else (a, d, b))


def cylinder(radius, height, segments=32):
    """Standing on y = 0."""
    return revolve(
        [line((0, 0), (radius, 0)), line((radius, 0), (radius, height)), line((radius, height), (0, height))], segments
    )


def cone(radius, height, segments=32):
    return revolve([line((0, 0), (radius, 0)), line((radius, 0), (0, height))], segments)


def capsule(radius, length, segments=24):
    """Around the y axis, its two centres at y = ±length / 2."""
    steps = segments // 4
    return revolve(
        [arc((0, -length / 2), radius, -90, 0, steps) + arc((0, length / 2), radius, 0, 90, steps)], segments
    )


def torus(ring_radius, tube_radius, segments=40, tube_segments=16):
    return revolve([arc((ring_radius, 0), tube_radius, -180, 180, tube_segments)], segments)


def tube(bottom_radius, top_radius, height, thickness, segments=40):
    """A conical shade or pipe, open at both ends, its wall `thickness` thick; radii are the outer ones."""
    b, t, w = bottom_radius, top_radius, thickness
    return revolve(
        [
            line((b, 0), (t, height)),
            line((t, height), (t - w, height)),
            line((t - w, height), (b - w, 0)),
            line((b - w, 0), (b, 0)),
        ],
        segments,
    )


def rounded_box(low, high, radius, steps=4, splits=1):
    """A box whose edges and corners are rounded in `steps`; its flat parts are split `splits` times each way."""
    half = [(h - l) / 2 - radius for l, h in zip(low, high)]
    center = [(h + l) / 2 for l, h in zip(low, high)]
    last = 2 * steps + splits
    shape, known = Shape(), {}

    def vertex(*lattice):
        if lattice not in known:
            known[lattice] = len(shape.positions)
            flat = [min(max(i - steps, 0), splits) * 2 / splits - 1 for i in lattice]
            bends = [min(i - steps, 0) + max(i - steps - splits, 0) for i in lattice]
            direction = unit([math.tan(b * math.pi / (4 * steps)) for b in bends])
            shape.positions.append(tuple(c + f * h + radius * d for c, f, h, d in zip(center, flat, half, direction)))
            shape.normals.append(direction)
        return known[lattice]

    for axis in range(3):
        for i in range(last):
            for j in range(last):
                for level in (0, last):
                    corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    a, b, c, d = (
                        vertex(*_on_axis(axis, level, u, v)) for u, v in (corners if level else corners[::-1])
                    )
                    shape.triangles += [(a, b, c), (a, c, d)]
    return shape


def _on_axis(axis, level, u, v):
    lattice = [0, 0, 0]
    lattice[axis], lattice[(axis + 1) % 3], lattice[(axis + 2) % 3] = level, u, v
    return lattice


# Cloth.


def with_smooth_normals(shape):
    """Normals averaged over the triangles around each vertex, by area."""
    sums = [(0.0, 0.0, 0.0)] * len(shape.positions)
    for triangle in shape.triangles:
        a, b, c = (shape.positions[i] for i in triangle)
        normal = cross(subtract(b, a), subtract(c, a))
        for i in triangle:
            sums[i] = add(sums[i], normal)
    shape.normals = [unit(n) for n in sums]
    return shape


def sheet(point, columns, rows, thickness):
    """A closed cloth: point(u, v), u and v in 0..1, is its front; the front faces ∂u × ∂v."""
    front = Shape([point(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)])
    at = lambda i, j: j * (columns + 1) + i  # noqa: E731
    for j in range(rows):
        for i in range(columns):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            front.triangles += [(a, b, c), (a, c, d)]
    with_smooth_normals(front)
    back = Shape(
        [subtract(p, scaled(n, thickness)) for p, n in zip(front.positions, front.normals)],
        [scaled(n, -1) for n in front.normals],
        [(a, c, b) for a, b, c in front.triangles],
    )
    border = (
        [at(i, 0) for i in range(columns)]
        + [at(columns, j) for j in range(rows)]
        + [at(i, rows) for i in range(columns, 0, -1)]
        + [at(0, j) for j in range(rows, 0, -1)]
    )
    rim = joined([_rim_quad(front, back, a, b) for a, b in zip(border, border[1:] + border[:1])])
    return joined([front, back, rim])


def _rim_quad(front, back, a, b):
    corners = [front.positions[b], front.positions[a], back.positions[a], back.positions[b]]
    normal = unit(cross(subtract(corners[2], corners[0]), subtract(corners[3], corners[1])))
    return Shape(corners, [normal] * 4, [(0, 1, 2), (0, 2, 3)])


def pillow(width, height, depth, steps=16):
    """Two bulging faces sewn together along a square rim, lying flat, centred on the origin."""
    shape, known = Shape(), {}

    def vertex(i, j, side):
        on_rim = i in (0, steps) or j in (0, steps)
        key = (i, j, 0 if on_rim else side)
        if key not in known:
            known[key] = len(shape.positions)
            u, v = 2 * i / steps - 1, 2 * j / steps - 1
            bulge = math.sqrt((1 - u**4) * (1 - v**4))
            shape.positions.append(
                (
                    width / 2 * u * (0.93 + 0.07 * v * v),
                    key[2] * height / 2 * bulge,
                    depth / 2 * v * (0.93 + 0.07 * u * u),
                )
            )
        return known[key]

    for side in (1, -1):
        for i in range(steps):
            for j in range(steps):
                corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
                a, b, c, d = (vertex(u, v, side) for u, v in corners[::side])
                shape.triangles += [(a, b, c), (a, c, d)]
    return with_smooth_normals(shape)
