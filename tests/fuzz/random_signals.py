#!/usr/bin/env python3
"""Sends signals to every command at random moments, and looks at what they leave.

    random_signals.py CHIARO SCENE.glb FOLDER [RUNS [SEED]]

RUNS of each command with each of SIGINT, SIGTERM, SIGHUP and SIGKILL (default 100). After each: outputs are as they were
before or whole, an interrupted frame says that it is one, nothing that was being written aside is left but by SIGKILL,
bakes go on to the bytes of a whole one, and the exit code and the line on standard error say what happened. Prints a
table; exits with 1 at the first that is not so.
"""

import json
import pathlib
import random
import signal
import subprocess
import time

from stress import Failure, run_tool

BEFORE = b"what was here before\n"
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)
STROKES = {"base": "black", "strokes": [{"mode": "add", "color": [1, 1, 1], "radius": 0.5, "path": [[0, 0, 0]]}]}


def expect(truth, what):
    if not truth:
        raise Failure(what)


class Signals:
    def __init__(self, chiaro, scene, folder, runs, seed):
        self.chiaro = str(pathlib.Path(chiaro).resolve())
        self.scene = str(pathlib.Path(scene).resolve())
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.runs = runs
        self.random = random.Random(seed)

    def start(self, arguments):
        return subprocess.Popen([self.chiaro, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

    def complete(self, *arguments):
        process = self.start(arguments)
        _, errors = process.communicate()
        expect(process.returncode == 0, f"{arguments}: exit {process.returncode}: {errors.decode()}")

    def commands(self):
        """Of each: its name, its arguments and its outputs."""
        scene = self.scene
        (self.folder / "strokes.json").write_text(json.dumps(STROKES))
        bake = ["bake", scene, "--on", "receivers.glb", "--grid", "5,5,5", "--samples", "8", "--memory", "1G"]
        self.complete("receivers", scene, "-o", "receivers.glb", "--max-edge", "0.3")
        self.complete("illuminate", scene, "-o", "target.glb", "--on", "receivers.glb", "--samples", "16")
        self.complete(*bake, "-o", "cache.exr")
        self.complete(*bake, "-o", "part1.exr", "--shard", "1/2")
        self.complete(*bake, "-o", "part2.exr", "--shard", "2/2")
        self.complete("render", scene, "-o", "one.exr", "--width", "600", "--samples", "1")
        self.complete("render", scene, "-o", "other.exr", "--width", "600", "--samples", "1", "--seed", "1")
        solve = ["--target", "target.glb", "--cache", "cache.exr", "--lights", "1", "--verification-samples", "4"]
        return [
            ("inspect", ["inspect", scene], []),
            ("receivers", ["receivers", scene, "-o", "out.glb", "--max-edge", "0.01"], ["out.glb"]),
            ("paint", ["paint", scene, "--strokes", "strokes.json", "--on", "receivers.glb", "-o", "out.glb"],
             ["out.glb"]),
            ("illuminate", ["illuminate", scene, "--on", "receivers.glb", "--samples", "512", "-o", "out.glb"],
             ["out.glb"]),
            ("bake", [*bake, "-o", "out.exr"], ["out.exr"]),
            ("merge", ["merge", "part1.exr", "part2.exr", "-o", "out.exr"], ["out.exr"]),
            ("solve", ["solve", scene, *solve, "-o", "out.glb"], ["out.glb", "out.json"]),
            ("render", ["render", scene, "-o", "out.exr", "--width", "96", "--samples", "16"], ["out.exr"]),
            ("compare", ["compare", "one.exr", "other.exr", "-o", "out.png"], ["out.png"]),
            ("run", ["run", scene, "--target", "target.glb", "--grid", "5,5,5", "--samples", "8", "--lights", "1",
                     "--verification-samples", "4", "--frame-samples", "2", "--width", "64", "-o", "out"],
             ["out/lights.glb", "out/lights.json", "out/found.glb"]),
        ]

    def run(self):
        print("whole: it was through, stopped: by the signal, early: before it heeds signals")
        print(f"{'command':12}{'seconds':>8}" + "".join(f"{s.name:>10}{'whole':>8}{'stopped':>8}{'early':>8}" for s in SIGNALS))
        for name, arguments, outputs in self.commands():
            self.clear(outputs)
            began = time.monotonic()
            self.complete(*arguments)
            seconds = time.monotonic() - began
            whole = {output: (self.folder / output).read_bytes() for output in outputs}
            row = f"{name:12}{seconds:8.2f}"
            for sent in SIGNALS:
                counts = {"whole": 0, "stopped": 0, "early": 0}
                for _ in range(self.runs):
                    counts[self.one(name, arguments, whole, sent, self.random.uniform(0, 1.05 * seconds))] += 1
                row += f"{'':10}" + "".join(f"{count:8}" for count in counts.values())
            print(row, flush=True)

    def one(self, name, arguments, whole, sent, delay):
        """What became of it."""
        where = f"{name}, {sent.name} after {delay:.4f} s"
        self.clear(whole)
        for output in whole:
            (self.folder / output).parent.mkdir(exist_ok=True)
            (self.folder / output).write_bytes(BEFORE)
        process = self.start(arguments)
        time.sleep(delay)
        process.send_signal(sent)
        try:
            printed, errors = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            process.kill()
            raise Failure(f"{where}: goes on for a minute") from None
        code = process.returncode
        for output in whole:
            self.look_at(name, output, whole[output], code, where)
        aside = list(self.folder.rglob(".*.part*"))
        if sent == signal.SIGKILL:
            for path in aside:
                path.unlink()
        else:
            expect(not aside, f"{where}: left {aside}")
        if name == "bake" and code != 0:
            self.go_on(arguments, whole, where)
        if code == 0:
            return "whole"
        if sent == signal.SIGKILL:
            expect(code == -signal.SIGKILL, f"{where}: exit {code}")
            return "stopped"
        if code == -sent:
            return "early"
        expect(code == 130, f"{where}: exit {code}: {errors.decode()}")
        lines = errors.decode().splitlines()
        expect(any(line.startswith("chiaro: interrupted") for line in lines), f"{where}: says {lines}")
        expect(name == "render" or not printed, f"{where}: prints {printed}")
        return "stopped"

    def look_at(self, name, output, whole, code, where):
        is_now = (self.folder / output).read_bytes()
        if code == 0:
            expect(is_now == whole, f"{where}: exit 0, and {output} is not what it should be")
        elif is_now not in (BEFORE, whole):
            expect(name == "render", f"{where}: {output} is neither as before nor whole")
            shown = subprocess.run([self.chiaro, "inspect", self.folder / output, "--json"], capture_output=True,
                                   check=False)
            expect(b"chiaro:interrupted" in shown.stdout, f"{where}: the frame does not say that it was interrupted")

    def go_on(self, arguments, whole, where):
        self.complete(*arguments, "--resume")
        for output in whole:
            expect((self.folder / output).read_bytes() == whole[output], f"{where}: goes on to another {output}")

    def clear(self, outputs):
        for path in [*outputs, "out.exr.unfinished"]:
            (self.folder / path).unlink(missing_ok=True)


run_tool(__doc__, Signals, 3)
