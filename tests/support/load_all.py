#!/usr/bin/env python3
"""Runs chiaro on every .glb and .gltf below some folders and says what became of each.

    load_all.py CHIARO FOLDER... [--render] [--out DIR]

Each file must load (and with --render give a frame without NaN), or end with exit code 1 and one line of error. Not run by
ctest: it is meant for collections of files that are not part of the project.
"""
import argparse
import pathlib
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor


def command(options, path, index):
    if not options.render:
        return [options.chiaro, "inspect", path, "--json"]
    frame = pathlib.Path(options.out) / f"{index:04}_{path.stem}.exr"
    lamp = pathlib.Path(options.out) / "lamp.json"
    lamp.write_text('{"lights":[{"type":"directional","direction":[-0.4,-0.8,-0.45],"intensity":[3,3,3]}]}')
    return [options.chiaro, "render", path, "-o", frame, "--lights", lamp, "--width", "160", "--height", "90",
            "--samples", "4", "--preview", "--quiet"]


def fault(options, path, index):
    """What is wrong with how a file was treated; empty: nothing. And what became of it."""
    try:
        run = subprocess.run(command(options, path, index), capture_output=True, text=True, timeout=options.timeout,
                             errors="replace")
    except subprocess.TimeoutExpired:
        return "takes too long", ""
    lines = [line for line in run.stderr.splitlines() if line]
    if run.returncode == 1:
        errors = [line for line in lines if line.startswith("chiaro: error: ")]
        one_line = len(lines) == 1 and len(errors) == 1 and not run.stdout
        return "" if one_line else f"not one line of error: {lines}", lines[0] if lines else ""
    if run.returncode != 0:
        return f"exit code {run.returncode}: {lines[-1:]}", ""
    if re.search(r"\bnan\b", run.stdout, re.IGNORECASE):
        return "NaN", ""
    return "", "loads " + "; ".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("chiaro")
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--render", action="store_true")
    parser.add_argument("--out", default=".")
    parser.add_argument("--timeout", type=float, default=120)
    options = parser.parse_args()
    files = sorted(p for f in options.folders for p in pathlib.Path(f).rglob("*") if p.suffix in (".glb", ".gltf"))
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda item: fault(options, item[1], item[0]), enumerate(files)))
    faults = 0
    for path, (wrong, became) in zip(files, results):
        faults += bool(wrong)
        print(f"{'FAULT' if wrong else 'ok   '} {path}: {wrong or became}")
    print(f"{len(files)} files, {faults} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
