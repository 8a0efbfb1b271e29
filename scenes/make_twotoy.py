#!/usr/bin/env python3
"""Writes twotoy.glb: a teddy bear and a toy soldier, of many parts, in a closed room without lights."""

from pathlib import Path

from gltf_builder import Scene
from shapes import arc, capsule, cone, curve, cylinder, icosphere, line, quad, revolve, room_sides, rounded_box, torus

WIDTH, DEPTH, HEIGHT = 5.0, 5.4, 3.0  # metres; the room stands on y = 0, centred on x = z = 0
SIDES = (("left", -1), ("right", 1))
SIDE_COLORS = {
    "floor": "floor",
    "ceiling": "ceiling",
    "back wall": "blue wall",
    "front wall": "blue wall",
    "left wall": "cream wall",
    "right wall": "cream wall",
}

COLORS = {
    "floor": (0.55, 0.42, 0.30),
    "ceiling": (0.80, 0.79, 0.76),
    "blue wall": (0.42, 0.56, 0.68),
    "cream wall": (0.76, 0.70, 0.58),
    "fur": (0.45, 0.24, 0.10),
    "light fur": (0.72, 0.50, 0.29),
    "dark": (0.035, 0.03, 0.03),
    "red": (0.62, 0.07, 0.05),
    "royal blue": (0.08, 0.14, 0.45),
    "gold": (0.78, 0.53, 0.12),
    "white": (0.80, 0.79, 0.76),
    "skin": (0.78, 0.52, 0.38),
    "pink": (0.75, 0.33, 0.32),
    "mint": (0.35, 0.66, 0.52),
    "wood": (0.60, 0.40, 0.22),
}


def build():
    scene = Scene("twotoy")
    paint = {name: scene.material(name, color) for name, color in COLORS.items()}
    shapes = {
        "ball": scene.shape("ball", icosphere(3)),
        "bead": scene.shape("bead", icosphere(2)),
        "limb": scene.shape("limb", capsule(0.5, 1.0, 20)),  # a unit thick, two long
        "cylinder": scene.shape("cylinder", cylinder(0.5, 1.0, 28)),
        "cone": scene.shape("cone", cone(0.5, 1.0, 28)),
    }
    _room(scene, paint)
    _bear(scene, paint, shapes)
    _soldier(scene, paint, shapes)
    _playthings(scene, paint, shapes)
    scene.camera("front", (0.3, 1.45, 2.5), (-0.02, 1.02, -0.3), 50, 4 / 3)
    scene.camera("back", (-0.55, 1.6, -2.5), (0.08, 1.08, 0.1), 56, 4 / 3)
    return scene


def _room(scene, paint):
    sides = room_sides((-WIDTH / 2, 0, -DEPTH / 2), (WIDTH / 2, HEIGHT, DEPTH / 2))
    for name, color in SIDE_COLORS.items():
        scene.place(name, quad(*sides[name]), paint[color])


class _Toy:
    """Parts in a group of their own, of shapes and colours by their names."""

    def __init__(self, scene, paint, shapes, name, **placement):
        self.scene, self.paint, self.shapes, self.name = scene, paint, shapes, name
        self.group = scene.group(name, **placement)

    def part(self, name, shape, color, **placement):
        known = self.shapes[shape] if isinstance(shape, str) else shape
        self.scene.place(f"{self.name} {name}", known, self.paint[color], self.group, **placement)

    def part_on(self, side, name, shape, color, **placement):
        """placement: that of the right one; the left one is its mirror image."""
        word, s = side
        x, y, z = placement["at"]
        placement["at"] = (s * x, y, z)
        if "turn" in placement:
            x, y, z = placement["turn"]
            placement["turn"] = (x, s * y, s * z)
        self.part(f"{word} {name}", shape, color, **placement)


def _bear(scene, paint, shapes):
    bear = _Toy(scene, paint, shapes, "bear", at=(-0.80, 0, -0.25), turn=(0, 18, 0))
    bear.part("body", "ball", "fur", at=(0, 0.72, 0), scale=(0.39, 0.46, 0.34))
    bear.part("belly", "ball", "light fur", at=(0, 0.68, 0.16), scale=(0.28, 0.33, 0.22))
    bear.part("tail", "bead", "fur", at=(0, 0.45, -0.33), scale=0.09)
    bear.part("head", "ball", "fur", at=(0, 1.36, 0.02), scale=(0.35, 0.31, 0.30))
    bear.part("snout", "ball", "light fur", at=(0, 1.29, 0.27), scale=(0.15, 0.115, 0.13))
    bear.part("nose", "bead", "dark", at=(0, 1.335, 0.385), scale=(0.05, 0.035, 0.035))
    for side in SIDES:
        bear.part_on(side, "eye", "bead", "dark", at=(0.125, 1.43, 0.275), scale=0.034)
        bear.part_on(side, "ear", "ball", "fur", at=(0.27, 1.61, 0), turn=(0, 0, -35), scale=(0.125, 0.13, 0.065))
        bear.part_on(
            side, "inner ear", "bead", "light fur", at=(0.275, 1.61, 0.04), turn=(0, 0, -35), scale=(0.08, 0.085, 0.045)
        )
        bear.part_on(side, "leg", "limb", "fur", at=(0.22, 0.26, 0.06), turn=(-12, 0, 6), scale=(0.25, 0.25, 0.25))
        bear.part_on(side, "foot", "ball", "fur", at=(0.24, 0.115, 0.17), turn=(0, 14, 0), scale=(0.145, 0.115, 0.22))
        bear.part_on(
            side, "sole", "bead", "light fur", at=(0.285, 0.125, 0.345), turn=(0, 14, 0), scale=(0.085, 0.075, 0.05)
        )
        bear.part_on(side, "bow", "cone", "red", at=(0.16, 1.06, 0.29), turn=(0, 0, 90), scale=(0.15, 0.15, 0.10))
    bear.part("left arm", "limb", "fur", at=(-0.43, 0.80, 0.08), turn=(-25, 0, -28), scale=(0.21, 0.26, 0.21))
    bear.part("left paw", "ball", "light fur", at=(-0.54, 0.58, 0.19), scale=0.118)
    bear.part("right arm", "limb", "fur", at=(0.47, 1.10, 0.04), turn=(-10, 0, -58), scale=(0.20, 0.26, 0.20))
    bear.part("right paw", "ball", "light fur", at=(0.70, 1.245, 0.02), scale=0.118)
    bear.part("bow knot", "bead", "red", at=(0, 1.06, 0.30), scale=(0.05, 0.05, 0.045))
    hat = scene.group("bear hat", bear.group, at=(0.05, 1.60, 0.02), turn=(-4, 0, -9))
    scene.place("bear hat cone", cone(0.19, 0.40, 40), paint["mint"], hat)
    scene.place("bear hat brim", torus(0.185, 0.025, 36, 12), paint["gold"], hat, at=(0, 0.02, 0))
    scene.place("bear hat stripe", torus(0.105, 0.014, 28, 8), paint["gold"], hat, at=(0, 0.19, 0))
    scene.place("bear hat pompon", shapes["bead"], paint["gold"], hat, at=(0, 0.41, 0), scale=0.055)


def _soldier(scene, paint, shapes):
    soldier = _Toy(scene, paint, shapes, "soldier", at=(0.80, 0, -0.35), turn=(0, -20, 0))
    soldier.part("stand", _stand(), "wood")
    jacket = curve(
        [
            (0.235, 0.78),
            (0.205, 0.90),
            (0.19, 0.98),
            (0.215, 1.12),
            (0.235, 1.24),
            (0.225, 1.33),
            (0.17, 1.40),
            (0.09, 1.43),
        ]
    )
    soldier.part("jacket", revolve([line((0, 0.78), (0.235, 0.78)), jacket, line((0.09, 1.43), (0, 1.43))], 40), "red")
    soldier.part("belt", torus(0.195, 0.028, 36, 12), "white", at=(0, 0.95, 0))
    soldier.part("buckle", rounded_box((-0.05, -0.04, -0.02), (0.05, 0.04, 0.02), 0.012), "gold", at=(0, 0.95, 0.225))
    for i in range(4):
        soldier.part(
            f"button {i + 1}", "bead", "gold", at=(0, 1.06 + 0.08 * i, (0.205, 0.224, 0.236, 0.222)[i]), scale=0.021
        )
    soldier.part("collar", "cylinder", "gold", at=(0, 1.40, 0), scale=(0.22, 0.07, 0.22))
    soldier.part("head", "ball", "skin", at=(0, 1.575, 0), scale=(0.15, 0.165, 0.15))
    soldier.part("nose", "bead", "skin", at=(0, 1.57, 0.155), scale=(0.026, 0.03, 0.035))
    for side in SIDES:
        soldier.part_on(side, "boot", _boot(), "dark", at=(0.11, 0.08, 0))
        soldier.part_on(side, "toe", "bead", "dark", at=(0.11, 0.125, 0.09), scale=(0.078, 0.045, 0.12))
        soldier.part_on(side, "leg", "cylinder", "royal blue", at=(0.11, 0.33, 0), scale=(0.165, 0.47, 0.165))
        soldier.part_on(
            side, "epaulette", "bead", "gold", at=(0.245, 1.325, 0), turn=(0, 0, -18), scale=(0.105, 0.04, 0.10)
        )
        soldier.part_on(side, "eye", "bead", "dark", at=(0.057, 1.605, 0.132), scale=0.019)
        soldier.part_on(side, "cheek", "bead", "pink", at=(0.085, 1.545, 0.112), scale=(0.032, 0.03, 0.02))
        soldier.part_on(
            side, "moustache", "limb", "dark", at=(0.045, 1.522, 0.142), turn=(0, 20, 68), scale=(0.03, 0.045, 0.026)
        )
    soldier.part("left arm", "limb", "red", at=(-0.31, 1.13, 0), turn=(0, 0, -10), scale=(0.125, 0.25, 0.125))
    soldier.part("left cuff", "cylinder", "gold", at=(-0.335, 0.90, 0), turn=(0, 0, -10), scale=(0.15, 0.07, 0.15))
    soldier.part("left hand", "bead", "skin", at=(-0.345, 0.855, 0), scale=0.07)
    soldier.part("right upper arm", "limb", "red", at=(0.34, 1.25, 0.02), turn=(0, 0, 62), scale=(0.125, 0.14, 0.125))
    soldier.part("right forearm", "limb", "red", at=(0.329, 1.42, 0.072), turn=(12, 0, 40), scale=(0.12, 0.17, 0.12))
    soldier.part(
        "right cuff", "cylinder", "gold", at=(0.272, 1.487, 0.092), turn=(12, 0, 40), scale=(0.145, 0.06, 0.145)
    )
    soldier.part("right hand", "bead", "skin", at=(0.183, 1.59, 0.122), turn=(12, 0, 40), scale=(0.045, 0.075, 0.065))
    shako = [
        line((0, 1.64), (0.165, 1.64)),
        line((0.165, 1.64), (0.195, 2.0)),
        arc((0.17, 2.0), 0.025, 0, 90, 4) + line((0.17, 2.025), (0, 2.025)),
    ]
    soldier.part("hat", revolve(shako, 40), "dark")
    soldier.part("hat band", torus(0.168, 0.016, 36, 10), "gold", at=(0, 1.665, 0))
    soldier.part("visor", "bead", "dark", at=(0, 1.655, 0.13), turn=(14, 0, 0), scale=(0.125, 0.014, 0.11))
    soldier.part("badge", "bead", "gold", at=(0, 1.84, 0.18), turn=(-5, 0, 0), scale=(0.06, 0.075, 0.018))
    soldier.part("plume", "limb", "red", at=(0, 2.09, 0.12), scale=(0.09, 0.13, 0.09))


def _stand():
    edge = arc((0.38, 0.03), 0.03, -90, 0, 4) + arc((0.38, 0.05), 0.03, 0, 90, 4)
    return revolve([line((0, 0), (0.38, 0)) + edge + line((0.38, 0.08), (0, 0.08))], 48)


def _boot():
    shaft = curve([(0.075, 0), (0.082, 0.08), (0.10, 0.24), (0.105, 0.30)])
    return revolve([line((0, 0), (0.075, 0)), shaft, line((0.105, 0.30), (0, 0.30))], 32)


def _playthings(scene, paint, shapes):
    block = scene.shape("block", rounded_box((-0.15, 0, -0.15), (0.15, 0.30, 0.15), 0.025))
    scene.place("red block", block, paint["red"], at=(-0.20, 0, -0.70), turn=(0, 12, 0))
    scene.place("mint block", block, paint["mint"], at=(0.15, 0, -0.77), turn=(0, -8, 0))
    scene.place("gold block", block, paint["gold"], at=(-0.04, 0.30, -0.73), turn=(0, 33, 0))
    scene.place("cream block", block, paint["white"], at=(-1.95, 0, -1.35), turn=(0, 40, 0))
    scene.place("toy ball", shapes["ball"], paint["royal blue"], at=(0.0, 0.20, 0.30), scale=0.20)
    scene.place("toy ball stripe", torus(0.195, 0.018, 36, 10), paint["white"], at=(0.0, 0.20, 0.30), turn=(25, 0, 30))


if __name__ == "__main__":
    build().write(Path(__file__).with_name("twotoy.glb"))
