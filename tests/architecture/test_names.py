#!/usr/bin/env python3
"""Fails where a value-parameterised test has a number for a name, which says nothing and moves when a case is added.

Usage: test_names.py TEST_PROGRAM
"""

import re
import subprocess
import sys


def numbered_tests(listing):
    suite = ""
    for line in listing.splitlines():
        name = line.split("#")[0].strip()
        if not line.startswith(" "):
            suite = name
        elif re.search(r"/\d+$", name):
            yield suite + name


if __name__ == "__main__":
    listing = subprocess.run([sys.argv[1], "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
    found = list(numbered_tests(listing))
    for name in found:
        print(f"{name}: a number (expected a name: the fourth argument of INSTANTIATE_TEST_SUITE_P)")
    sys.exit(1 if found else 0)
