#!/usr/bin/env python3
"""set_lights.py IN.glb OUT.glb [Bulb] [Spot] [Sun]: the scene with these lights, and none of its own: a point light, a
spot light that looks down, light from afar."""

import json
import struct
import sys

LIGHTS = [
    {"name": "Bulb", "type": "point", "intensity": 1, "color": [1, 1, 1]},
    {"name": "Spot", "type": "spot", "intensity": 1, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.7}},
    {"name": "Sun", "type": "directional", "intensity": 1},
]
# Lights look along -Z: a turn by -90 degrees about X looks down, by -30 degrees into the room from above.
NODES = [
    {"translation": [-0.5, 1.5, 0.4]},
    {"translation": [0.5, 1.8, 0.5], "rotation": [-0.70710678, 0, 0, 0.70710678]},
    {"rotation": [-0.25881905, 0, 0, 0.96592583]},
]


def chunks(data):
    at = 12
    while at < len(data):
        size, kind = struct.unpack_from("<I4s", data, at)
        yield kind, data[at + 8:at + 8 + size]
        at += 8 + size


with open(sys.argv[1], "rb") as file:
    parts = dict(chunks(file.read()))
scene = json.loads(parts[b"JSON"])
nodes = scene["scenes"][0]["nodes"]
nodes[:] = [n for n in nodes if "KHR_lights_punctual" not in scene["nodes"][n].get("extensions", {})]
scene["extensionsUsed"] = sorted({*scene.get("extensionsUsed", []), "KHR_lights_punctual"})
scene.setdefault("extensions", {})["KHR_lights_punctual"] = {"lights": LIGHTS}
for number, light in enumerate(LIGHTS):
    if light["name"] in sys.argv[3:]:
        nodes.append(len(scene["nodes"]))
    scene["nodes"].append(dict(NODES[number], name=light["name"],
                               extensions={"KHR_lights_punctual": {"light": number}}))
text = json.dumps(scene).encode()
text += b" " * (-len(text) % 4)
body = struct.pack("<I4s", len(text), b"JSON") + text
body += struct.pack("<I4s", len(parts[b"BIN\0"]), b"BIN\0") + parts[b"BIN\0"]
with open(sys.argv[2], "wb") as file:
    file.write(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body)
