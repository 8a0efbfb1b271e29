#!/usr/bin/env python3
"""Prints the matrix of config.ocio: linear Rec.709 (D65) to ACES2065-1 (AP0, ACES white), adapted by Bradford.

Sources: ITU-R BT.709; SMPTE ST 2065-1; the linearised Bradford transform as in ICC.1:2010, annex E.
"""

from fractions import Fraction as F

REC709 = [(F("0.64"), F("0.33")), (F("0.30"), F("0.60")), (F("0.15"), F("0.06")), (F("0.3127"), F("0.3290"))]
AP0 = [(F("0.7347"), F("0.2653")), (F("0"), F("1")), (F("0.0001"), F("-0.077")), (F("0.32168"), F("0.33767"))]
BRADFORD = [
    [F("0.8951"), F("0.2664"), F("-0.1614")],
    [F("-0.7502"), F("1.7135"), F("0.0367")],
    [F("0.0389"), F("-0.0685"), F("1.0296")],
]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(len(b))) for j in range(len(b[0]))] for i in range(3)]


def inverse(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    adjugate = [
        [e * i - f * h, c * h - b * i, b * f - c * e],
        [f * g - d * i, a * i - c * g, c * d - a * f],
        [d * h - e * g, b * g - a * h, a * e - b * d],
    ]
    determinant = a * adjugate[0][0] + b * adjugate[1][0] + c * adjugate[2][0]
    return [[x / determinant for x in row] for row in adjugate]


def xyz(xy):
    return [[xy[0] / xy[1]], [F(1)], [(1 - xy[0] - xy[1]) / xy[1]]]


def diagonal(values):
    return [[values[i] if i == j else F(0) for j in range(3)] for i in range(3)]


def xyz_from_rgb(primaries):
    *rgb, white = primaries
    columns = [[xyz_of[i][0] for xyz_of in map(_primary, rgb)] for i in range(3)]
    gains = product(inverse(columns), xyz(white))
    return product(columns, diagonal([g[0] for g in gains]))


def _primary(xy):
    return [[xy[0]], [xy[1]], [1 - xy[0] - xy[1]]]


def adaptation(white_from, white_to):
    cone_from, cone_to = product(BRADFORD, xyz(white_from)), product(BRADFORD, xyz(white_to))
    gains = diagonal([b[0] / a[0] for a, b in zip(cone_from, cone_to)])
    return product(inverse(BRADFORD), product(gains, BRADFORD))


def main():
    adapted = product(adaptation(REC709[3], AP0[3]), xyz_from_rgb(REC709))
    ap0_from_rec709 = product(inverse(xyz_from_rgb(AP0)), adapted)
    # OpenColorIO writes 4 x 4 matrices, row by row.
    rows = [[*map(float, row), 0] for row in ap0_from_rec709] + [[0, 0, 0, 1]]
    print("ACES2065-1 from Linear Rec.709 (sRGB):\n  [" + ", ".join(repr(v) for row in rows for v in row) + "]")


if __name__ == "__main__":
    main()
