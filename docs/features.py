#!/usr/bin/env python3
"""Writes docs/features.md: what each feature costs in scenes that name it, and that it costs nothing in the others.

Twelve scenes are run, shortened, twice: with the program as it is, for memory and time, and with one that counts which
lines of the sources run (built in build/coverage, which takes some minutes).

Usage: docs/features.py [--program build/release/brio] [--coverage BUILD-FOLDER]
"""

import argparse
import gzip
import json
import os
import shutil
import subprocess
import tempfile
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# Deck, end time of the shortened run, further overrides.
SCENES = {
    "bars": ("bar_impact.yaml", 3e-3, []),
    "bars, merged": ("bar_impact.yaml", 3e-3, ["connections=[{merge: [left, right], tolerance: 1e-6}]"]),
    "bars, tied": ("bar_impact.yaml", 3e-3, ["connections=[{tie: [left, right], tolerance: 1e-3}]",
                                            "initial_conditions=[{part: left, velocity: [10, 0, 0]}, "
                                            "{part: right, velocity: [10, 0, 0]}]"]),
    "stack": ("resting_stack.yaml", 0.05, []),
    "Taylor bar": ("taylor_bar.yaml", 2e-5, []),
    "panel": ("panel_impulse.yaml", 1e-3, []),
    "can, mass scaled": ("can_buckling.yaml", 3e-4, ["time.mass_scaling.step=9e-7"]),
    "plate, ball": ("plate_perforation.yaml", 2e-5, []),
    "pipe": ("pipe_cutting.yaml", 1e-4, []),
    "bricks": ("brick_stack.yaml", 1e-3, []),
    "net": ("net.yaml", 3e-3, []),
    "rings": ("rubber_rings.yaml", 1e-3, []),
}

# Feature: sources that serve nothing else, stages of the time by stage, features that `check` tells the memory of.
FEATURES = {
    "elements of all kinds": ([], ["elements"], []),
    "solids": (["elements/solid/hex8*.hpp", "elements/solid/hourglass.hpp", "elements/solid/mean_gradient.hpp"], [],
               ["hex8", "hex8_full"]),
    "shells": (["elements/shell/*.hpp"], [], ["shell4", "rotations of nodes"]),
    "beams": (["elements/beam/*"], [], ["beam2"]),
    "particles": (["elements/particle/*", "src/sweep/particles.cpp", "io/mesh/particle_mesh.cpp"], [], ["particle"]),
    "rigid parts": (["src/motion/rigid.cpp", "src/build/build_rigid.cpp", "src/deck/mass_properties.cpp"], ["rigid"],
                    ["rigid bodies"]),
    "contact": (["contact/detection/*.cpp", "contact/enforcement/*.cpp", "contact/resolution.cpp", "contact/scene.cpp",
                 "contact/step_totals.cpp", "contact/surface/surface.cpp", "contact/start/enclosed.cpp",
                 "contact/geometry/velocity_check.cpp", "contact/geometry/edge_check.cpp",
                 "contact/geometry/closest_segments.cpp"],
                ["contact", "contact_search"], ["contact"]),
    "audit": (["contact/audit/*.cpp"], ["audit"], []),
    "failure and deletion": (["src/sweep/erosion.cpp", "contact/erosion.cpp", "contact/surface/surface_topology.cpp",
                              "contact/surface/delete_elements.cpp", "contact/surface/body_pieces.cpp",
                              "materials/failing.hpp", "elements/lose.hpp"],
                             ["erosion"], ["deletion"]),
    "ties": (["contact/ties/*.cpp", "src/build/build_ties.cpp", "src/motion/tied_wall.cpp", "src/sweep/release_ties.cpp"],
             ["ties"], ["ties"]),
    "merged nodes": (["src/build/merge.cpp"], [], ["merged nodes"]),
    "supports, rigid walls": (["src/motion/constraints.cpp", "src/motion/rigid_wall.cpp"], ["constraints"],
                              ["prescribed motion", "rigid wall"]),
    "loads": (["src/motion/loads.cpp"], ["loads"], ["loads"]),
    "damping, relaxation": (["src/motion/damping.cpp", "src/step/relax.cpp"], [], ["damping"]),
    "springs": (["src/motion/springs.cpp"], [], ["springs"]),
    "expressions": (["src/deck/expression.cpp"], [], []),
    "tabulated plasticity": (["materials/tabulated/*"], [], []),
    "mass scaling": (["src/sweep/mass_scaling.cpp", "elements/scale_mass.hpp"], [], ["mass scaling"]),
    "local coordinate systems": (["src/deck/coordinate_system.cpp", "src/motion/skew_supports.cpp"], [], []),
    "initial state": (["src/initial/*.cpp", "io/run/initial_state.cpp", "io/run/earlier_result.cpp",
                       "elements/element_state.cpp"], [], []),
    "contact fields, strain": (["src/fields/contact_fields.cpp", "src/fields/strain.cpp"], [], []),
}


def command(program, verb, scene, *more):
    deck, end, overrides = SCENES[scene]
    settings = [f"time.end={end:g}", *overrides]
    words = [str(program), verb, str(ROOT / "inputs" / deck), "--threads", "1", *more]
    return words + [word for setting in settings for word in ("--set", setting)]


def memory_and_time(program, scene):
    checked = json.loads(subprocess.run(command(program, "check", scene, "--json", "--coarse-run=0"), check=True,
                                        capture_output=True).stdout)
    with tempfile.TemporaryDirectory() as folder:
        ended = json.loads(subprocess.run(command(program, "run", scene, "--quiet", "--json", "--output", folder),
                                          check=True, capture_output=True).stdout)
    return {entry["name"]: entry["memory_bytes"] for entry in checked["built"]}, ended["wall_s"]["by_stage"]


def lines_run(build, scene):
    """Of each source, [lines that ran, lines there are], over all objects that hold some of it."""
    seen = {}
    with tempfile.TemporaryDirectory() as counts, tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, GCOV_PREFIX=counts)
        subprocess.run(command(build / "brio", "run", scene, "--quiet", "--output", folder), check=True,
                       capture_output=True, env=environment)
        for data in Path(counts).rglob("*.gcda"):
            notes = Path("/") / data.relative_to(counts).with_suffix(".gcno")
            shutil.copy(notes, data.with_suffix(".gcno"))
            subprocess.run(["gcov", "--json-format", data.name], cwd=data.parent, capture_output=True, check=True)
            for report in data.parent.glob("*.gcov.json.gz"):
                for source in json.loads(gzip.open(report).read())["files"]:
                    path = os.path.relpath(os.path.join(ROOT, source["file"]), ROOT)
                    lines = seen.setdefault(path, {})
                    for line in source["lines"]:
                        # What makes tables before main() runs is there whatever the scene is.
                        name = line.get("function_name", "")
                        if name.startswith("_GLOBAL__sub") or name.startswith("_Z41__static"):
                            continue
                        lines[line["line_number"]] = lines.get(line["line_number"], 0) + line["count"]
                report.unlink()
    return {path: (sum(1 for n in lines.values() if n > 0), len(lines)) for path, lines in seen.items()}


def lines_of(feature, run):
    ran, there = 0, 0
    for path, (some, all_of_them) in run.items():
        if any(fnmatch(path, pattern) for pattern in FEATURES[feature][0]):
            ran, there = ran + some, there + all_of_them
    return ran, there


def table(title, column, cell):
    text = f"\n## {title}\n\n| | " + " | ".join(SCENES) + " |\n| --- |" + " --- |" * len(SCENES) + "\n"
    for feature in (feature for feature in FEATURES if FEATURES[feature][column]):
        text += f"| {feature} | " + " | ".join(cell(feature, scene) for scene in SCENES) + " |\n"
    return text


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--program", type=Path, default=ROOT / "build/release/brio")
    arguments.add_argument("--coverage", type=Path, default=ROOT / "build/coverage")
    chosen = arguments.parse_args()
    if not (chosen.coverage / "CMakeCache.txt").exists():
        subprocess.run(["cmake", "-S", ROOT, "-B", chosen.coverage, "-G", "Ninja", "-DBRIO_TESTS=OFF", "-DBRIO_BENCH=OFF",
                        "-DCMAKE_CXX_FLAGS=--coverage -DBRIO_KERNELS_BY_CALL", "-DCMAKE_CXX_FLAGS_RELEASE=-O1"], check=True)
    subprocess.run(["cmake", "--build", chosen.coverage, "--target", "brio"], check=True)

    memory, stages, lines = {}, {}, {}
    for scene in SCENES:
        memory[scene], stages[scene] = memory_and_time(chosen.program, scene)
        lines[scene] = lines_run(chosen.coverage, scene)
        print(scene, flush=True)

    def kilobytes(feature, scene):
        held = [memory[scene][name] for name in FEATURES[feature][2] if name in memory[scene]]
        return f"{sum(held) / 1e3:.4g}" if held else "-"

    def share(feature, scene):
        seconds = sum(stages[scene].get(stage, 0) for stage in FEATURES[feature][1])
        return f"{100 * seconds / sum(stages[scene].values()):.2g} %" if seconds > 0 else "-"

    def ran(feature, scene):
        some, all_of_them = lines_of(feature, lines[scene])
        return f"{some} of {all_of_them}" if some else "-"

    begin = (ROOT / "docs/features_begin.md").read_text()
    (ROOT / "docs/features.md").write_text(
        begin + table("Memory, kB", 2, kilobytes) + table("Share of the time", 1, share) +
        table("Lines that run", 0, ran))


if __name__ == "__main__":
    main()
