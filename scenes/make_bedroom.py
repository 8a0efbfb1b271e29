#!/usr/bin/env python3
"""Writes bedroom.glb: a furnished bedroom in the evening, with a ceiling lamp and a bedside lamp."""

import math
import random
from pathlib import Path

from gltf_builder import Scene
from shapes import (
    arc,
    box,
    capsule,
    curve,
    cylinder,
    icosphere,
    joined,
    line,
    pillow,
    quad,
    revolve,
    room_sides,
    rounded_box,
    sheet,
    torus,
    tube,
    wall_with_opening,
    with_smooth_normals,
)
from wood_texture import wood_planks

# Metres; the floor is y = 0. The bed's head is at the back wall, the window in the left wall.
LEFT, RIGHT, BACK, FRONT, HEIGHT = -2.2, 2.2, -2.3, 2.3, 2.6
WINDOW_LOW, WINDOW_HIGH, WINDOW_BACK, WINDOW_FRONT = 0.85, 2.15, -1.15, 0.25
BED_LEFT, BED_RIGHT, BED_FOOT = -0.70, 0.90, -0.15
TABLE_LEFT, TABLE_RIGHT = -1.24, -0.80
CEILING_LAMP = (-0.15, 2.02, 0.15)
BEDSIDE_LAMP = (-1.02, 0.94, -2.02)

COLORS = {
    "teal wall": (0.20, 0.40, 0.42),
    "sand wall": (0.72, 0.62, 0.48),
    "ceiling": (0.82, 0.81, 0.78),
    "white paint": (0.78, 0.77, 0.74),
    "dark wood": (0.22, 0.12, 0.065),
    "light wood": (0.52, 0.34, 0.19),
    "linen": (0.80, 0.78, 0.73),
    "mustard": (0.62, 0.38, 0.12),
    "rust": (0.52, 0.16, 0.07),
    "teal": (0.10, 0.34, 0.36),
    "curtain": (0.62, 0.30, 0.22),
    "rug": (0.55, 0.50, 0.44),
    "shade": (0.62, 0.54, 0.42),
    "navy": (0.06, 0.09, 0.22),
    "sun": (0.80, 0.34, 0.06),
    "leaf": (0.16, 0.36, 0.10),
    "plum": (0.30, 0.09, 0.20),
}


def build():
    scene = Scene("bedroom")
    paint = {name: scene.material(name, color) for name, color in COLORS.items()}
    paint["planks"] = scene.material("planks", (1, 1, 1), roughness=0.55, texture=wood_planks())
    paint["brass"] = scene.material("brass", (0.80, 0.56, 0.24), metallic=1.0, roughness=0.35)
    for furnish in (
        _room,
        _window,
        _curtains,
        _bed,
        _bedside_table,
        _wardrobe,
        _bookshelf,
        _picture,
        _rug,
        _pendant,
        _stool,
    ):
        furnish(scene, paint)
    scene.camera("main", (1.15, 1.5, 2.15), (-0.42, 0.86, -1.2), 50, 16 / 9)
    scene.camera("bed", (-1.45, 1.25, 0.55), (-0.10, 0.62, -1.75), 48, 4 / 3)
    x, y, z = CEILING_LAMP
    scene.point_light("ceiling lamp", (x, y - 0.24, z), (1.0, 0.87, 0.70), 9.0)
    x, y, z = BEDSIDE_LAMP
    scene.point_light("bedside lamp", (x, y, z), (1.0, 0.72, 0.42), 1.8)
    return scene


def _room(scene, paint):
    sides = room_sides((LEFT, 0, BACK), (RIGHT, HEIGHT, FRONT))
    # One tile of the planks is 1.2 m across and 2.4 m along; they run along x.
    planks = [(z / 1.2, x / 2.4) for x, _, z in sides["floor"]]
    scene.place("floor", quad(*sides["floor"], uvs=planks), paint["planks"])
    scene.place("ceiling", quad(*sides["ceiling"]), paint["ceiling"])
    scene.place("back wall", quad(*sides["back wall"]), paint["teal wall"])
    scene.place("front wall", quad(*sides["front wall"]), paint["teal wall"])
    scene.place("right wall", quad(*sides["right wall"]), paint["sand wall"])
    inner = [
        (LEFT, WINDOW_LOW, WINDOW_FRONT),
        (LEFT, WINDOW_LOW, WINDOW_BACK),
        (LEFT, WINDOW_HIGH, WINDOW_BACK),
        (LEFT, WINDOW_HIGH, WINDOW_FRONT),
    ]
    scene.place("left wall", wall_with_opening(sides["left wall"], inner, 0.16), paint["sand wall"])


def _window(scene, paint):
    x0, x1 = LEFT - 0.11, LEFT - 0.05
    middle = (WINDOW_BACK + WINDOW_FRONT) / 2
    upper = WINDOW_LOW + 0.68 * (WINDOW_HIGH - WINDOW_LOW)
    bars = [
        ((x0, WINDOW_LOW, WINDOW_BACK), (x1, WINDOW_HIGH, WINDOW_BACK + 0.06)),
        ((x0, WINDOW_LOW, WINDOW_FRONT - 0.06), (x1, WINDOW_HIGH, WINDOW_FRONT)),
        ((x0, WINDOW_LOW, WINDOW_BACK + 0.06), (x1, WINDOW_LOW + 0.06, WINDOW_FRONT - 0.06)),
        ((x0, WINDOW_HIGH - 0.06, WINDOW_BACK + 0.06), (x1, WINDOW_HIGH, WINDOW_FRONT - 0.06)),
        ((x0, WINDOW_LOW + 0.06, middle - 0.035), (x1, WINDOW_HIGH - 0.06, middle + 0.035)),
        ((x0 + 0.01, upper - 0.02, WINDOW_BACK + 0.06), (x1 - 0.01, upper + 0.02, middle - 0.035)),
        ((x0 + 0.01, upper - 0.02, middle + 0.035), (x1 - 0.01, upper + 0.02, WINDOW_FRONT - 0.06)),
    ]
    scene.place("window frame", joined([box(*bar) for bar in bars]), paint["white paint"])
    sill = rounded_box(
        (LEFT, WINDOW_LOW - 0.05, WINDOW_BACK - 0.06), (LEFT + 0.14, WINDOW_LOW - 0.01, WINDOW_FRONT + 0.06), 0.01
    )
    scene.place("window sill", sill, paint["white paint"])


def _curtains(scene, paint):
    x, top, bottom, thickness = LEFT + 0.20, 2.34, 0.04, 0.006

    def curtain(start, end, folds):
        def point(u, v):
            z = start + (end - start) * u
            swing = 0.022 + 0.014 * (1 - v)
            return (
                x + swing * math.sin(2 * math.pi * folds * u),
                bottom + (top - bottom) * v,
                z + 0.12 * swing * math.sin(4 * math.pi * folds * u),
            )

        return sheet(lambda u, v: point(1 - u, v), 12 * folds, 6, thickness)

    scene.place("back curtain", curtain(WINDOW_BACK - 0.32, WINDOW_BACK + 0.20, 5), paint["curtain"])
    scene.place("front curtain", curtain(WINDOW_FRONT - 0.20, WINDOW_FRONT + 0.32, 5), paint["curtain"])
    rod_length = WINDOW_FRONT - WINDOW_BACK + 0.75
    middle = (WINDOW_FRONT + WINDOW_BACK) / 2
    scene.place(
        "curtain rod", capsule(0.014, rod_length, 12), paint["brass"], at=(x, top + 0.03, middle), turn=(90, 0, 0)
    )
    knob = scene.shape("rod end", icosphere(2))
    for end in (-1, 1):
        scene.place(
            "curtain rod end",
            knob,
            paint["brass"],
            at=(x, top + 0.03, middle + end * (rod_length / 2 + 0.02)),
            scale=0.03,
        )


def _bed(scene, paint):
    l, r, head, foot = BED_LEFT, BED_RIGHT, BACK + 0.10, BED_FOOT
    scene.place(
        "headboard", rounded_box((l - 0.04, 0.10, BACK + 0.02), (r + 0.04, 1.08, head), 0.03), paint["dark wood"]
    )
    for i in range(3):
        width = (r - l - 0.10) / 3
        x = l + 0.05 + i * width
        scene.place(
            "headboard panel",
            rounded_box((x + 0.02, 0.58, head), (x + width - 0.02, 1.00, head + 0.045), 0.02),
            paint["teal"],
        )
    scene.place(
        "bed frame",
        rounded_box((l - 0.03, 0.14, head + 0.005), (r + 0.03, 0.30, foot + 0.03), 0.02),
        paint["dark wood"],
    )
    leg = scene.shape("bed leg", box((-0.04, 0, -0.04), (0.04, 0.14, 0.04)))
    for x in (l + 0.04, r - 0.04):
        for z in (head + 0.10, foot - 0.05):
            scene.place("bed leg", leg, paint["dark wood"], at=(x, 0, z))
    scene.place("mattress", rounded_box((l, 0.30, head + 0.06), (r, 0.52, foot), 0.06, 6), paint["linen"])
    scene.place("blanket", _blanket(l, r, -1.42, foot), paint["mustard"])
    fold = rounded_box((l - 0.055, 0.50, -1.53), (r + 0.055, 0.585, -1.22), 0.04, 5)
    scene.place("folded sheet", fold, paint["linen"])
    cushion, small = scene.shape("pillow", pillow(0.70, 0.22, 0.46)), scene.shape("cushion", pillow(0.42, 0.20, 0.42))
    scene.place("left pillow", cushion, paint["linen"], at=(-0.31, 0.665, -1.93), turn=(38, 2, 0))
    scene.place("right pillow", cushion, paint["linen"], at=(0.50, 0.665, -1.93), turn=(38, -3, 0))
    scene.place("teal cushion", small, paint["teal"], at=(-0.20, 0.725, -1.72), turn=(58, 8, 0))
    scene.place("rust cushion", small, paint["rust"], at=(0.26, 0.725, -1.71), turn=(58, -10, 0))


def _blanket(left, right, start, foot):
    """Lies on the mattress and hangs down at its sides and foot, with soft folds."""
    out, top, hem = 0.045, 0.555, 0.22
    shape = rounded_box((left - out, hem, start), (right + out, top, foot + out), 0.075, 3, 24)

    def folded(point, normal):
        x, y, z = point
        hang = min(max((top - 0.08 - y) / (top - hem), 0), 1)
        sideways = math.hypot(normal[0], normal[2])
        fold = 0.030 * hang * sideways * math.sin(23 * z + 3 * y) * math.cos(21 * x + 2 * y)
        crease = 0.007 * (1 - sideways) * math.sin(7 * x + 4 * z) * math.sin(9 * z - 3 * x)
        return (x + fold * normal[0], y + (crease if y > hem + 0.1 else 0), z + fold * normal[2])

    shape.positions = [folded(p, n) for p, n in zip(shape.positions, shape.normals)]
    return with_smooth_normals(shape)


def _bedside_table(scene, paint):
    l, r, back, front = TABLE_LEFT, TABLE_RIGHT, BACK + 0.03, BACK + 0.46
    scene.place("table top", rounded_box((l, 0.50, back), (r, 0.535, front), 0.012), paint["light wood"])
    scene.place(
        "table drawer", box((l + 0.03, 0.34, back + 0.02), (r - 0.03, 0.50, front - 0.03)), paint["white paint"]
    )
    scene.place(
        "drawer front",
        rounded_box((l + 0.05, 0.36, front - 0.03), (r - 0.05, 0.48, front - 0.012), 0.006),
        paint["white paint"],
    )
    scene.place("drawer knob", icosphere(2), paint["brass"], at=((l + r) / 2, 0.42, front + 0.002), scale=0.015)
    leg = scene.shape(
        "table leg",
        revolve([line((0, 0), (0.014, 0)), line((0.014, 0), (0.022, 0.34)), line((0.022, 0.34), (0, 0.34))], 16),
    )
    for x in (l + 0.06, r - 0.06):
        for z in (back + 0.05, front - 0.06):
            scene.place("table leg", leg, paint["light wood"], at=(x, 0, z))
    x, _, z = BEDSIDE_LAMP
    base = revolve(
        [line((0, 0), (0.085, 0)), arc((0.085, 0.012), 0.012, -90, 90, 6) + line((0.085, 0.024), (0, 0.024))], 32
    )
    scene.place("lamp foot", base, paint["brass"], at=(x, 0.535, z))
    scene.place("lamp pole", cylinder(0.011, 0.30, 16), paint["brass"], at=(x, 0.559, z))
    scene.place("lamp shade", tube(0.17, 0.10, 0.23, 0.004), paint["shade"], at=(x, 0.83, z))
    scene.place(
        "bedside book",
        box((-0.10, 0, -0.07), (0.10, 0.028, 0.07)),
        paint["rust"],
        at=(x + 0.08, 0.535, z + 0.21),
        turn=(0, 14, 0),
    )


def _wardrobe(scene, paint):
    l, r, back, front, top = 1.12, 2.16, BACK + 0.02, BACK + 0.60, 2.12
    scene.place("wardrobe", box((l, 0.07, back), (r, top, front)), paint["white paint"])
    scene.place("wardrobe plinth", box((l + 0.03, 0, back), (r - 0.03, 0.07, front - 0.03)), paint["dark wood"])
    scene.place(
        "wardrobe cornice",
        rounded_box((l - 0.03, top, back), (r + 0.03, top + 0.06, front + 0.04), 0.015),
        paint["white paint"],
    )
    middle = (l + r) / 2
    handle = scene.shape("wardrobe handle", capsule(0.009, 0.16, 12))
    for side, x0, x1, grip in (
        ("left", l + 0.01, middle - 0.004, middle - 0.05),
        ("right", middle + 0.004, r - 0.01, middle + 0.05),
    ):
        scene.place(f"{side} door", box((x0, 0.09, front), (x1, top - 0.02, front + 0.02)), paint["white paint"])
        for y0, y1 in ((0.19, 0.90), (1.02, top - 0.12)):
            panel = rounded_box((x0 + 0.08, y0, front + 0.02), (x1 - 0.08, y1, front + 0.036), 0.007, 2)
            scene.place(f"{side} door panel", panel, paint["light wood"])
        scene.place(f"{side} handle", handle, paint["brass"], at=(grip, 1.0, front + 0.045))


def _bookshelf(scene, paint):
    l, r, back, front, top, board = -2.17, -1.36, BACK + 0.01, BACK + 0.29, 1.76, 0.025
    levels = [0.06, 0.48, 0.90, 1.32]
    boards = [
        ((l, 0, back), (l + board, top, front)),
        ((r - board, 0, back), (r, top, front)),
        ((l + board, 0.06, back), (r - board, top, back + 0.01)),
        ((l, top, back), (r, top + board, front)),
    ]
    boards += [((l + board, y - board, back + 0.01), (r - board, y, front - 0.01)) for y in levels]
    scene.place("bookshelf", joined([box(*b) for b in boards]), paint["light wood"])
    dice = random.Random(7)
    book = scene.shape("book", box((0, 0, 0), (1, 1, 1)))
    covers = [paint[c] for c in ("rust", "navy", "teal", "mustard", "linen", "plum", "leaf", "white paint")]
    for y, fill in zip(levels, (0.94, 0.62, 0.86, 0.50)):
        x = l + board + 0.012
        while x < l + fill * (r - l) - 0.05:
            width, height, depth = dice.uniform(0.022, 0.05), dice.uniform(0.22, 0.33), dice.uniform(0.15, 0.20)
            scene.place(
                "book",
                book,
                covers[dice.randrange(len(covers))],
                at=(x, y, front - 0.035 - depth),
                scale=(width, height, depth),
            )
            x += width + 0.002
    vase = [
        line((0, 0), (0.045, 0)),
        curve([(0.045, 0), (0.075, 0.06), (0.068, 0.12), (0.030, 0.18), (0.038, 0.22)]),
        line((0.038, 0.22), (0, 0.22)),
    ]
    scene.place("vase", revolve(vase, 32), paint["teal"], at=(r - 0.16, levels[3], front - 0.13))
    scene.place(
        "shelf box",
        rounded_box((-0.11, 0, -0.09), (0.11, 0.15, 0.09), 0.012),
        paint["mustard"],
        at=(r - 0.19, levels[1], front - 0.13),
    )


def _picture(scene, paint):
    x0, x1, y0, y1, z = -0.36, 0.56, 1.36, 1.98, BACK + 0.01
    frame = [
        ((x0, y0, z), (x1, y0 + 0.04, z + 0.03)),
        ((x0, y1 - 0.04, z), (x1, y1, z + 0.03)),
        ((x0, y0 + 0.04, z), (x0 + 0.04, y1 - 0.04, z + 0.03)),
        ((x1 - 0.04, y0 + 0.04, z), (x1, y1 - 0.04, z + 0.03)),
    ]
    scene.place("picture frame", joined([box(*b) for b in frame]), paint["dark wood"])
    scene.place("picture mat", box((x0 + 0.04, y0 + 0.04, z), (x1 - 0.04, y1 - 0.04, z + 0.008)), paint["linen"])
    a, b, c, d, front = x0 + 0.12, x1 - 0.12, y0 + 0.12, y1 - 0.12, z + 0.012
    sky, horizon = (c + d) / 2 - 0.04, z + 0.008
    scene.place("picture sky", box((a, sky, horizon), (b, d, front)), paint["navy"])
    scene.place("picture field", box((a, c, horizon), (b, sky, front)), paint["leaf"])
    sun = cylinder(0.075, 0.004, 32)
    scene.place("picture sun", sun, paint["sun"], at=(0.24, sky + 0.13, front), turn=(90, 0, 0))


def _rug(scene, paint):
    def disc(radius, height):
        rim = arc((radius - height / 2, height / 2), height / 2, -90, 90, 6)
        return revolve(
            [line((0, 0), (radius - height / 2, 0)) + rim + line((radius - height / 2, height), (0, height))], 56
        )

    at = (-0.75, 0, 0.75)
    scene.place("rug", disc(0.95, 0.014), paint["rug"], at=at)
    scene.place("rug ring", disc(0.74, 0.004), paint["rust"], at=(at[0], 0.014, at[2]))
    scene.place("rug middle", disc(0.66, 0.004), paint["rug"], at=(at[0], 0.018, at[2]))


def _pendant(scene, paint):
    x, y, z = CEILING_LAMP
    scene.place("pendant rose", cylinder(0.05, 0.025, 32), paint["brass"], at=(x, HEIGHT - 0.026, z))
    scene.place(
        "pendant cord", cylinder(0.006, HEIGHT - 0.026 - (y + 0.16), 10), paint["dark wood"], at=(x, y + 0.16, z)
    )
    outer = arc((0, 0), 0.25, 10, 84, 16)
    inner = [(r, h, -a, -b) for r, h, a, b in arc((0, 0), 0.244, 84, 10, 16)]
    rim_top = line(outer[-1][:2], inner[0][:2])
    rim_bottom = line(inner[-1][:2], outer[0][:2])
    scene.place("pendant shade", revolve([outer, rim_top, inner, rim_bottom], 40), paint["shade"], at=(x, y - 0.09, z))


def _stool(scene, paint):
    at = (1.62, 0, -0.75)
    seat = [line((0, 0), (0.20, 0)) + arc((0.20, 0.035), 0.035, -90, 90, 8) + line((0.20, 0.07), (0, 0.07))]
    scene.place("stool seat", revolve(seat, 40), paint["mustard"], at=(at[0], 0.40, at[2]))
    leg = scene.shape("stool leg", capsule(0.016, 0.40, 12))
    for i in range(3):
        angle = math.radians(120 * i + 30)
        scene.place(
            "stool leg",
            leg,
            paint["light wood"],
            at=(at[0] + 0.16 * math.cos(angle), 0.216, at[2] + 0.16 * math.sin(angle)),
        )
    scene.place("stool ring", torus(0.16, 0.009, 40, 8), paint["brass"], at=(at[0], 0.16, at[2]))


if __name__ == "__main__":
    build().write(Path(__file__).with_name("bedroom.glb"))
