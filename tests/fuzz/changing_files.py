#!/usr/bin/env python3
"""Changes the files that commands read, while they read them, and looks at what becomes of it.

    changing_files.py CHIARO FOLDER [RUNS [SEED]]

RUNS of each command (default 100); each time one of its inputs is cut, overwritten, put away or made whole again, over
and over. The command must do its work or say in one line what is wrong, and leave its output whole or as it was before.
Prints a table; exits with 1 at the first that is not so. Needs oiiotool.
"""

import json
import pathlib
import random
import struct
import subprocess
import threading
import time

from stress import Failure, run_tool

BEFORE = b"what was here before\n"
STROKES = {"base": "black", "strokes": [{"mode": "add", "color": [1, 1, 1], "radius": 0.5, "path": [[0, 0, 0]]}] * 50}
LIGHTS = {"lights": [{"position": [0.3 * (i % 3 - 1), 1, 0.2], "intensity": [1, 1, 1]} for i in range(3000)]}


def textured_floor(folder, quads=60):
    """A scene of three files: floor.gltf, floor.bin and floor.png."""
    vertices = b"".join(struct.pack("<3f", 2 * x / quads - 1, 0, 2 * y / quads - 1)
                        for y in range(quads + 1) for x in range(quads + 1))
    coordinates = b"".join(struct.pack("<2f", x / quads, y / quads) for y in range(quads + 1) for x in range(quads + 1))
    indices = b"".join(struct.pack("<6I", i, i + quads + 1, i + 1, i + 1, i + quads + 1, i + quads + 2)
                       for y in range(quads) for i in range(y * (quads + 1), y * (quads + 1) + quads))
    (folder / "floor.bin").write_bytes(vertices + coordinates + indices)
    subprocess.run(["oiiotool", "--pattern", "checker:width=64", "1500x1500", "3", "--noise:type=uniform:min=0:max=0.3",
                    "-d", "uint8", "-o", folder / "floor.png"], check=True)
    count, lengths = (quads + 1) ** 2, (len(vertices), len(coordinates), len(indices))
    starts = (0, lengths[0], lengths[0] + lengths[1])
    (folder / "floor.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "floor"}, {"camera": 0, "translation": [0, 1, 2], "rotation": [-0.2, 0, 0, 0.98]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"uri": "floor.png"}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3",
                       "min": [-1, 0, -1], "max": [1, 0, 1]},
                      {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC2"},
                      {"bufferView": 2, "componentType": 5125, "count": 6 * quads * quads, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": length}
                        for start, length in zip(starts, lengths)],
        "buffers": [{"byteLength": sum(lengths), "uri": "floor.bin"}]}))


class ChangingFiles:
    def __init__(self, chiaro, folder, runs, seed):
        self.chiaro = str(pathlib.Path(chiaro).resolve())
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.runs = runs
        self.random = random.Random(seed)

    def complete(self, *arguments):
        done = subprocess.run([self.chiaro, *arguments, "--quiet"], cwd=self.folder, capture_output=True, check=False)
        if done.returncode != 0:
            raise Failure(f"{arguments}: {done.stderr.decode()}")

    def commands(self):
        """Of each: its arguments, its inputs and its output."""
        folder = self.folder
        textured_floor(folder)
        (folder / "strokes.json").write_text(json.dumps(STROKES))
        (folder / "lights.json").write_text(json.dumps(LIGHTS))
        (folder / "one.json").write_text(json.dumps({"lights": LIGHTS["lights"][:1]}))
        subprocess.run(["oiiotool", "--pattern", "fill:top=1,2,3:bottom=0.1,0.1,0.1", "1024x512", "3", "-o",
                        folder / "sky.exr"], check=True)
        bake = ["bake", "floor.gltf", "--on", "receivers.glb", "--grid", "6,6,6", "--samples", "4"]
        self.complete("receivers", "floor.gltf", "-o", "receivers.glb", "--max-edge", "0.1")
        self.complete("illuminate", "floor.gltf", "--lights", "one.json", "-o", "target.glb", "--on", "receivers.glb",
                      "--samples", "4")
        self.complete(*bake, "-o", "cache.exr")
        self.complete(*bake, "-o", "part1.exr", "--shard", "1/2")
        self.complete(*bake, "-o", "part2.exr", "--shard", "2/2")
        for seed in "12":
            self.complete("render", "floor.gltf", "--lights", "one.json", "-o", f"frame{seed}.exr", "--width", "400",
                          "--samples", "1", "--seed", seed)
        scene = ["floor.gltf", "floor.bin", "floor.png"]
        return [
            (["render", "floor.gltf", "--lights", "lights.json", "--environment", "sky.exr", "-o", "out.exr", "--width",
              "32", "--samples", "1"], [*scene, "lights.json", "sky.exr"], "out.exr"),
            (["paint", "floor.gltf", "--strokes", "strokes.json", "--on", "receivers.glb", "-o", "out.glb"],
             [*scene, "strokes.json", "receivers.glb"], "out.glb"),
            (["solve", "floor.gltf", "--target", "target.glb", "--cache", "cache.exr", "--lights", "1",
              "--verification-samples", "2", "-o", "out.glb"], ["target.glb", "cache.exr", *scene], "out.glb"),
            (["merge", "part1.exr", "part2.exr", "-o", "out.exr"], ["part1.exr", "part2.exr"], "out.exr"),
            (["compare", "frame1.exr", "frame2.exr", "-o", "out.png"], ["frame1.exr", "frame2.exr"], "out.png"),
        ]

    def run(self):
        print(f"{'command':12}{'done':>8}{'refused':>8}", flush=True)
        for arguments, inputs, output in self.commands():
            whole = {name: (self.folder / name).read_bytes() for name in inputs}
            counts = [0, 0]
            for _ in range(self.runs):
                counts[self.one(arguments, self.random.choice(inputs), whole, output)] += 1
            print(f"{arguments[0]:12}{counts[0]:8}{counts[1]:8}", flush=True)

    def one(self, arguments, changed, whole, output):
        """Its exit code."""
        where = f"{' '.join(arguments)}, while {changed} changes"
        (self.folder / output).write_bytes(BEFORE)
        process = subprocess.Popen([self.chiaro, *arguments, "--quiet"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        stop = threading.Event()
        changer = threading.Thread(target=self.change, args=(self.folder / changed, whole[changed], stop))
        changer.start()
        try:
            printed, errors = process.communicate(timeout=120)
        except subprocess.TimeoutExpired:
            process.kill()
            raise Failure(f"{where}: goes on for two minutes") from None
        finally:
            stop.set()
            changer.join()
            (self.folder / changed).write_bytes(whole[changed])
        if process.returncode not in (0, 1):
            raise Failure(f"{where}: exit {process.returncode}: {errors.decode()}")
        lines = errors.decode().splitlines()
        if process.returncode == 1 and (len(lines) != 1 or not lines[0].startswith("chiaro: error: ") or printed):
            raise Failure(f"{where}: says {lines}, prints {printed}")
        is_before = (self.folder / output).read_bytes() == BEFORE
        if is_before != (process.returncode == 1):
            raise Failure(f"{where}: exit {process.returncode}, and {output} is {'as before' if is_before else 'new'}")
        left = list(self.folder.rglob(".*.part*"))
        if left:
            raise Failure(f"{where}: left {left}")
        return process.returncode

    def change(self, path, whole, stop):
        time.sleep(self.random.uniform(0, 0.3))
        while not stop.is_set():
            kind = self.random.randrange(5)
            if kind == 0:
                path.write_bytes(whole[: self.random.randrange(len(whole))])
            elif kind == 1 and path.exists():
                with open(path, "r+b") as file:
                    file.seek(self.random.randrange(len(whole)))
                    file.write(self.random.randbytes(self.random.randrange(1, 5000)))
            elif kind == 2:
                path.unlink(missing_ok=True)
            elif kind == 3 and path.exists():
                with open(path, "r+b") as file:
                    file.truncate(self.random.randrange(len(whole)))
            else:
                path.write_bytes(whole)
            time.sleep(self.random.choice((0, 0.001, 0.02)))


run_tool(__doc__, ChangingFiles, 2)
