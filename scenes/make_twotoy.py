#!/usr/bin/env python3
"""Writes twotoy.glb: a teddy bear and a toy soldier, of many parts, in a closed room without lights."""

from pathlib import Path

from gltf_builder import Scene
from shapes import arc, capsule, cone, curve, cylinder, icosphere, line, quad, revolve, rounded_box, torus

WIDTH, DEPTH, HEIGHT = 5.0, 5.4, 3.0  # metres; the room stands on y = 0, centred on x = z = 0
SIDES = (("left", -1), ("right", 1))

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


def _known(shapes, shape):
    return shapes[shape] if isinstance(shape, str) else shape


def _room(scene, paint):
    w, d, h = WIDTH / 2, DEPTH / 2, HEIGHT
    scene.place("floor", quad((-w, 0, d), (w, 0, d), (w, 0, -d), (-w, 0, -d)), paint["floor"])
    scene.place("ceiling", quad((-w, h, -d), (w, h, -d), (w, h, d), (-w, h, d)), paint["ceiling"])
    scene.place("back wall", quad((-w, 0, -d), (w, 0, -d), (w, h, -d), (-w, h, -d)), paint["blue wall"])
    scene.place("front wall", quad((w, 0, d), (-w, 0, d), (-w, h, d), (w, h, d)), paint["blue wall"])
    scene.place("left wall", quad((-w, 0, d), (-w, 0, -d), (-w, h, -d), (-w, h, d)), paint["cream wall"])
    scene.place("right wall", quad((w, 0, -d), (w, 0, d), (w, h, d), (w, h, -d)), paint["cream wall"])


def _bear(scene, paint, shapes):
    bear = scene.group("bear", at=(-0.80, 0, -0.25), turn=(0, 18, 0))

    def part(name, shape, color, **placement):
        scene.place(f"bear {name}", _known(shapes, shape), paint[color], bear, **placement)

    part("body", "ball", "fur", at=(0, 0.72, 0), scale=(0.39, 0.46, 0.34))
    part("belly", "ball", "light fur", at=(0, 0.68, 0.16), scale=(0.28, 0.33, 0.22))
    part("tail", "bead", "fur", at=(0, 0.45, -0.33), scale=0.09)
    part("head", "ball", "fur", at=(0, 1.36, 0.02), scale=(0.35, 0.31, 0.30))
    part("snout", "ball", "light fur", at=(0, 1.29, 0.27), scale=(0.15, 0.115, 0.13))
    part("nose", "bead", "dark", at=(0, 1.335, 0.385), scale=(0.05, 0.035, 0.035))
    for side, s in SIDES:
        part(f"{side} eye", "bead", "dark", at=(s * 0.125, 1.43, 0.275), scale=0.034)
        part(f"{side} ear", "ball", "fur", at=(s * 0.27, 1.61, 0), turn=(0, 0, -s * 35), scale=(0.125, 0.13, 0.065))
        part(
            f"{side} inner ear",
            "bead",
            "light fur",
            at=(s * 0.275, 1.61, 0.04),
            turn=(0, 0, -s * 35),
            scale=(0.08, 0.085, 0.045),
        )
        part(f"{side} leg", "limb", "fur", at=(s * 0.22, 0.26, 0.06), turn=(-12, 0, s * 6), scale=(0.25, 0.25, 0.25))
        part(f"{side} foot", "ball", "fur", at=(s * 0.24, 0.115, 0.17), turn=(0, s * 14, 0), scale=(0.145, 0.115, 0.22))
        part(
            f"{side} sole",
            "bead",
            "light fur",
            at=(s * 0.285, 0.125, 0.345),
            turn=(0, s * 14, 0),
            scale=(0.085, 0.075, 0.05),
        )
        part(f"{side} bow", "cone", "red", at=(s * 0.16, 1.06, 0.29), turn=(0, 0, s * 90), scale=(0.15, 0.15, 0.10))
    part("left arm", "limb", "fur", at=(-0.43, 0.80, 0.08), turn=(-25, 0, -28), scale=(0.21, 0.26, 0.21))
    part("left paw", "ball", "light fur", at=(-0.54, 0.58, 0.19), scale=0.118)
    part("right arm", "limb", "fur", at=(0.47, 1.10, 0.04), turn=(-10, 0, -58), scale=(0.20, 0.26, 0.20))
    part("right paw", "ball", "light fur", at=(0.70, 1.245, 0.02), scale=0.118)
    part("bow knot", "bead", "red", at=(0, 1.06, 0.30), scale=(0.05, 0.05, 0.045))
    hat = scene.group("bear hat", bear, at=(0.05, 1.60, 0.02), turn=(-4, 0, -9))
    scene.place("bear hat cone", cone(0.19, 0.40, 40), paint["mint"], hat)
    scene.place("bear hat brim", torus(0.185, 0.025, 36, 12), paint["gold"], hat, at=(0, 0.02, 0))
    scene.place("bear hat stripe", torus(0.105, 0.014, 28, 8), paint["gold"], hat, at=(0, 0.19, 0))
    scene.place("bear hat pompon", shapes["bead"], paint["gold"], hat, at=(0, 0.41, 0), scale=0.055)


def _soldier(scene, paint, shapes):
    soldier = scene.group("soldier", at=(0.80, 0, -0.35), turn=(0, -20, 0))

    def part(name, shape, color, **placement):
        scene.place(f"soldier {name}", _known(shapes, shape), paint[color], soldier, **placement)

    part("stand", _stand(), "wood")
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
    part("jacket", revolve([line((0, 0.78), (0.235, 0.78)), jacket, line((0.09, 1.43), (0, 1.43))], 40), "red")
    part("belt", torus(0.195, 0.028, 36, 12), "white", at=(0, 0.95, 0))
    part("buckle", rounded_box((-0.05, -0.04, -0.02), (0.05, 0.04, 0.02), 0.012), "gold", at=(0, 0.95, 0.225))
    for i in range(4):
        part(f"button {i + 1}", "bead", "gold", at=(0, 1.06 + 0.08 * i, (0.205, 0.224, 0.236, 0.222)[i]), scale=0.021)
    part("collar", "cylinder", "gold", at=(0, 1.40, 0), scale=(0.22, 0.07, 0.22))
    part("head", "ball", "skin", at=(0, 1.575, 0), scale=(0.15, 0.165, 0.15))
    part("nose", "bead", "skin", at=(0, 1.57, 0.155), scale=(0.026, 0.03, 0.035))
    for side, s in SIDES:
        part(f"{side} boot", _boot(), "dark", at=(s * 0.11, 0.08, 0))
        part(f"{side} toe", "bead", "dark", at=(s * 0.11, 0.125, 0.09), scale=(0.078, 0.045, 0.12))
        part(f"{side} leg", "cylinder", "royal blue", at=(s * 0.11, 0.33, 0), scale=(0.165, 0.47, 0.165))
        part(
            f"{side} epaulette",
            "bead",
            "gold",
            at=(s * 0.245, 1.325, 0),
            turn=(0, 0, -s * 18),
            scale=(0.105, 0.04, 0.10),
        )
        part(f"{side} eye", "bead", "dark", at=(s * 0.057, 1.605, 0.132), scale=0.019)
        part(f"{side} cheek", "bead", "pink", at=(s * 0.085, 1.545, 0.112), scale=(0.032, 0.03, 0.02))
        part(
            f"{side} moustache",
            "limb",
            "dark",
            at=(s * 0.045, 1.522, 0.142),
            turn=(0, s * 20, s * 68),
            scale=(0.03, 0.045, 0.026),
        )
    part("left arm", "limb", "red", at=(-0.31, 1.13, 0), turn=(0, 0, -10), scale=(0.125, 0.25, 0.125))
    part("left cuff", "cylinder", "gold", at=(-0.335, 0.90, 0), turn=(0, 0, -10), scale=(0.15, 0.07, 0.15))
    part("left hand", "bead", "skin", at=(-0.345, 0.855, 0), scale=0.07)
    part("right upper arm", "limb", "red", at=(0.34, 1.25, 0.02), turn=(0, 0, 62), scale=(0.125, 0.14, 0.125))
    part("right forearm", "limb", "red", at=(0.329, 1.42, 0.072), turn=(12, 0, 40), scale=(0.12, 0.17, 0.12))
    part("right cuff", "cylinder", "gold", at=(0.272, 1.487, 0.092), turn=(12, 0, 40), scale=(0.145, 0.06, 0.145))
    part("right hand", "bead", "skin", at=(0.183, 1.59, 0.122), turn=(12, 0, 40), scale=(0.045, 0.075, 0.065))
    shako = [
        line((0, 1.64), (0.165, 1.64)),
        line((0.165, 1.64), (0.195, 2.0)),
        arc((0.17, 2.0), 0.025, 0, 90, 4) + line((0.17, 2.025), (0, 2.025)),
    ]
    part("hat", revolve(shako, 40), "dark")
    part("hat band", torus(0.168, 0.016, 36, 10), "gold", at=(0, 1.665, 0))
    part("visor", "bead", "dark", at=(0, 1.655, 0.13), turn=(14, 0, 0), scale=(0.125, 0.014, 0.11))
    part("badge", "bead", "gold", at=(0, 1.84, 0.18), turn=(-5, 0, 0), scale=(0.06, 0.075, 0.018))
    part("plume", "limb", "red", at=(0, 2.09, 0.12), scale=(0.09, 0.13, 0.09))


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
