#!/usr/bin/env python3
"""Fails where docs/guarantees.md names a test that there is not.

Usage: guarantees.py SOURCE_DIR TEST_PROGRAM
"""

import pathlib
import re
import subprocess
import sys


def unit_tests(program):
    listing = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
    suite, names = "", set()
    for line in listing.splitlines():
        name = line.split("#")[0].strip()
        if line.startswith(" "):
            names.add(suite + name)
        else:
            suite = name.split("/")[-1]
    return names


if __name__ == "__main__":
    source = pathlib.Path(sys.argv[1])
    known = unit_tests(sys.argv[2])
    known |= {f"end_to_end/{case.parent.name}" for case in source.glob("tests/end_to_end/*/run")}
    known |= {f"fuzz/{target.stem}" for target in source.glob("tests/fuzz/*.cpp")}
    named = re.findall(r"`((?:[A-Z]\w+\.[A-Z]\w+)|(?:(?:end_to_end|fuzz)/[a-z_]+))`",
                       (source / "docs/guarantees.md").read_text())
    missing = [name for name in named if name not in known]
    for name in missing:
        print(f"docs/guarantees.md: no test is named {name}")
    sys.exit(1 if missing or not named else 0)
