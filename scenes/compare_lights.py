#!/usr/bin/env python3
"""Prints found point lights beside the true ones: how far apart they stand, and how much their intensities differ."""

import argparse
import json
import math
from pathlib import Path


def load(path):
    return json.loads(Path(path).read_text(encoding="utf-8"))


def point_lights(path):
    return [light for light in load(path)["lights"] if light.get("type", "point") == "point"]


def match_lights(true, found):
    """Pairs of indices: of all pairs left, the nearest first."""
    by_distance = sorted((math.dist(t["position"], f["position"]), i, j)
                         for i, t in enumerate(true) for j, f in enumerate(found))
    pairs = {}
    for _, i, j in by_distance:
        if i not in pairs and j not in pairs.values():
            pairs[i] = j
    return pairs


def intensity_error(true, found):
    """Relative, over the three channels."""
    return math.dist(true["intensity"], found["intensity"]) / math.hypot(*true["intensity"])


def text_of(values):
    return " ".join(f"{value:6.2f}" for value in values)


def row(true, found, diagonal):
    lights = [text_of(light[key]) if light else f"{'-':>20}" for key in ("position", "intensity") for light in (true, found)]
    if not true or not found:
        return "  ".join(lights) + ("  not found" if true else "  not there")
    distance = math.dist(true["position"], found["position"])
    errors = f"{distance:6.3f}  {100 * distance / diagonal:7.2f}  {100 * intensity_error(true, found):11.2f}"
    return "  ".join(lights + [errors])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("true", help="light file of the true lights (.json)")
    parser.add_argument("found", help="light file of the found lights (.json)")
    parser.add_argument("scene", help="what `chiaro inspect SCENE --json` says of the scene: its size is the measure")
    arguments = parser.parse_args()
    true, found = point_lights(arguments.true), point_lights(arguments.found)
    bounds = load(arguments.scene)["bounds"]
    diagonal = math.dist(bounds["min"], bounds["max"])
    pairs = match_lights(true, found)

    print(f"{len(true)} true lights, {len(found)} found; the scene's diagonal is {diagonal:.3g} m")
    print(f"{'true position (m)':>20}  {'found position (m)':>20}  {'true intensity (cd)':>20}  {'found intensity':>20}  "
          f"{'metres':>6}  {'% diag.':>7}  {'intensity %':>11}")
    for i, light in enumerate(true):
        print(row(light, found[pairs[i]] if i in pairs else None, diagonal))
    for j, light in enumerate(found):
        if j not in pairs.values():
            print(row(None, light, diagonal))


if __name__ == "__main__":
    main()
