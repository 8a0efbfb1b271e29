"""A floor of wooden planks as a PNG, computed: 8 planks wide, tileable in both directions."""

import math
import random
import struct
import zlib

WIDTH, HEIGHT, PLANKS = 256, 512, 8
TONES = ((92, 58, 34), (176, 122, 76))  # sRGB, darkest and lightest


def wood_planks(seed=1):
    """8-bit sRGB PNG; the planks run along v."""
    noise = random.Random(seed)
    planks = [
        {
            "tone": noise.uniform(-0.13, 0.13),
            "joint": noise.randrange(HEIGHT),
            "phase": noise.uniform(0, 6.28),
            "knots": [noise.uniform(0.5, 1.5) for _ in range(4)],
        }
        for _ in range(PLANKS)
    ]
    grain = [[noise.uniform(-1, 1) for _ in range(16)] for _ in range(WIDTH)]
    return _png([[_color(planks, grain, x, y) for x in range(WIDTH)] for y in range(HEIGHT)])


def _color(planks, grain, x, y):
    width = WIDTH // PLANKS
    plank = planks[x // width]
    if x % width == 0 or y == plank["joint"]:
        return tuple(t // 2 for t in TONES[0])
    turn = 2 * math.pi * y / HEIGHT
    across = (x % width) / width
    rings = math.sin(
        18 * across
        + plank["phase"]
        + plank["knots"][0] * 2 * math.sin(turn + plank["phase"])
        + plank["knots"][1] * math.sin(2 * turn + plank["knots"][2])
    )
    along = y * 16 / HEIGHT
    a, b, part = grain[x][int(along)], grain[x][(int(along) + 1) % 16], along % 1
    tone = 0.55 + plank["tone"] + 0.10 * rings + 0.10 * (a + (b - a) * part)
    tone = round(min(max(tone, 0.0), 1.0) * 31) / 31
    return tuple(round(low + (high - low) * tone) for low, high in zip(*TONES))


def _png(rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    pixels = b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in rows)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"sRGB", b"\0")
        + chunk(b"IDAT", zlib.compress(pixels, 9))
        + chunk(b"IEND", b"")
    )
