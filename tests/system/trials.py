#!/usr/bin/env python3
"""Trials of the program among faults: writers that meet, runs and studies that are killed or stopped, streams that
cannot be written, files that are broken. After each one, every result that is left must verify, every exit code must
be a documented one, and the next call must work.

Usage: tests/system/trials.py BRIO [--trials N] [--seed N] [--kinds two_writers,killed_run,...]
Exits with 1 after the first trial that fails, whose folder is kept and named."""

import argparse
import collections
import csv
import math
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

DECK = """
materials:
  rubber: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: 0}
parts:
  bar: {mesh: {box: {size: [1, 0.1, 0.1], elements: [20, 2, 2]}}, element: hex8, material: rubber}
boundary_conditions: [{set: bar.xmin, fix: [x, y, z]}]
initial_conditions: [{set: bar.xmax, velocity: [1, 0, 0]}]
time: {end: 2e-2}
output: {fields: {every: 5e-4}, history: {every: 1e-5}}
"""
STUDY = """
title: 'A bar `touch run_by_title`'
deck: bar.yaml
reference: mesh.fine
quantities:
  length: {field: position, component: x, part: bar, take: range, time: 1e-3}
  kinetic: {history: kinetic, take: mean}
knobs:
  mesh:
    coarse: {"parts.bar.mesh.box.elements": [10, 1, 1]}
    fine: {"parts.bar.mesh.box.elements": [40, 2, 2]}
  precision:
    float: {numerics.precision: float}
"""
DOCUMENTED = {0, 2, 3, 4, 128 + signal.SIGHUP, 128 + signal.SIGINT, 128 + signal.SIGTERM}
LONG = ["--set", "time.end=1e3", "--set", "output.fields.every=1e-3", "--set", "output.history.every=1e-4"]


class Failed(Exception):
    pass


def require(condition, what):
    if not condition:
        raise Failed(what)


class Trial:
    """A folder with a deck and a study, and the program in it."""

    def __init__(self, program, folder, chance, expected):
        self.program, self.folder, self.chance, self.expected = program, folder, chance, expected
        (folder / "bar.yaml").write_text(DECK)
        (folder / "bars.yaml").write_text(STUDY)

    def start(self, *arguments, **options):
        options = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL} | options
        return subprocess.Popen([self.program, *arguments], cwd=self.folder, **options)

    def brio(self, *arguments, **options):
        """Its exit code and what it complained of; the code must be documented."""
        process = self.start(*arguments, **options)
        return self.end(process)

    def end(self, process, seconds=120):
        try:
            faults = (process.communicate(timeout=seconds)[1] or b"").decode(errors="replace")
        except subprocess.TimeoutExpired:
            process.kill()
            raise Failed(f"{process.args} does not end") from None
        code = process.returncode
        if -code in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):  # before there was anything to close
            code = 128 - code
        require(code in DOCUMENTED or code == -signal.SIGKILL, f"{process.args} ended with {code}: {faults}")
        return code, faults

    def run(self, *arguments, **options):
        return self.brio("run", "bar.yaml", "--threads", "1", "--quiet", *arguments, **options)

    def verify(self, result):
        """Whatever is there must be whole: a result folder may be one whose first dump is not complete."""
        code, faults = self.brio("info", result, "--verify")
        begun = "has not completed its first dump" in faults or "no .vtkhdf file" in faults
        require(code == 0 or (code == 4 and begun), f"{result}: {code}: {faults}")
        return code == 0

    def verify_all(self):
        for file in self.folder.rglob("*.vtkhdf"):
            require(self.verify(file), f"{file} does not verify")

    def runs_again(self):
        code, faults = self.run("--overwrite")
        require(code == 0, f"the run after it ended with {code}: {faults}")
        require(self.verify("bar.results"), "the run after it left no result")

    def study_again(self):
        """The same command goes on, and comes to the same figures as one that nothing happened to."""
        code, faults = self.brio("study", "bars.yaml", "--quiet")
        require(code == 0, f"the study after it ended with {code}: {faults}")
        self.verify_all()
        require(figures(self.folder) == self.expected, "the table differs from that of an undisturbed study")
        require(not list(self.folder.rglob("run_by_title")), "text of the study was run")

    def wait(self, seconds):
        time.sleep(self.chance.uniform(0, seconds))

    def has_processes(self):
        for entry in pathlib.Path("/proc").iterdir():
            try:
                if entry.name.isdigit() and os.readlink(entry / "cwd") == str(self.folder):
                    return True
            except OSError:
                pass
        return False


def figures(folder):
    with open(folder / "bars.study" / "bars.csv", newline="") as table:
        return [(row["run"], row["exit_code"], row["length"], row["kinetic"]) for row in csv.DictReader(table)]


# ---------------------------------------------------------------------------------------------------- kinds of trials


def two_writers(trial):
    writers = [trial.start("run", "bar.yaml", "--threads", "1", "--quiet", *trial.chance.choice([[], ["--overwrite"]]))
               for _ in range(trial.chance.randint(2, 4))]
    ends = [trial.end(writer) for writer in writers]
    pids = [str(writer.pid) for writer in writers]
    require(any(code == 0 for code, _ in ends), f"none came through: {ends}")
    for code, faults in ends:
        require(code == 0 or (code == 4 and any(f"process {pid} on" in faults for pid in pids)),
                f"{code}: {faults}")
    require(trial.verify("bar.results"), "no result")
    trial.verify_all()
    require((trial.folder / "bar.results" / "bar.summary.json").exists(), "no summary")
    trial.runs_again()


def two_studies(trial):
    studies = [trial.start("study", "bars.yaml", "--quiet", "--jobs", "2") for _ in range(2)]
    ends = [trial.end(study) for study in studies]
    codes = sorted(code for code, _ in ends)
    require(codes in ([0, 0], [0, 4]), f"{ends}")
    for code, faults in ends:
        require(code == 0 or any(f"process {study.pid} on" in faults for study in studies), faults)
    trial.study_again()


def killed_run(trial):
    trial.run()
    process = trial.start("run", "bar.yaml", "--threads", "1", "--quiet", *LONG,
                          "--set", f"output.sync={trial.chance.choice(['never', 'end', 'dumps'])}")
    trial.wait(0.5)
    process.kill()
    trial.end(process)
    trial.verify_all()
    whole = [folder for folder in ("bar.results", "bar.results.previous")
             if (trial.folder / folder / "bar.summary.json").exists()]
    require(len(whole) == 1, f"of the earlier results there are {whole}")
    trial.runs_again()


def killed_study(trial):
    jobs = str(trial.chance.randint(1, 3))
    for _ in range(trial.chance.randint(1, 3)):
        process = trial.start("study", "bars.yaml", "--jobs", jobs)
        trial.wait(0.8)
        process.kill()
        trial.end(process)
    trial.study_again()


def ends_with_its_study(trial):
    process = trial.start("study", "bars.yaml", "--jobs", "2")
    trial.wait(0.4)
    process.kill()
    trial.end(process)
    for _ in range(100):
        if not trial.has_processes():
            break
        time.sleep(0.02)
    require(not trial.has_processes(), "runs live on after their study")
    trial.verify_all()


def stopped(trial, arguments, sent):
    process = trial.start(*arguments)
    deadline = time.monotonic() + 20
    while not list(trial.folder.rglob("*.vtkhdf")) and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.005)
    trial.wait(0.3)
    process.send_signal(sent)
    return trial.end(process)


def stopped_run(trial):
    sent = trial.chance.choice([signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
    code, faults = stopped(trial, ["run", "bar.yaml", "--threads", "1", "--quiet", *LONG], sent)
    require(code == 128 + sent, f"{sent}: {code}: {faults}")
    require(trial.verify("bar.results"), "no result")
    require((trial.folder / "bar.results" / "bar.summary.json").exists(), "no summary")
    trial.runs_again()


def hung_up_under_nohup(trial):
    process = trial.start("run", "bar.yaml", "--threads", "1", "--quiet", *LONG,
                          preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    while not list(trial.folder.rglob("*.vtkhdf")):
        time.sleep(0.005)
    process.send_signal(signal.SIGHUP)
    time.sleep(0.3)
    require(process.poll() is None, "a run that ignores hang-ups ended with one")
    process.send_signal(signal.SIGTERM)
    code, faults = trial.end(process)
    require(code == 128 + signal.SIGTERM, f"{code}: {faults}")
    require(trial.verify("bar.results"), "no result")


def stopped_study(trial):
    sent = trial.chance.choice([signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
    code, faults = stopped(trial, ["study", "bars.yaml", "--quiet", "--jobs", "2"], sent)
    require(code in (0, 128 + sent), f"{sent}: {code}: {faults}")
    require(not trial.has_processes(), "runs live on after their study")
    trial.verify_all()
    trial.study_again()


def broken_member(trial):
    trial.study_again()
    for _ in range(3):
        folder = trial.folder / "bars.study" / "runs"
        file = trial.chance.choice([f for f in folder.rglob("*") if f.is_file() and f.suffix in (".vtkhdf", ".json")])
        content = bytearray(file.read_bytes())
        how = trial.chance.randrange(4)
        if how == 0:
            file.unlink()
        elif how == 1:
            file.write_bytes(content[:trial.chance.randrange(len(content))])
        elif how == 2:
            for _ in range(trial.chance.randint(1, 200)):
                content[trial.chance.randrange(len(content))] = trial.chance.randrange(256)
            file.write_bytes(content)
        else:
            file.unlink()
            os.mkfifo(file)
        trial.study_again()


def damaged_result(trial):
    """Never a crash; a change of a table is named."""
    trial.run()
    file = trial.folder / "bar.results" / "bar.vtkhdf"
    whole = file.read_bytes()
    for _ in range(20):
        content = bytearray(whole)
        for _ in range(trial.chance.choice([1, 10, 1000])):
            content[trial.chance.randrange(len(content))] = trial.chance.randrange(256)
        if trial.chance.random() < 0.2:
            content = content[:trial.chance.randrange(len(content))]
        file.write_bytes(content)
        code, faults = trial.brio("info", "bar.results", *trial.chance.choice([[], ["--verify"]]))
        require(code in (0, 4), f"{code}: {faults}")
        require(code == 0 or str(file.name) in faults, faults)


def full_disk(trial):
    trial.run()
    bytes_left = trial.chance.randint(1, 2_000_000)

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_left, bytes_left))

    code, faults = trial.run(*LONG, preexec_fn=limit)
    require(code == 4, f"{code}: {faults}")
    trial.verify_all()
    trial.runs_again()


def full_streams(trial):
    """Standard output that cannot be written is exit code 4 of every command, an error stream is of no account."""
    trial.run()
    with open("/dev/full", "wb") as full:
        for arguments in (["run", "bar.yaml", "--threads", "1", "--overwrite"], ["check", "bar.yaml", "--coarse-run=0"],
                          ["info", "bar.results"], ["schema"], ["study", "bars.yaml"], ["--version"], ["--help"]):
            code, faults = trial.brio(*arguments, stdout=full)
            require(code == 4, f"{arguments} with full output: {code}: {faults}")
        code, faults = trial.brio("run", "bar.yaml", "--threads", "1", "--overwrite", stderr=full)
        require(code == 0, f"run with a full error stream: {code}")
        code, faults = trial.brio("study", "bars.yaml", stderr=full)
        require(code == 0, f"study with a full error stream: {code}")
    for closed in (1, 2):
        code, faults = trial.brio("run", "bar.yaml", "--threads", "1", "--overwrite",
                                  preexec_fn=lambda stream=closed: os.close(stream))
        require(code == (4 if closed == 1 else 0), f"run with closed stream {closed}: {code}: {faults}")
    trial.verify_all()


def gone_reader(trial):
    """A reader that goes away does not end a run; it has its results."""
    for stream in ("stdout", "stderr"):
        process = trial.start("run", "bar.yaml", "--threads", "1", "--overwrite", **{stream: subprocess.PIPE})
        getattr(process, stream).close()
        process.wait(timeout=120)
        require(process.returncode in (0, 4), f"{stream}: {process.returncode}")
        require(stream == "stdout" or process.returncode == 0, f"{stream}: {process.returncode}")
        require(trial.verify("bar.results"), "no result")
        require((trial.folder / "bar.results" / "bar.summary.json").exists(), "no summary")


KINDS = [two_writers, two_studies, killed_run, killed_study, ends_with_its_study, stopped_run, stopped_study,
         hung_up_under_nohup, broken_member, damaged_result, full_disk, full_streams, gone_reader]


def undisturbed(program):
    with tempfile.TemporaryDirectory(prefix="brio-trial-") as folder:
        trial = Trial(program, pathlib.Path(folder).resolve(), random.Random(0), None)
        code, faults = trial.brio("study", "bars.yaml", "--quiet")
        require(code == 0, f"a study that nothing happens to ends with {code}: {faults}")
        table = figures(trial.folder)
        require(all(math.isfinite(float(row[2])) for row in table), f"{table}")
        return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--trials", type=int, default=len(KINDS))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", default=",".join(kind.__name__ for kind in KINDS))
    options = parser.parse_args()
    kinds = [kind for kind in KINDS if kind.__name__ in options.kinds.split(",")]
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # also where this runs under nohup
    program = str(options.program.resolve())
    expected = undisturbed(program)
    done = collections.Counter()
    for number in range(options.trials):
        kind = kinds[number % len(kinds)]
        folder = pathlib.Path(tempfile.mkdtemp(prefix="brio-trial-")).resolve()
        try:
            kind(Trial(program, folder, random.Random(1000 * options.seed + number), expected))
        except Failed as fault:
            print(f"trial {number}, {kind.__name__}, in {folder}: {fault}", file=sys.stderr)
            return 1
        shutil.rmtree(folder)
        done[kind.__name__] += 1
    print(f"{options.trials} trials, nothing corrupt: " + ", ".join(f"{n} {kind}" for kind, n in done.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
