#!/usr/bin/env python3
"""Speeds of elements and search in one table, beside yardstick programs if there are any.

    apps/bench/table.py [--yardsticks FOLDER] [--build FOLDER] [--only WORD] [--rounds N] [--csv FILE]

FOLDER of the yardsticks may hold yard_hex, yard_shell and yard_search; each prints lines with "best NUMBER" and "med
NUMBER". One thread, held to one core. Benches and yardsticks take turns in every round, so that both meet the same
noise; best is the best of all rounds, median the median of the rounds' medians, ratio how many times faster than the
yardstick.
"""
import argparse
import csv
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys

# bench, words of its line, pattern of the yardstick's line
ELEMENT_ROWS = [
    ("hex", "jaumann elastic double 1", r"double .*W=8 +transp chunkscatter Jau .*nt=1:"),
    ("hex", "jaumann elastic_plastic double 1", r"double .*W=8 +transp chunkscatter Jau .*nt=1:"),
    ("hex", "green_naghdi elastic double 1", r"double .*W=8 +transp chunkscatter GN .*nt=1:"),
    ("hex", "green_naghdi elastic_plastic double 1", r"double .*W=8 +transp chunkscatter GN .*nt=1:"),
    ("hex", "jaumann elastic float 1", r"float .*W=16 +transp chunkscatter Jau .*nt=1:"),
    ("hex", "jaumann elastic_plastic float 1", r"float .*W=16 +transp chunkscatter Jau .*nt=1:"),
    ("shell", "elastic slow double 1", r"double +W=8 +nip=5 .*nt=1:.*frac 0\.0"),
    ("shell", "elastic_plastic slow double 1", r"double +W=8 +nip=5 .*nt=1:.*frac 0\.0"),
    ("shell", "elastic_plastic fast double 1", r"double +W=8 +nip=5 .*nt=1:.*frac 0\.[1-9]"),
    ("shell", "power_law_hardening fast double 1", r"double +W=8 +nip=5 .*nt=1:.*frac 0\.[1-9]"),
    ("shell", "elastic_plastic slow float 1", r"float +W=16 +nip=5 .*nt=1:.*frac 0\.0"),
    ("shell", "elastic_plastic fast float 1", r"float +W=16 +nip=5 .*nt=1:.*frac 0\.[1-9]"),
]
# scene of bench_search, scene of the yardstick (of the same kind and size, not the same nodes), library
SEARCH_ROWS = [
    (ours, theirs, library)
    for ours, theirs in (("wall", "bricks17"), ("crumpled", "crumple"), ("debris", "debris"))
    for library in ("CGAL box_int_d", "nanoflann")
]
YARDSTICK_OPTIONS = {"hex": ["64"], "shell": ["512"], "search": ["bricks17", "crumple", "debris"]}


def pinned(command):
    return ["taskset", "-c", "0"] + command if shutil.which("taskset") else command


def run_bench(command, held=True):
    """Lines of its table. Held: to one core."""
    result = subprocess.run(pinned(command) if held else command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)} failed: {result.stderr.strip()}")
    return list(csv.DictReader(result.stdout.splitlines()))


def run_yardstick(program, bench, patterns):
    """Its lines that match, by pattern; it is stopped when all have come."""
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    command = pinned([str(program)] + YARDSTICK_OPTIONS[bench])
    found = {}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        for line in process.stdout:
            for pattern in patterns:
                if pattern not in found and re.search(pattern, line):
                    found[pattern] = line
            if len(found) == len(patterns):
                process.kill()
                break
    return found


def number_after(word, line):
    return float(re.search(word + r" +([0-9.]+)", line).group(1))


class Row:
    def __init__(self, bench, case, unit, pattern):
        self.bench, self.case, self.unit, self.pattern = bench, case, unit, pattern
        self.own, self.yardstick = [], []  # (best, median) of every round

    def best(self, pairs):
        return (min if self.unit == "ms" else max)(pair[0] for pair in pairs)

    def median(self, pairs):
        return statistics.median(pair[1] for pair in pairs)

    def ratio(self, own, yardstick):
        return yardstick / own if self.unit == "ms" else own / yardstick

    def cells(self):
        own = [self.best(self.own), self.median(self.own)]
        cells = [self.bench, self.case, self.unit] + [f"{x:.2f}" for x in own]
        if not self.yardstick:
            return cells + [""] * 4
        other = [self.best(self.yardstick), self.median(self.yardstick)]
        ratios = [self.ratio(a, b) for a, b in zip(own, other)]
        return cells + [f"{x:.2f}" for x in other + ratios]


def search_pattern(scene, library):
    return rf"^{scene} .*{library} .*nt=1 "


def all_rows(only):
    rows = [Row(bench, case, "Mel/s", pattern) for bench, case, pattern in ELEMENT_ROWS]
    rows += [
        Row("search", f"{ours} beside {library.split()[0]}", "ms", search_pattern(theirs, library))
        for ours, theirs, library in SEARCH_ROWS
    ]
    return [row for row in rows if only in f"{row.bench} {row.case}"]


def measure_elements(rows, build):
    for row in rows:
        lines = run_bench([str(build / f"bench_{row.bench}"), "--csv", "--repeats", "7", "--only", row.case])
        row.own.append((float(lines[0]["best_Mel/s"]), float(lines[0]["median_Mel/s"])))


def measure_search(rows, build):
    times = {
        line["scene"]: (float(line["best_ms"]), float(line["median_ms"]))
        for line in run_bench([str(build / "bench_search"), "--csv"])
        if line["strategy"] == "tree"
    }
    for row in rows:
        row.own.append(times[row.case.split()[0]])


def read_yardstick(row, line):
    if row.unit == "Mel/s":
        return number_after("best", line), number_after("med", line)
    built = number_after("build", line)
    return built + number_after("query", line), built + number_after("med", line)


def measure(rows, build, yardsticks):
    for bench in ("hex", "shell", "search"):
        of_bench = [row for row in rows if row.bench == bench]
        if not of_bench:
            continue
        (measure_search if bench == "search" else measure_elements)(of_bench, build)
        program = yardsticks / f"yard_{bench}" if yardsticks else None
        if not program or not program.exists():
            continue
        found = run_yardstick(program, bench, {row.pattern for row in of_bench})
        for row in of_bench:
            if row.pattern in found:
                row.yardstick.append(read_yardstick(row, found[row.pattern]))


def print_table(table):
    widths = [max(len(line[column]) for line in table) for column in range(len(table[0]))]
    for line in table:
        print("  ".join(cell.ljust(w) if i < 3 else cell.rjust(w) for i, (cell, w) in enumerate(zip(line, widths))))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--yardsticks", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build/release"))
    parser.add_argument("--only", default="", help="rows that hold this word")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--csv", type=pathlib.Path)
    options = parser.parse_args()
    if options.rounds < 1:
        parser.error("--rounds is at least 1")
    if options.yardsticks and not options.yardsticks.is_dir():
        parser.error(f"there is no folder {options.yardsticks}")
    rows = all_rows(options.only)
    if not rows:
        parser.error(f"no row holds '{options.only}'")
    for _ in range(options.rounds):
        measure(rows, options.build, options.yardsticks)
    head = ["bench", "case", "unit", "best", "median", "yard_best", "yard_median", "ratio_best", "ratio_median"]
    table = [head] + [row.cells() for row in rows]
    print_table(table)
    if options.csv:
        with open(options.csv, "w", newline="") as file:
            csv.writer(file).writerows(table)


if __name__ == "__main__":
    main()
