#!/usr/bin/env python3
"""Runs that are killed, stopped or terminated at random moments and go on from their restart file, several times each,
until they reach their end. History, every dump and the figures of the summary must have the bits of a run that was not
interrupted, for another number of threads too. With --ranks they are started by mpirun, each time on one of these
numbers of ranks, of which any may be killed; the scenes are then large enough to be several domains.

Usage: tests/system/restart_trials.py BRIO [--trials N] [--seed N] [--decks can_buckling,...] [--ranks 1,2,3]
Exits with 1 after the first trial that fails, whose folder is kept and named."""

import argparse
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

INPUTS = pathlib.Path(__file__).resolve().parents[2] / "inputs"
DECKS = {  # coarse: a few seconds each
    "can_buckling": ["parts.can.mesh.cylinder.elements=[24,15]", "time.end=1.5e-3"],
    "pipe_cutting": ["parts.pipe.mesh.tube.elements=[24,18,2]", "parts.blade.mesh.wedge.elements=[1,4,24]",
                     "time.end=1.5e-3"],
    "brick_stack": ["time.end=1.5e-3", "output.fields.every=1e-4"],
    "bird_strike": ["parts.bird.mesh.particles.cylinder.spacing=0.014", "time.end=5e-4"],
    "net": ["time.end=5e-3"],
    "plate_perforation": ["parts.plate.mesh.box.elements=[24,24,2]", "parts.ball.mesh.sphere.elements=6"],
}
SEVERAL_DOMAINS = {
    "can_buckling": ["parts.can.mesh.cylinder.elements=[72,45]", "time.end=4e-4"],
    "pipe_cutting": ["time.end=2e-4"],
    "brick_stack": ["time.end=4e-4", "output.fields.every=1e-4"],
    "plate_perforation": ["time.end=1.3e-5"],  # elements are given up that crossed when others were deleted
    "crash_box": ["time.end=2e-4"],
    "panel_impulse": ["time.end=2e-4"],
    "taylor_bar": ["time.end=1e-5"],
}
# What differs between runs whose results are the same.
NOT_COMPARED = {"wall_s", "element_updates_per_s", "peak_memory_mb", "threads", "ranks", "restarted_from", "deck"}


class Failed(Exception):
    pass


def require(condition, what):
    if not condition:
        raise Failed(what)


def tables(path):
    found = {}
    with h5py.File(path) as file:
        def visit(name, entry):
            if isinstance(entry, h5py.Dataset) and not name.startswith(("deck/", "checksums/")):
                found[name] = entry[()]
        file.visititems(visit)
    return found


def expect_same(expected, folder, name):
    for what, ending in (("history", "history.csv"), ("description for ParaView", "xdmf2")):
        require((folder / f"{name}.{ending}").read_bytes() == (expected / f"{name}.{ending}").read_bytes(),
                f"the {what} differs")
    one, other = tables(expected / f"{name}.vtkhdf"), tables(folder / f"{name}.vtkhdf")
    require(one.keys() == other.keys(), "the result file has other tables")
    for table, values in one.items():
        same = values.shape == other[table].shape and values.dtype == other[table].dtype
        require(same and (values.dtype.kind in "OS" or numpy.array_equal(values, other[table], equal_nan=True)),
                f"{table} differs")
    one, other = (json.loads((f / f"{name}.summary.json").read_text()) for f in (expected, folder))
    for key in one.keys() - NOT_COMPARED:
        require(one[key] == other[key], f"'{key}' of the summary is {other[key]} in place of {one[key]}")


def processes_of(parent):
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1]) == parent:
                found.append(int(entry.name))
        except OSError:
            pass
    return sorted(found)


def end(process, kind, ranks, chance):
    """Of ranks one is killed; mpirun ends the others, and hands on what terminates them."""
    of_ranks = processes_of(process.pid) if ranks and kind == "kill" else []
    if of_ranks:
        os.kill(chance.choice(of_ranks), signal.SIGKILL)
    else:
        process.send_signal(signal.SIGKILL if kind == "kill" else signal.SIGTERM)


class Scene:
    def __init__(self, program, name, folder, ranks):
        self.program, self.name, self.deck = program, name, INPUTS / f"{name}.yaml"
        sets = SEVERAL_DOMAINS if ranks else DECKS
        self.sets = [part for setting in sets[name] for part in ("--set", setting)]
        self.ranks = ranks
        self.expected = folder / "expected"
        start = time.monotonic()
        require(self.run(self.expected, 1).wait() == 0, "the run that nothing happens to fails")
        self.seconds = time.monotonic() - start
        summary = json.loads((self.expected / f"{name}.summary.json").read_text())
        self.every = summary["time"] / 23

    def run(self, folder, threads, *more, ranks=0):
        start = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks else []
        return subprocess.Popen([*start, self.program, "run", self.deck, "--quiet", "--overwrite", "--output", folder,
                                 "--threads", str(threads), *self.sets, *more], stderr=subprocess.DEVNULL,
                                env=dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1"))

    def trial(self, folder, chance):
        """Returns how often the run was interrupted."""
        interrupted = 0
        while True:
            begun = (folder / f"{self.name}.restart.h5").exists() or (folder / f"{self.name}.restart.previous.h5").exists()
            more = ["--set", f"output.restart={{every: {self.every}}}"]
            if begun:
                more += ["--restart", folder / f"{self.name}.restart.h5"]
            kind = chance.choice(["kill", "kill", "kill", "terminate", "stop"])
            seconds = chance.uniform(0, 0.6 * self.seconds) if interrupted < 4 else 1e3
            if kind == "stop":
                more += ["--stop-after", str(seconds + 1e-6)]
            ranks = chance.choice(self.ranks) if self.ranks else 0
            process = self.run(folder, chance.choice([1, 2]), *more, ranks=ranks)
            try:
                code = process.wait(timeout=seconds if kind != "stop" else 1e3)
            except subprocess.TimeoutExpired:
                end(process, kind, ranks, chance)
                code = process.wait(timeout=120)
            allowed = [0, -signal.SIGKILL, 128 + signal.SIGTERM, -signal.SIGTERM]
            if ranks:  # of mpirun, which says of a rank that was killed that it was, and of itself nothing
                allowed += [128 + signal.SIGKILL if kind == "kill" else 1]
            require(code in allowed, f"ended with {code}")
            summary = folder / f"{self.name}.summary.json"
            if code == 0 and json.loads(summary.read_text())["status"] == "finished":
                expect_same(self.expected, folder, self.name)
                return interrupted
            interrupted += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--trials", type=int, default=len(DECKS))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--decks")
    parser.add_argument("--ranks", type=lambda text: [int(number) for number in text.split(",")], default=[])
    options = parser.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="brio-restart-"))
    names = options.decks.split(",") if options.decks else list(SEVERAL_DOMAINS if options.ranks else DECKS)
    scenes, interrupted = {}, 0
    for number in range(options.trials):
        name = names[number % len(names)]
        where = folder / f"trial_{number}"
        try:
            if name not in scenes:
                (folder / name).mkdir()
                scenes[name] = Scene(str(options.program.resolve()), name, folder / name, options.ranks)
            interrupted += scenes[name].trial(where, random.Random(1000 * options.seed + number))
        except Failed as fault:
            print(f"trial {number}, {name}, in {where}: {fault}", file=sys.stderr)
            return 1
        shutil.rmtree(where)
    shutil.rmtree(folder)
    print(f"{options.trials} runs, interrupted {interrupted} times, have the bits of those that were not")
    return 0


if __name__ == "__main__":
    sys.exit(main())
