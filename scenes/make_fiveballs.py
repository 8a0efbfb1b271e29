#!/usr/bin/env python3
"""Writes fiveballs.glb: five diffuse balls in an open corner of a floor and two walls, without lights."""

from pathlib import Path

from gltf_builder import Scene
from shapes import icosphere, quad, room_sides

SIZE, HEIGHT = 6.0, 3.0  # metres; the corner is at (-3, 0, -3)

# name, centre, radius, albedo
BALLS = [
    ("white ball", (-1.35, 0.70, -1.45), 0.70, (0.80, 0.79, 0.77)),
    ("coral ball", (0.55, 0.55, -1.35), 0.55, (0.78, 0.53, 0.50)),
    ("blue ball", (-1.60, 0.75, 0.50), 0.45, (0.52, 0.62, 0.78)),
    ("sand ball", (0.15, 0.60, 0.35), 0.60, (0.78, 0.70, 0.52)),
    ("green ball", (1.70, 0.55, -0.10), 0.35, (0.54, 0.72, 0.56)),
]


def build():
    scene = Scene("fiveballs")
    h = SIZE / 2
    floor = scene.material("floor", (0.66, 0.65, 0.63))
    walls = scene.material("walls", (0.74, 0.73, 0.71))
    sides = room_sides((-h, 0, -h), (h, HEIGHT, h))
    scene.place("floor", quad(*sides["floor"]), floor)
    scene.place("back wall", quad(*sides["back wall"]), walls)
    scene.place("left wall", quad(*sides["left wall"]), walls)
    ball = scene.shape("ball", icosphere(4))
    for name, center, radius, albedo in BALLS:
        scene.place(name, ball, scene.material(name, albedo), at=center, scale=radius)
    scene.camera("main", (4.0, 2.9, 4.4), (-0.35, 0.72, -0.45), 36, 4 / 3)
    return scene


if __name__ == "__main__":
    build().write(Path(__file__).with_name("fiveballs.glb"))
