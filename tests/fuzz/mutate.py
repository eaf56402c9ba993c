#!/usr/bin/env python3
"""Damages decks, results and study folders and looks at how `brio` ends.

    mutate.py BRIO [--optimized BRIO] [--decks N] [--results N] [--studies N] [--seed S] [--only KIND:NUMBER]
              [--keep FOLDER]

A mutant is one of the shipped decks, of the results of a small run, or of the folder of a small study, with one
to four faults of structure, of numbers, of text or of bytes. The same seed and number make the same mutant.
What is a failure: a signal, a report of a sanitizer, an exit code that is not documented, 20 s of processor time
(a run has to end when it is told to), a refusal of a deck that names no place, of a file that names no path.
Under sanitizers everything takes ten to twenty times as long: there a mutant has twenty times the time, and what
takes more than 20 s is run again by the optimized program, whose time counts.
A fault inside the HDF5 library ends the child process that reads (io/files/read_apart.hpp); it is counted apart.
Prints a line for each failure and a table at the end; exit code 1 if there were failures.
"""

import argparse
import copy
import functools
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import yaml

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CODES = {0: "good", 2: "refused", 3: "numerical failure", 4: "file", 143: "stopped"}
STOP_AFTER, LIMIT = 8, 20  # s of processor time
SLOWDOWN = 20  # by sanitizers, at most
PLACE = re.compile(r"^(.+:\d+:\d+: |--set .+: )", re.S)
UNREADABLE = re.compile(r": (is a folder|cannot be opened|is too long)")  # a file of which no line was read
REPORTS = ("Sanitizer", "runtime error:", "Assertion", "a defect of this program", "terminate called")

SMALL_DECK = """
title: Two cubes, a plate and a rod
materials:
  soft: {model: elastic, density: 1000, youngs_modulus: 1e7, poissons_ratio: 0.3}
  metal: {model: power_law_hardening, density: 7800, youngs_modulus: 2e11, poissons_ratio: 0.3,
          yield_stress: 3e8, hardening_constant: 4e8, hardening_exponent: 0.3}
parts:
  cube: {mesh: {box: {size: [1, 1, 1], elements: [2, 2, 2]}}, element: hex8, material: soft,
         deletion: {corner_inverted: true}}
  floor: {mesh: {plate: {size: [2, 2], elements: [3, 3]}}, element: {type: shell4, thickness: 0.02}, material: metal,
          placement: {translate: [0, 0, -0.6]}}
  rod: {mesh: {line: {start: [0.3, 0.3, 0.7], end: [0.3, 0.3, 1.5], elements: 4}},
        element: {type: beam2, section: {circle: {radius: 0.01}}}, material: metal}
  block: {mesh: {box: {size: [0.4, 0.4, 0.4], elements: [2, 2, 2]}}, element: rigid, material: metal,
          placement: {translate: [0, 0, 2], rotate: {axis: [0, 0, 1], degrees: 30}}}
  grains: {mesh: {particles: {box: {size: [0.5, 0.5, 0.5], spacing: 0.1}}}, element: particle, material: soft,
           placement: {translate: [3, 0, 0]}}
initial_conditions: [{part: cube, velocity: [0, 0, -5]}, {part: block, velocity: [0, 0, -1]}]
boundary_conditions:
  - {set: floor.boundary, fix: [x, y, z, rx, ry, rz]}
  - {set: rod.end, velocity: {x: [[0, 0], [1e-3, 1]]}}
  - {rigid_wall: {point: [0, 0, -2], normal: [0, 0, 1], friction: 0.2}}
loads:
  - {gravity: [0, 0, -9.81], factor: [[0, 0], [1e-3, 1]]}
  - {side_set: floor.all, pressure: 10}
  - {set: cube.top, force: [0, 0, 1]}
contact: {surfaces: all, exclude: [grains], friction: 0.1, pairs: [{parts: [cube, floor], friction: 0.3}]}
time: {end: 1e-3, step_scale: 0.8}
output:
  fields: {every: 2e-4}
  history: {every: 1e-4, probes: {tip: {point: [0.3, 0.3, 1.5], part: rod}}}
numerics: {preset: balanced}
"""
STUDY = """
title: Small study
deck: small.yaml
set: {time.end: 2e-4}
quantities:
  kinetic: {history: kinetic}
  lift: {field: displacement, component: z, take: max}
reference: numerics.double
knobs:
  numerics:
    double: {numerics.precision: double}
  step:
    short: {time.step_scale: 0.5}
combinations: [[numerics.double, step.short]]
"""

NUMBERS = ["0", "-0", "-1", "1", "1e-300", "1e300", "1e308", "-1e308", "4.9e-324", "1e999", "-1e999", ".nan", ".inf",
           "nan", "inf", "2147483647", "2147483648", "4294967296", "1000000000", "1e18", "9223372036854775808", "1.5",
           "0x10", "1_000", "1e", "--1", "1e-20", "1e20"]
TEXTS = ["", "~", "true", "abc", "\u00e4\u00f6", "\U0001f9f1", "\ufeff", "a.b", ".", "..", "../..", "all", "cube", "x" * 100000,
         "`id`", "$(id)", "%s%n", "*", "&a", "<<", "null", "{}", "[]", "-", "\t", "\u202e", "'", '"', "\\", "a\nb"]


def leaves(node, path=()):
    """Paths of everything in a tree of maps and lists, itself included."""
    yield path
    if isinstance(node, dict):
        for key in node:
            yield from leaves(node[key], path + (key,))
    elif isinstance(node, list):
        for i, item in enumerate(node):
            yield from leaves(item, path + (i,))


def at(tree, path):
    for key in path:
        tree = tree[key]
    return tree


def raw(scalar):
    """A scalar that stands in the deck as it is, once `written` has taken off its mark."""
    return f"@@{scalar}@@"


def written(tree):
    text = yaml.safe_dump(tree, sort_keys=False, allow_unicode=True, default_flow_style=None)
    return re.sub(r"'@@(.*?)@@'", r"\1", text)


def other_value(rng, tree, paths, old):
    kind = rng.randrange(12)
    if kind < 4:
        return raw(rng.choice(NUMBERS))
    if kind == 4:
        return rng.choice(TEXTS)
    if kind == 5:
        return copy.deepcopy(at(tree, rng.choice(paths)))
    if kind == 6:
        return rng.choice([None, True, {}, [], [[]], {"": None}, {"a": {"b": {"c": 1}}}, [1, 2], [[0, 0], [1, 1]]])
    if kind == 7:
        return [copy.deepcopy(old)] * rng.choice([1, 2, 3, 1000])
    if isinstance(old, (int, float)) and not isinstance(old, bool):
        factor = rng.choice([-1, 0, 2, 10, 1e3, 1e6, 1e12, 0.5, 0.1, 1e-3, 1e-6, 1e-12, 1 + 1e-9])
        return raw(repr(int(old * factor) if isinstance(old, int) and rng.random() < 0.7 else old * factor))
    return raw(rng.choice(NUMBERS))


def mutate_structure(rng, tree):
    paths = [path for path in leaves(tree) if path]
    if not paths:
        return {"parts": raw("1")}
    path = rng.choice(paths)
    parent, key = at(tree, path[:-1]), path[-1]
    kind = rng.randrange(8)
    if kind == 0:
        del parent[key]
    elif kind == 1 and isinstance(parent, dict):
        value = parent.pop(key)
        parent[rng.choice([str(key) + "x", str(key)[:-1], rng.choice(TEXTS), "a b", str(rng.choice(paths)[-1])])] = value
    elif kind == 2:
        other = rng.choice(paths)
        try:
            value = copy.deepcopy(at(tree, other))
            at(tree, other[:-1])[other[-1]] = copy.deepcopy(parent[key])
            parent[key] = value
        except (KeyError, IndexError, TypeError):
            pass
    elif kind == 3 and isinstance(parent, list):
        parent.insert(rng.randrange(len(parent) + 1), copy.deepcopy(parent[key]))
    elif kind == 4 and isinstance(parent, dict):
        parent[str(key) + str(rng.randrange(10))] = copy.deepcopy(parent[key])
    else:
        parent[key] = other_value(rng, tree, paths, parent[key])
    return tree


WORDS = ["hex8", "hex8_full", "shell4", "beam2", "particle", "rigid", "all", "top", "bottom", "outside", "inside", "jaumann",
         "total_lagrangian", "eulerian", "float", "double", "fast", "accurate", "truss", "cable", "keep", "drop", "fix",
         "velocity", "displacement", "acceleration", "true", "false", "x", "rz"]
MESHES = [{"box": {"size": [1, 1, 1], "elements": [2, 1, 3]}}, {"plate": {"size": [1, 1], "elements": [3, 2]}},
          {"cylinder": {"radius": 0.5, "height": 1, "elements": [8, 3]}}, {"sphere": {"radius": 0.5, "elements": 4}},
          {"rod": {"radius": 0.5, "length": 2, "elements": [4, 6]}}, {"hollow_sphere": {"radius": 0.5, "elements": 3}},
          {"tube": {"inner_radius": 0.5, "outer_radius": 0.6, "height": 1, "elements": [12, 4, 1]}},
          {"wedge": {"thickness": 0.4, "height": 1, "length": 1, "half_angle": 30, "elements": [4, 6, 4]}},
          {"line": {"start": [0, 0, 0], "end": [0, 0, 1], "elements": 5}},
          {"particles": {"sphere": {"radius": 0.5, "spacing": 0.15}}}]
ADDITIONS = [{"contact": {"surfaces": "all"}}, {"numerics": {"precision": "float"}}, {"numerics": {"preset": "fast"}},
             {"loads": [{"gravity": [0, 0, -1e6]}]}, {"time": {"end": 1, "mass_scaling": {"step": 1e-3}}},
             {"time": {"end": 1, "step": 1e-7}},
             {"contact": {"surfaces": "all", "passes": 1000000000, "reach_buffer": 1e300}}, {"output": {"fields": {"every": 1e-9}, "history": {"every": 1e-300}}}]


def mutate_plausibly(rng, tree):
    """What most often passes the checks of single values, and makes another scene."""
    parts = tree.get("parts") if isinstance(tree, dict) else None
    if not isinstance(parts, dict) or not parts or not all(isinstance(part, dict) for part in parts.values()):
        return mutate_structure(rng, tree)
    paths = [path for path in leaves(tree) if path]
    scalars = [path for path in paths if not isinstance(at(tree, path), (dict, list))]
    kind = rng.randrange(10)
    if kind < 4:
        numbers = [path for path in scalars if isinstance(at(tree, path), (int, float))
                   or re.fullmatch(r"[-+]?[0-9.]+e[-+]?[0-9]+", str(at(tree, path)))]
        for path in rng.sample(numbers, min(len(numbers), rng.choice([1, 1, 2, 5]))):
            old = at(tree, path)
            if isinstance(old, int):
                new = rng.choice([1, 2, old + 1, 2 * old, old // 2, -old])
            else:
                new = float(old) * rng.choice([-1, 0, 1.5, 2, 10, 0.1, 1e3, 1e-3, 1e6, 1e-6, 1e30, 1e-30, 1e150, 1e-150])
            at(tree, path[:-1])[path[-1]] = raw(repr(new))
    elif kind == 4:
        path = rng.choice(scalars)
        strings = [str(at(tree, other)) for other in scalars if isinstance(at(tree, other), str)] + WORDS + list(parts)
        at(tree, path[:-1])[path[-1]] = rng.choice(strings)
    elif kind == 5:
        part = parts[rng.choice(list(parts))]
        part["mesh"] = copy.deepcopy(rng.choice(MESHES))
    elif kind == 6:
        part = parts[rng.choice(list(parts))]
        part["element"] = rng.choice(["hex8", "hex8_full", "rigid", "particle", {"type": "shell4", "thickness": 0.05},
                                      {"type": "rigid", "thickness": 0.1},
                                      {"type": "beam2", "section": {"circle": {"radius": 0.05}}}])
    elif kind == 7:
        name = rng.choice(list(parts))
        parts[name + "_again"] = copy.deepcopy(parts[name])
        if rng.random() < 0.7:
            move = [rng.choice([0, 0.01, 0.1, 0.5, 1, 3]) for _ in range(3)]
            parts[name + "_again"]["placement"] = {"translate": move}
    elif kind == 8:
        tree.update(copy.deepcopy(rng.choice(ADDITIONS)))
    else:
        optional = [path for path in paths if isinstance(path[-1], int) and isinstance(at(tree, path), dict)
                    or path[-1] in ("placement", "contact", "deletion", "loads", "output", "failure", "numerics")]
        if optional:
            path = rng.choice(optional)
            del at(tree, path[:-1])[path[-1]]
    return tree


def mutate_text(rng, text):
    marks = "{}[]:,-?&*!|>'\"%@`#~<=.+0123456789eE \t\n\r\\\0\x7f\u00e9\u2028"
    at_ = rng.randrange(len(text) + 1)
    length = rng.randrange(30)
    kind = rng.randrange(10)
    if kind == 0:
        return text[:at_]
    if kind == 1:
        return text[:at_] + text[at_ + length:]
    if kind == 2:
        return text[:at_] + text[at_:at_ + length] * rng.choice([2, 3, 50]) + text[at_:]
    if kind == 3:
        return text[:at_] + rng.choice(marks) * rng.choice([1, 1, 40, 3000]) + text[at_:]
    if kind == 4:
        lines = text.split("\n")
        i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
        lines[i], lines[j] = lines[j], lines[i]
        return "\n".join(lines)
    if kind == 5:
        lines = text.split("\n")
        i = rng.randrange(len(lines))
        lines[i:i + 1] = [lines[i]] * 2
        return "\n".join(lines)
    if kind == 6:
        aliases = ["a0: &a0 [1, 1]"] + [f"a{i}: &a{i} [*a{i - 1}, *a{i - 1}]" for i in range(1, 40)]
        return text + "\n" + "\n".join(aliases) + "\n"
    if kind == 7:
        return text[:at_] + rng.choice(["[", "{", "{a: ", "- ", "? ", "*x ", "&x ", "!!binary ", "<<: "]) * rng.choice(
            [1, 1, 5000]) + text[at_:]
    numbers = list(re.finditer(r"[-+]?\d+\.?\d*(e[-+]?\d+)?", text))
    if not numbers:
        return text + rng.choice(marks)
    number = rng.choice(numbers)
    return text[:number.start()] + rng.choice(NUMBERS) + text[number.end():]


def mutate_bytes(rng, data):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 4, 16, 200])):
        if not data:
            return b"\0"
        at_ = rng.randrange(len(data)) if rng.random() < 0.5 else rng.randrange(min(len(data), 4096))
        kind = rng.randrange(7)
        if kind == 0:
            data[at_] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[at_] = rng.choice([0, 0xff, 0x7f, 0x80])
        elif kind == 2:
            data[at_:at_ + 8] = rng.choice([b"\0" * 8, b"\xff" * 8, b"\xff" * 7 + b"\x7f", b"\0\0\0\0\1\0\0\0"])
        elif kind == 3:
            data = data[:at_] if rng.random() < 0.3 else data
        elif kind == 4:
            data[at_:at_ + rng.randrange(64)] = b""
        elif kind == 5:
            other = rng.randrange(len(data))
            data[at_:at_ + 64] = data[other:other + 64]
        else:
            data[at_:at_] = bytes(rng.randrange(256) for _ in range(rng.randrange(16)))
    return bytes(data)


def mutated_deck(rng, text):
    chance = rng.random()
    if chance < 0.8:
        tree = yaml.safe_load(text)
        mutate = mutate_plausibly if chance < 0.5 else mutate_structure
        for _ in range(rng.choice([1, 1, 1, 2, 4])):
            try:
                tree = mutate(rng, tree)
            except (ValueError, TypeError, KeyError, IndexError, AttributeError):
                pass  # what an earlier fault has made of the tree
        try:
            return written(tree)
        except (yaml.YAMLError, RecursionError, TypeError):
            return text
    for _ in range(rng.choice([1, 1, 2, 4])):
        text = mutate_text(rng, text)
    return text


class Campaign:
    def __init__(self, program, optimized, seed, keep):
        self.program = str(pathlib.Path(program).resolve())
        self.optimized = str(pathlib.Path(optimized).resolve()) if optimized else None
        self.seed = seed
        self.keep = pathlib.Path(keep) if keep else None
        self.failures = 0
        self.inside_hdf5 = 0
        self.counts = {}
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="brio-fuzz-"))
        self.decks = self.shipped_decks()

    @staticmethod
    def shipped_decks():
        files = sorted((SOURCE / "inputs").glob("*.yaml")) + sorted((SOURCE / "inputs/verification").glob("*.yaml"))
        decks = []
        for file in files:
            tree = yaml.safe_load(file.read_text())
            if isinstance(tree, dict) and "parts" in tree and "time" in tree:
                text = file.read_text().replace("file: meshes/", f"file: {file.parent}/meshes/")
                decks.append((file.stem, text, float(tree["time"]["end"])))
        # The small one names nearly all that a deck can name, and is quick.
        return [("small", SMALL_DECK, 1e-3)] * len(decks) + decks

    def limit_of(self, program):
        return LIMIT * (SLOWDOWN if self.optimized and program != self.optimized else 1)

    def limits(self, program):
        limit = self.limit_of(program)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 2))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
        if not self.sanitized(program):
            resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))

    @staticmethod
    @functools.cache
    def sanitized(program):
        return b"__asan_init" in pathlib.Path(program).read_bytes()

    def brio(self, program, arguments, folder, can_be_stopped):
        """Exit code (negative: signal), standard error, processor time."""
        log = f"log_path={folder / 'report'}"  # child processes have another standard error
        environment = dict(os.environ, ASAN_OPTIONS=f"exitcode=99:allocator_may_return_null=1:{log}",
                           UBSAN_OPTIONS=f"print_stacktrace=1:halt_on_error=1:exitcode=99:{log}")
        with open(folder / "stderr.txt", "wb") as errors, open(folder / "stdout.txt", "wb") as output:
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            process = subprocess.Popen([program, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=output,
                                       stderr=errors, preexec_fn=lambda: self.limits(program), env=environment,
                                       start_new_session=True)
            ticks, told, wait, begin = os.sysconf("SC_CLK_TCK"), False, 0.002, time.monotonic()
            while process.poll() is None:
                time.sleep(wait)
                wait = min(2 * wait, 0.25)
                try:
                    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
                except (OSError, IndexError):
                    continue
                own = (int(fields[11]) + int(fields[12])) / ticks
                # The members of a study spend its time.
                if can_be_stopped and not told and (own > STOP_AFTER or time.monotonic() - begin > 2 * STOP_AFTER):
                    process.send_signal(signal.SIGTERM)
                    told = True
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        reports = "".join(path.read_text(errors="replace") for path in self.reports_of(folder))
        return process.returncode, (folder / "stderr.txt").read_text(errors="replace") + reports, seconds

    def reports_of(self, folder):
        """Reports of sanitizers, also of child processes; without those of faults inside the HDF5 library."""
        own = []
        for path in sorted(folder.glob("report.*")):
            text = path.read_text(errors="replace")
            if "ERROR:" not in text and "runtime error:" not in text:  # tells of an allocation that failed
                continue
            frames = re.findall(r"#\d+ 0x[0-9a-f]+ in (.*)", text.split("\n\n")[0])
            outside = [frame for frame in frames if "interceptor" not in frame and "sanitizer" not in frame]
            if outside and "libhdf5" in outside[0]:
                self.inside_hdf5 += 1
            else:
                own.append(path)
        return own

    @staticmethod
    def judge(arguments, code, errors, seconds, limit, is_deck):
        """What is wrong, or nothing; and the exit code, of a run that was told to end before it heeds signals too."""
        fault = None
        last = [line for line in errors.strip().split("\n") if line.strip()][-1:] or [""]
        if any(report in errors for report in REPORTS):
            fault = "report"
        elif code == -signal.SIGTERM and arguments[0] == "run":  # while the scene is built there is nothing to close
            code = 143
        elif code in (-signal.SIGXCPU, -signal.SIGKILL) or seconds > limit:
            fault = f"hang, {seconds:.0f} s"
        elif code < 0:
            fault = f"signal {-code}"
        elif code not in CODES:
            fault = f"exit code {code}"
        elif code == 2 and is_deck and not PLACE.match(errors.strip()) and not UNREADABLE.search(errors):
            fault = "refusal without a place"
        elif code in (2, 3, 4) and not last[0] and arguments[0] != "study":  # its table tells what failed
            fault = "ends without a message"
        return fault, code

    def try_one(self, name, arguments, folder, can_be_stopped, is_deck):
        code, errors, seconds = self.brio(self.program, arguments, folder, can_be_stopped)
        fault, code = self.judge(arguments, code, errors, seconds, self.limit_of(self.program), is_deck)
        if not fault and seconds > LIMIT:
            code, errors, seconds = self.brio(self.optimized, arguments, folder, can_be_stopped)
            print(f"{name} {' '.join(arguments)}: {seconds:.0f} s of the optimized program", flush=True)
            fault, code = self.judge(arguments, code, errors, seconds, LIMIT, is_deck)
        key = (name.split(":")[0], arguments[0], fault.split(",")[0] if fault else CODES[code])
        self.counts[key] = self.counts.get(key, 0) + 1
        if fault:
            self.failures += 1
            print(f"{name} {' '.join(arguments)}: {fault}: {' | '.join(errors.strip().split(chr(10))[:3])[:400]}", flush=True)
        if fault and self.keep:
            shutil.copytree(folder, self.keep / name.replace(":", "-"), dirs_exist_ok=True, symlinks=True)
        shutil.rmtree(folder, ignore_errors=True)

    def new_folder(self, name):
        folder = self.folder / name.replace(":", "-")
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        return folder

    def deck(self, number):
        name = f"deck:{number}"
        rng = random.Random(f"{self.seed} {name}")
        stem, text, end = rng.choice(self.decks)
        folder = self.new_folder(name)
        (folder / f"{stem}.yaml").write_bytes(mutated_deck(rng, text).encode("utf-8", "surrogatepass"))
        if rng.random() < 0.35:
            arguments = ["check", f"{stem}.yaml", "--coarse-run=0", "--threads", "1"]
        else:
            arguments = ["run", f"{stem}.yaml", "--quiet", "--threads", rng.choice(["1", "1", "1", "2"]), "--set",
                         f"time.end={end * 1e-3 if stem == 'small' else end * 1e-5:.3g}"]
        self.try_one(name, arguments, folder, arguments[0] == "run", True)

    def base(self, what):
        """A result, or a folder of a study, made once."""
        folder = self.folder / f"base-{what}"
        if not folder.exists():
            folder.mkdir()
            (folder / "small.yaml").write_text(SMALL_DECK)
            (folder / "small.study.yaml").write_text(STUDY)
            arguments = {"result": ["run", "small.yaml", "--quiet"], "study": ["study", "small.study.yaml", "--quiet"]}[what]
            code, errors, _ = self.brio(self.program, arguments, folder, False)
            if code != 0:
                sys.exit(f"the plain {what} ends with {code}: {errors}")
        return folder

    def damage_file(self, rng, folder, pattern="*"):
        files = sorted(file for file in folder.rglob(pattern) if file.is_file() and file.name not in ("stdout.txt", "stderr.txt"))
        file = rng.choice(files)
        kind = rng.randrange(12)
        if kind == 0:
            file.unlink()
        elif kind == 1:
            file.unlink()
            file.mkdir()
        elif kind == 2:
            file.write_bytes(rng.choice(files).read_bytes() if files else b"")
        elif kind == 3:
            file.write_bytes(b"")
        elif file.suffix in (".json", ".csv", ".xdmf2", ".yaml", ".txt") and kind < 9:
            file.write_text(mutate_text(rng, file.read_text(errors="replace")), errors="replace")
        else:
            file.write_bytes(mutate_bytes(rng, file.read_bytes()))
        return file

    def result(self, number):
        name = f"result:{number}"
        rng = random.Random(f"{self.seed} {name}")
        folder = self.new_folder(name)
        shutil.copytree(self.base("result") / "small.results", folder / "small.results")
        for _ in range(rng.choice([1, 1, 1, 2])):
            try:
                self.damage_file(rng, folder / "small.results", rng.choice(["*", "*.vtkhdf", "*.vtkhdf"]))
            except (IndexError, OSError):
                pass
        target = rng.choice(["small.results", "small.results", "small.results/small.vtkhdf"])
        self.try_one(name, rng.choice([["info"], ["info", "--verify"], ["report"]]) + [target], folder, False, False)

    def study(self, number):
        name = f"study:{number}"
        rng = random.Random(f"{self.seed} {name}")
        folder = self.new_folder(name)
        shutil.copytree(self.base("study"), folder, dirs_exist_ok=True)
        if rng.random() < 0.3:
            file = folder / "small.study.yaml"
            file.write_text(mutated_deck(rng, STUDY), errors="surrogateescape")
        else:
            for _ in range(rng.choice([1, 1, 2])):
                try:
                    self.damage_file(rng, folder, rng.choice(["*", "run.json", "*.vtkhdf", "*.summary.json", "*.yaml"]))
                except (IndexError, OSError):
                    pass
        self.try_one(name, ["study", "small.study.yaml", "--quiet", "--jobs", "1"], folder, True, True)

    def report(self):
        for (kind, command, end), count in sorted(self.counts.items()):
            print(f"{count:6d}  {kind:7s} {command:6s} {end}")
        print(f"{sum(self.counts.values())} mutants of seed {self.seed}, {self.failures} failures, "
              f"{self.inside_hdf5} faults inside HDF5 that ended the process that read")
        shutil.rmtree(self.folder, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--optimized", help="the same program without sanitizers")
    parser.add_argument("--decks", type=int, default=0)
    parser.add_argument("--results", type=int, default=0)
    parser.add_argument("--studies", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first mutant of each kind")
    parser.add_argument("--only", help="one mutant, such as deck:17")
    parser.add_argument("--keep", help="folder for the mutants that failed")
    options = parser.parse_args()
    campaign = Campaign(options.program, options.optimized, options.seed, options.keep)
    try:
        if options.only:
            kind, number = options.only.split(":")
            getattr(campaign, kind)(int(number))
        for kind, count in (("deck", options.decks), ("result", options.results), ("study", options.studies)):
            for number in range(options.first, options.first + count):
                getattr(campaign, kind)(number)
    finally:
        campaign.report()
    sys.exit(1 if campaign.failures else 0)


if __name__ == "__main__":
    main()
