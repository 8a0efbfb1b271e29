#!/usr/bin/env python3
"""Fails on an include that climbs or circles among the layers, or a third-party type in a public header."""
import pathlib
import re
import sys

# A layer may include itself and the layers listed for it.
RENDERER = {"renderer/core": [], "renderer/image": ["core"], "renderer/scene": ["core", "image"],
            "renderer/io": ["core", "image", "scene"], "renderer/trace": ["core", "image", "scene"]}
ALLOWED = {layer: {f"renderer/{name}" for name in below} for layer, below in RENDERER.items()}
ALLOWED["inverse/numerics"] = set()
ALLOWED["inverse/transport"] = set(RENDERER) | {"inverse/numerics"}
ALLOWED["inverse/target"] = ALLOWED["inverse/transport"] | {"inverse/transport"}
ALLOWED["inverse/solve"] = ALLOWED["inverse/target"] | {"inverse/target"}
ALLOWED["cli"] = set(ALLOWED)
# What headers may include beside our own and the standard library's.
IN_HEADERS = {"Eigen/Core", "sanitizer/tsan_interface.h"}
# Headers for the .cpp files of one concept alone, which share a library's type.
PRIVATE_HEADERS = {"inverse/target/json_field.h", "renderer/image/ocio_config.h"}
LIBRARY = re.compile(r'#include [<"](?!(?:renderer|inverse|cli)/)([^>"]*[/.][^>"]*)[>"]')
INCLUDE = re.compile(r'#include "((?:renderer|inverse|cli)/[^"]+)"')


def layer_of(path):
    parts = pathlib.PurePosixPath(path).parts
    return "cli" if parts[0] == "cli" else "/".join(parts[:2])


def faults(root):
    for folder in ("renderer", "inverse", "cli"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            name, text = file.relative_to(root).as_posix(), file.read_text()
            for included in INCLUDE.findall(text):
                target, own = layer_of(included), layer_of(name)
                if target != own and target not in ALLOWED[own]:
                    yield f"{name}: includes {included}: {own} may not depend on {target}"
                if not (root / included).exists():
                    yield f"{name}: includes {included}, which does not exist"
            if file.suffix == ".h" and name not in PRIVATE_HEADERS:
                for included in set(LIBRARY.findall(text)) - IN_HEADERS:
                    yield f"{name}: includes {included}: third-party types stay in one .cpp"


def main():
    found = list(faults(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "architecture: every include points downward")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
