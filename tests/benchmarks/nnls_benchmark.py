#!/usr/bin/env python3
"""Solves the system in a folder by scipy.optimize.nnls, for nnls_benchmark.

Usage: nnls_benchmark.py FOLDER ROWS COLUMNS SIDES REPEATS

Reads FOLDER/a and FOLDER/b, writes FOLDER/x and FOLDER/seconds (the least of the repeats): doubles, column by column.
"""

import pathlib
import sys
import time

import numpy
import scipy.optimize


def read(file, rows, columns):
    return numpy.fromfile(file).reshape((rows, columns), order="F")


def solve(a, b):
    return numpy.stack([scipy.optimize.nnls(a, side)[0] for side in b.T], axis=1)


def timed(work, repeats):
    least = float("inf")
    for _ in range(repeats):
        start = time.perf_counter()
        result = work()
        least = min(least, time.perf_counter() - start)
    return result, least


def main():
    folder = pathlib.Path(sys.argv[1])
    rows, columns, sides, repeats = map(int, sys.argv[2:])
    a, b = read(folder / "a", rows, columns), read(folder / "b", rows, sides)
    try:
        x, seconds = timed(lambda: solve(a, b), repeats)
    except RuntimeError as error:  # too many iterations
        sys.exit(f"scipy.optimize.nnls: {error}")
    x.ravel(order="F").tofile(folder / "x")
    numpy.array([seconds]).tofile(folder / "seconds")


if __name__ == "__main__":
    main()
