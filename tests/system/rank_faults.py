#!/usr/bin/env python3
"""Runs on several ranks of which one fails: the others end with it, within seconds, with one message and the exit code
of the fault; what was written before can be read.

Usage: tests/system/rank_faults.py BRIO [--trials N] [--seed N]
Exits with 1 after the first trial that fails."""

import argparse
import os
import pathlib
import random
import resource
import subprocess
import sys
import tempfile
import time

CAN = pathlib.Path(__file__).resolve().parents[2] / "inputs" / "can_buckling.yaml"
SETS = ["--set", "parts.can.mesh.cylinder.elements=[72,45]", "--set", "time.end=1.5e-3", "--set",
        "output.fields.every=1e-5"]
MOST_SECONDS = 60
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


class Failed(Exception):
    pass


def require(condition, what):
    if not condition:
        raise Failed(what)


def on_ranks(program, before, arguments):
    """before: of each rank a command line that starts its program. Returns exit code, what was said, seconds."""
    command = ["mpirun", "--oversubscribe"]
    for number, start in enumerate(before):
        command += ([":"] if number else []) + ["-n", "1", *start, program, *arguments]
    begin = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, timeout=MOST_SECONDS, env=ENVIRONMENT)
    return done.returncode, done.stdout + done.stderr, time.monotonic() - begin


def limited(limit):
    return ["bash", "-c", f'ulimit {limit}; exec "$@"', "limited"]


def says_once(said, text):
    require(said.count(text) == 1, f"'{text}' is said {said.count(text)} times:\n{said}")


def bad_deck(program, folder, ranks, chance):
    code, said, seconds = on_ranks(program, [[]] * ranks, ["run", str(folder / "none.yaml")])
    require(code == 2, f"a deck that is not there ends with {code}")
    says_once(said, "none.yaml: cannot be opened")
    return seconds


def bad_command_line(program, folder, ranks, chance):
    code, said, seconds = on_ranks(program, [[]] * ranks, ["run", "--no-such-option", str(CAN)])
    require(code == 2, f"a bad command line ends with {code}")
    says_once(said, "--no-such-option")
    return seconds


def full_disk(program, folder, ranks, chance):
    """A file of the first rank, which writes, may not grow beyond some dumps."""
    results = folder / "full"
    before = [limited(f"-f {chance.randrange(3000, 20000)}")] + [[]] * (ranks - 1)
    code, said, seconds = on_ranks(program, before,
                                   ["run", str(CAN), "--quiet", "--threads", "1", "--output", str(results), *SETS])
    require(code == 4, f"a full disk ends with {code}:\n{said}")
    says_once(said, "cannot write")
    info = subprocess.run([program, "info", "--verify", str(results)], capture_output=True, text=True)
    require(info.returncode == 0, f"what was written cannot be read: {info.stdout}{info.stderr}")
    return seconds


def little_memory(program, folder, ranks, chance):
    """A rank by chance has too little memory for the scene: it ends alone, and the others with it."""
    before = [[]] * ranks
    before[chance.randrange(ranks)] = limited(f"-v {chance.randrange(500, 700) * 1000}")
    code, said, seconds = on_ranks(program, before,
                                   ["run", str(CAN), "--quiet", "--threads", "1", "--output", str(folder / "memory"),
                                    "--set", "parts.can.mesh.cylinder.elements=[500,320]", "--set", "time.end=1e-6"])
    require(code == 2, f"a rank without memory ends with {code}:\n{said}")
    says_once(said, "of memory")
    return seconds


FAULTS = {fault.__name__: fault for fault in [bad_deck, bad_command_line, full_disk, little_memory]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--trials", type=int, default=len(FAULTS))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    longest = 0.0
    for number in range(options.trials):
        name = list(FAULTS)[number % len(FAULTS)]
        chance = random.Random(1000 * options.seed + number)
        with tempfile.TemporaryDirectory(prefix="brio-ranks-") as folder:
            try:
                longest = max(longest, FAULTS[name](str(options.program.resolve()), pathlib.Path(folder),
                                                    chance.choice([2, 3, 4]), chance))
            except (Failed, subprocess.TimeoutExpired) as fault:
                print(f"trial {number}, {name}: {fault}", file=sys.stderr)
                return 1
    print(f"{options.trials} faults ended all ranks, the last of them after {longest:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
