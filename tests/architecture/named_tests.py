#!/usr/bin/env python3
"""Fails where docs/guarantees.md, or the list of tests that are long with sanitizers, names one that there is not.

Usage: named_tests.py SOURCE_DIR TEST_PROGRAM
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


def missing_guarantees(source, units):
    known = set(units)
    known |= {f"end_to_end/{case.parent.name}" for case in source.glob("tests/end_to_end/*/run")}
    known |= {f"fuzz/{target.stem}" for target in source.glob("tests/fuzz/*.cpp")}
    named = re.findall(r"`((?:[A-Z]\w+\.[A-Z]\w+)|(?:(?:end_to_end|fuzz)/[a-z_]+))`",
                       (source / "docs/guarantees.md").read_text())
    return [name for name in named if name not in known] if named else ["any"]


def missing_long_tests(source, units):
    suites = {name.split(".")[0] + ".*" for name in units}
    lines = (source / "tests/support/long_with_sanitizers.txt").read_text().splitlines()
    return [line for line in lines if not line.startswith("#") and line not in units | suites]


if __name__ == "__main__":
    source = pathlib.Path(sys.argv[1])
    units = unit_tests(sys.argv[2])
    missing = [f"docs/guarantees.md: no test is named {name}" for name in missing_guarantees(source, units)]
    missing += [f"tests/support/long_with_sanitizers.txt: no test is named {name}"
                for name in missing_long_tests(source, units)]
    print("\n".join(missing))
    sys.exit(1 if missing else 0)
