#!/usr/bin/env python3
"""Throws bodies of all kinds at each other and lets the audit look for what crosses.

    collide.py BRIO [--scenes N] [--first K] [--seed S] [--keep FOLDER] [--twice]

A scene has two to six bodies of bricks, shells, beams or particles, of one to some hundreds of elements, elastic,
plastic, brittle (bricks that are deleted) or rigid, turned at random, that meet in one place at 20 to 1500 m/s. The
same seed and number make the same scene. What is a failure: a crossing at any dump, a body swallowed by another, a
step that ended unresolved, an exit code that is neither 0 nor 3, 60 s without an end. Scenes that are refused because
bodies overlap as drawn, or all are rigid, are counted apart, as are distances below the touching distance and impact
zones. With --twice every scene runs again with a wider search margin: its history must be the same, byte for byte.
Prints a line for each failure and a table at the end; exit code 1 if there were failures.
"""

import argparse
import json
import math
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

import yaml

DUMPS = 60
LONGEST = 60  # s
MATERIALS = {
    "steel": {"model": "elastic_plastic", "density": 7800, "youngs_modulus": 2e11, "poissons_ratio": 0.3,
              "yield_stress": 3e8, "hardening_modulus": 1e9},
    "soft": {"model": "elastic", "density": 1200, "youngs_modulus": 1e9, "poissons_ratio": 0.3},
    "brittle": {"model": "power_law_hardening", "density": 2700, "youngs_modulus": 7e10, "poissons_ratio": 0.3,
                "yield_stress": 1e8, "hardening_constant": 2e8, "hardening_exponent": 0.4},
}
REFUSED = re.compile(r"contact: part .* (overlaps|lies in|goes through) part|all parts are rigid|begins behind the rigid wall")


def box(rng):
    mesh = {"size": [rng.choice([0.1, 0.1, 0.05, 0.2, 0.01]) for _ in range(3)],
            "elements": [rng.choice([1, 2, 3, 5]) for _ in range(3)]}
    return {"box": mesh}, rng.choice(["hex8", "hex8", "hex8_full", "rigid"])


def plate(rng):
    mesh = {"size": [rng.choice([0.2, 0.3]), rng.choice([0.2, 0.1])],
            "elements": [rng.choice([4, 8, 12]), rng.choice([3, 8])]}
    return {"plate": mesh}, {"type": "shell4", "thickness": rng.choice([1e-3, 3e-3, 0.01])}


def sphere(rng):
    return {"sphere": {"radius": rng.choice([0.04, 0.07]), "elements": rng.choice([2, 4])}}, "hex8"


def cylinder(rng):
    mesh = {"radius": rng.choice([0.03, 0.08]), "height": rng.choice([0.1, 0.2]),
            "elements": [rng.choice([6, 12, 20]), rng.choice([3, 8])]}
    return {"cylinder": mesh}, {"type": "shell4", "thickness": rng.choice([1e-3, 3e-3])}


def tube(rng):
    mesh = {"inner_radius": 0.03, "outer_radius": rng.choice([0.035, 0.05]), "height": rng.choice([0.1, 0.2]),
            "elements": [rng.choice([6, 12]), rng.choice([3, 8]), rng.choice([1, 2])]}
    return {"tube": mesh}, "hex8"


def line(rng):
    end = [0.15 * rng.uniform(-1, 1) for _ in range(3)]
    mesh = {"start": [-x for x in end], "end": end, "elements": rng.choice([3, 8, 15])}
    return {"line": mesh}, {"type": "beam2", "section": {"circle": {"radius": rng.choice([2e-3, 5e-3])}}}


def grains(_):
    return {"particles": {"box": {"size": [0.05, 0.05, 0.05], "spacing": 0.01}}}, "particle"


def part(rng, place):
    mesh, element = rng.choice([box, box, plate, sphere, cylinder, line, grains, tube])(rng)
    material = rng.choice(list(MATERIALS))
    if element == "particle":
        material = "soft"
    made = {"mesh": mesh, "element": element, "material": material,
            "placement": {"rotate": {"axis": [rng.gauss(0, 1) for _ in range(3)], "degrees": rng.uniform(0, 360)},
                          "translate": place}}
    if material == "brittle" and element != "rigid":
        made["deletion"] = {"plastic_strain": 0.3}
    return made


def scene(seed, number):
    rng = random.Random(f"{seed} {number}")
    bodies = rng.choice([2, 2, 3, 4, 6])
    speed = 10 ** rng.uniform(1.3, 3.2)
    ring = 0.22 if bodies < 4 else 0.35
    parts, motions = {}, []
    for i in range(bodies):
        angle = 2 * math.pi * i / bodies + rng.uniform(-0.2, 0.2)
        place = [ring * math.cos(angle), ring * math.sin(angle), rng.uniform(-0.05, 0.05)]
        parts[f"body{i}"] = part(rng, place)
        way = [rng.uniform(-0.04, 0.04) - x for x in place]
        share = speed * rng.uniform(0.3, 1) / math.hypot(*way)
        motions.append({"part": f"body{i}", "velocity": [share * x for x in way]})
    end = 0.9 / speed
    return {"title": f"Collision {number} of seed {seed}", "materials": MATERIALS, "parts": parts,
            "initial_conditions": motions,
            "contact": {"surfaces": "all", "friction": rng.choice([0, 0.2, 0.5]), "audit": True},
            "time": {"end": end}, "output": {"fields": {"every": end / DUMPS}}}


def look_at(program, deck, results):
    """What went wrong, '' if nothing did; the summary's section of contact."""
    try:
        run = subprocess.run([program, "run", str(deck), "--quiet", "--threads", "1", "--output", str(results)],
                             capture_output=True, text=True, errors="replace", timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return "has no end", {}
    last = run.stderr.strip().split("\n")[-1]
    summaries = list(results.glob("*.summary.json"))
    if run.returncode == 2 and REFUSED.search(last):
        return "", {"refused": 1}
    if run.returncode not in (0, 3) or not summaries:
        return f"exit code {run.returncode}: {last}", {}
    contact = json.loads(summaries[0].read_text())["contact"]
    wrong = [f"{contact[key]} {key}" for key in ("crossed_dumps", "swallowed", "unresolved") if contact[key]]
    if wrong and "deepest_crossing" in contact:
        wrong.append(f"deepest crossing {contact['deepest_crossing']}")
    return ", ".join(wrong), contact


def look_twice(program, made, deck, first):
    """What went wrong with a wider search margin."""
    made["contact"]["reach_buffer"] = 0.35
    deck.write_text(yaml.safe_dump(made, sort_keys=False))
    second = deck.parent / "wider"
    fault, _ = look_at(program, deck, second)
    return fault or ("" if history(first) == history(second) else "the history depends on the search margin")


def history(results):
    return [path.read_bytes() for path in results.glob("*.history.csv")]


def main(description, scene):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--scenes", type=int, default=50)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", help="folder for the decks that failed")
    parser.add_argument("--twice", action="store_true", help="compare runs with two search margins")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    failures, audited, too_close, zones, refused = 0, 0, 0, 0, 0
    for number in range(options.first, options.first + options.scenes):
        with tempfile.TemporaryDirectory(prefix="brio-fuzz-") as name:
            folder = pathlib.Path(name)
            deck = folder / f"scene{number}.yaml"
            made = scene(options.seed, number)
            deck.write_text(yaml.safe_dump(made, sort_keys=False))
            fault, contact = look_at(program, deck, folder / "results")
            if options.twice and not fault and not contact.get("refused"):
                fault = look_twice(program, made, deck, folder / "results")
            if fault:
                failures += 1
                print(f"scene {number}: {fault}", flush=True)
                if options.keep:
                    pathlib.Path(options.keep).mkdir(parents=True, exist_ok=True)
                    shutil.copy(deck, options.keep)
        audited += contact.get("audited_dumps", 0)
        too_close += contact.get("too_close", 0)
        zones += contact.get("last_resort_uses", 0)
        refused += contact.get("refused", 0)
    print(f"{options.scenes} scenes of seed {options.seed}, {failures} failures; {audited} dumps audited, "
          f"{too_close} distances too close, {zones} impact zones, {refused} scenes refused")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main(__doc__, scene)
