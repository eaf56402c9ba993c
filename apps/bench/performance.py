#!/usr/bin/env python3
"""What the program costs on this machine: kernels, search and whole scenes, beside bandwidth and arithmetic of the same run.

    apps/bench/performance.py [--build FOLDER] [--rounds N] [--only WORD] [--peer NAME=COMMAND]...
                              [--markdown FILE] [--guard FILE] [--store FILE]

Everything takes its turn in every round; the best of all rounds counts. Costs are given in operations: multiply-adds (of
two operations) that one thread would have done in registers in that time, which says more of other machines than
seconds do. `--store` keeps them, `--guard` compares with what was kept and names what costs over 15 % more (exit code
1). A peer is a command that computes whatever one wants to compare with, its wall time is measured as that of the scenes.
Needs a build with -DBRIO_BENCH=ON.
"""
import argparse
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

from table import run_bench

MORE_THAN = 1.15
INPUTS = pathlib.Path(__file__).resolve().parents[2] / "inputs"
# deck, end of the run (of seconds: shorter runs are too noisy to be kept), whether in single precision as well
SCENES = [
    ("can_buckling", "1e-3", True),
    ("pipe_cutting", "0.2e-3", False),
    ("brick_stack", "2e-3", False),
    ("brick_stack_fine", "0.6e-3", True),
    ("plate_perforation", "2e-5", True),
    ("net", "2e-2", False),
    ("panel_impulse", "1e-3", True),
    ("bird_strike", "0.3e-3", False),
]
KERNELS = [
    # bench, words of its lines, columns that name a line
    ("hex", "elastic_plastic", ["rate", "material", "number", "threads"]),
    ("shell", "elastic_plastic fast", ["material", "points", "number", "threads"]),
    ("particle", "", ["kernel", "motion", "threads"]),
]
STAGES = ["elements", "contact", "contact_search", "nodes", "output"]


def lines_of_bench(build, bench, *options):
    return run_bench([str(build / f"bench_{bench}"), "--csv", *options], held=False)


class Measured:
    """Best values of all rounds, by name: of rates the largest, of seconds the least."""

    def __init__(self):
        self.machine, self.kernel, self.search, self.scene, self.peer = {}, {}, {}, {}, {}

    @staticmethod
    def keep(values, name, value, best):
        values[name] = best(values[name], value) if name in values else value

    def operations(self, number="double"):
        """Of one thread in a second."""
        return 1e9 * self.machine[f"multiply-add {number} GFLOP/s", "1"]

    def costs(self):
        """By name, operations of one thread in the time of an element and a step, or of a search."""
        costs = {}
        for name, rate in self.kernel.items():
            number = "float" if " float " in f" {name} " else "double"
            costs[name] = self.operations(number) / (1e6 * rate)
        for name, milliseconds in self.search.items():
            costs[f"search {name}"] = self.operations() * 1e-3 * milliseconds
        for (scene, number, threads), run in self.scene.items():
            costs[f"{scene} {number} {threads}"] = run["seconds"] / run["updates"] * self.operations()
        return costs


def measure_kernels(measured, build, only):
    for line in lines_of_bench(build, "machine"):
        measured.keep(measured.machine, (line["quantity"], line["threads"]), float(line["best"]), max)
    for bench, words, columns in KERNELS:
        if only not in bench:
            continue
        for line in lines_of_bench(build, bench, "--repeats", "3", *(["--only", words] if words else [])):
            name = " ".join([bench] + [line[column] for column in columns])
            rate = next(line[column] for column in line if column.startswith("best_M"))
            measured.keep(measured.kernel, name, float(rate), max)
    if only in "search":
        for line in lines_of_bench(build, "search"):
            if line["strategy"] == "tree":
                measured.keep(measured.search, line["scene"], float(line["best_ms"]), min)


def deck_of(scene, end, number, folder):
    text = (INPUTS / f"{scene}.yaml").read_text()
    text, count = re.subn(r"^time: \{end: [0-9.e-]+", f"time: {{end: {end}", text, flags=re.MULTILINE)
    if count != 1:
        sys.exit(f"{scene}: its deck has no line 'time: {{end: ...'")
    if number == "float":
        text += "\nnumerics: {precision: float}\n"
    path = folder / f"{scene}.yaml"
    path.write_text(text)
    return path


def measure_scene(measured, build, scene, end, number, threads):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        deck = deck_of(scene, end, number, folder)
        command = [build / "brio", "run", deck, "--threads", str(threads), "--output", folder / "results"]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{scene} failed: {done.stderr.strip().splitlines()[-1]}")
        summary = json.loads(next((folder / "results").glob("*.summary.json")).read_text())
    wall = summary["wall_s"]
    run = {
        "seconds": wall["total"],
        "stages": wall["by_stage"],
        "updates": summary["steps"] * sum(summary["elements"].values()),
        "elements": sum(summary["elements"].values()),
        "steps": summary["steps"],
        "constraints": summary.get("contact", {}).get("constraints_total", 0),
    }
    known = measured.scene.get((scene, number, threads))
    if known is None or run["seconds"] < known["seconds"]:
        measured.scene[scene, number, threads] = run


def measure_peer(measured, name, command):
    start = time.monotonic()
    done = subprocess.run(shlex.split(command), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{name} failed: {done.stderr.strip()[-500:]}")
    measured.keep(measured.peer, name, time.monotonic() - start, min)


def measure(measured, options):
    measure_kernels(measured, options.build, options.only)
    for scene, end, in_single in SCENES:
        if options.only not in scene:
            continue
        for number in ["double", "float"] if in_single else ["double"]:
            for threads in (1, 2):
                measure_scene(measured, options.build, scene, end, number, threads)
    for name, command in options.peer:
        measure_peer(measured, name, command)


def rows_of_machine(measured):
    yield ["", "1 thread", "2 threads"]
    for quantity in dict.fromkeys(quantity for quantity, _ in measured.machine):
        yield [quantity] + [f"{measured.machine[quantity, threads]:.1f}" for threads in ("1", "2")]


def rows_of_kernels(measured):
    yield ["kernel", "million element-steps a second", "operations for each"]
    costs = measured.costs()
    for name, rate in measured.kernel.items():
        yield [name, f"{rate:.2f}", f"{costs[name]:,.0f}"]


def rows_of_search(measured):
    yield ["global search (`bench_search`)", "ms"]
    for name, milliseconds in measured.search.items():
        yield [name, f"{milliseconds:.1f}"]


def shares(run):
    listed = {stage: run["stages"].get(stage, 0) for stage in STAGES}
    rest = run["seconds"] - sum(listed.values())
    return [f"{100 * part / run['seconds']:.0f}" for part in [*listed.values(), rest]]


def rows_of_scenes(measured):
    yield ["scene", "elements", "steps", "us an element and step", *[f"{stage} %" for stage in STAGES], "rest %",
           "whole over elements", "us of contact a constraint", "two threads", "single precision"]
    for (scene, number, threads), run in measured.scene.items():
        if number != "double" or threads != 1:
            continue
        over = lambda other: f"{run['seconds'] / other['seconds']:.2f}" if other else ""
        contact = run["stages"].get("contact", 0) + run["stages"].get("contact_search", 0)
        yield [scene, f"{run['elements']:,}", f"{run['steps']:,}", f"{1e6 * run['seconds'] / run['updates']:.3f}",
               *shares(run), f"{run['seconds'] / run['stages']['elements']:.2f}",
               f"{1e6 * contact / run['constraints']:.2f}" if run["constraints"] else "",
               over(measured.scene.get((scene, "double", 2))), over(measured.scene.get((scene, "float", 1)))]


def rows_of_peers(measured):
    yield ["peer", "s"]
    for name, seconds in measured.peer.items():
        yield [name, f"{seconds:.2f}"]


TABLES = [
    ("Machine", rows_of_machine),
    ("Kernels", rows_of_kernels),
    ("Search", rows_of_search),
    ("Scenes", rows_of_scenes),
    ("Peers", rows_of_peers),
]


def as_markdown(rows):
    head, *body = rows
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in body])


def processor():
    found = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return found.group(1) if found else "unknown"


def page(measured, rounds):
    text = [f"""# Performance

Made by `apps/bench/performance.py --rounds {rounds} --markdown docs/performance.md` (a build with `-DBRIO_BENCH=ON`) on: {processor()}. Everything
takes its turn in every round, and the best of {rounds} counts. Compare ratios, not seconds: machines differ, and this one has other guests.

* `--store FILE` keeps what was measured, `--guard FILE` names what costs over {100 * (MORE_THAN - 1):.0f} % more than what was kept (`apps/bench/costs.json` is
  of the run of this page).
  On a machine with other guests noise is named too: one round of the same program named 8 of 47 costs, by up to 1.34.
* `--peer NAME=COMMAND` measures another program in the same rounds.
* *Operations*: multiply-adds, of two operations each, that one thread does in registers in the time of one element and step.
* Scenes are the shipped decks up to the time that the script names. *Whole over elements*: wall time over that of the element kernels.
  *Contact a constraint*: time of contact and its search over the constraint rows of all steps; where little touches, it is the price of making sure
  of that. *Two threads*, *single precision*: how many times as fast. Scenes of some hundred elements gain nothing from a second thread."""]
    for title, rows in TABLES:
        table = list(rows(measured))
        if len(table) > 1:
            text += [f"## {title}", as_markdown(table)]
    return "\n\n".join(text) + "\n"


def compare(costs, kept):
    """Prints what costs more than it did. \\returns whether anything does"""
    worse = {name: costs[name] / kept[name] for name in costs if name in kept and costs[name] > MORE_THAN * kept[name]}
    for name, ratio in sorted(worse.items(), key=lambda item: -item[1]):
        print(f"{name}: costs {ratio:.2f} times what it did")
    return bool(worse)


def named_command(word):
    name, separator, command = word.partition("=")
    if not separator or not command:
        raise argparse.ArgumentTypeError("NAME=COMMAND is wanted")
    return name, command


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build/release"))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", default="", help="benches and scenes whose names hold this word")
    parser.add_argument("--peer", type=named_command, action="append", default=[], metavar="NAME=COMMAND")
    parser.add_argument("--markdown", type=pathlib.Path)
    parser.add_argument("--guard", type=pathlib.Path)
    parser.add_argument("--store", type=pathlib.Path)
    options = parser.parse_args()
    if options.rounds < 1:
        parser.error("--rounds is at least 1")
    kept = json.loads(options.guard.read_text()) if options.guard else {}
    measured = Measured()
    for _ in range(options.rounds):
        measure(measured, options)
    text = page(measured, options.rounds)
    print(text)
    if options.markdown:
        options.markdown.write_text(text)
    if options.store:
        options.store.write_text(json.dumps(measured.costs(), indent=1) + "\n")
    return 1 if compare(measured.costs(), kept) else 0


if __name__ == "__main__":
    sys.exit(main())
