"""What the tools beside share: what they fail with, and how they are called."""

import sys


class Failure(Exception):
    pass


def run_tool(description, tool, names):
    """tool(the arguments named, RUNS, SEED).run(): RUNS is 100 and SEED 0 where they are not given."""
    arguments = sys.argv[1:]
    if len(arguments) < names:
        sys.exit(description)
    numbers = [int(argument) for argument in arguments[names:names + 2]]
    runs, seed = numbers + [100, 0][len(numbers):]
    try:
        tool(*arguments[:names], runs, seed).run()
    except Failure as failure:
        sys.exit(f"FAILED: {failure}")
