#!/usr/bin/env python3
"""Writes cornell.glb: the Cornell box, two metres wide, with a point light under its ceiling."""

from pathlib import Path

from gltf_builder import Scene
from shapes import box, quad, room_sides


def build():
    scene = Scene("cornell")
    white = scene.material("white", (0.725, 0.71, 0.68))
    red = scene.material("red", (0.63, 0.065, 0.05))
    green = scene.material("green", (0.14, 0.45, 0.091))
    sides = room_sides((-1, 0, -1), (1, 2, 1))
    for name in ("floor", "ceiling", "back wall"):
        scene.place(name, quad(*sides[name]), white)
    scene.place("left wall", quad(*sides["left wall"]), red)
    scene.place("right wall", quad(*sides["right wall"]), green)
    scene.place("short block", box((-0.3, 0, -0.3), (0.3, 0.6, 0.3)), white, at=(0.33, 0, 0.38), turn=(0, -17, 0))
    scene.place("tall block", box((-0.3, 0, -0.3), (0.3, 1.2, 0.3)), white, at=(-0.33, 0, -0.28), turn=(0, 17, 0))
    scene.camera("front", (0, 1, 3.9), (0, 1, 0), 39, 1)
    scene.point_light("ceiling light", (0, 1.6, 0), (1.0, 0.86, 0.68), 2.5)
    return scene


if __name__ == "__main__":
    build().write(Path(__file__).with_name("cornell.glb"))
