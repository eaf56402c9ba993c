#!/usr/bin/python3
"""Writes docs/verification.md: runs the studies that inputs/verification/cases.yaml names, and tells what each case shows.

    docs/verification.py [--program build/release/brio] [--jobs N] [--folder build/verification]

Studies that were run before with the same program and decks are taken up as they are. Needs python3-yaml.
"""
import argparse
import csv
import math
import pathlib
import re
import subprocess
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES = ROOT / "inputs/verification"
SECOND_ORDER, CLOSE = 1.8, 1e-3  # order from here on, error up to here
COLUMNS = ["case", "quantity", "reference", "fast", "balanced", "accurate", "tolerance", "within", "order"]
RUNS = ["preset.fast", "default", "preset.accurate"]  # the default preset is `balanced`


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/brio")
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build/verification")
    return parser.parse_args()


def read_yaml(path):
    """As brio reads it: 1e6 is a number."""
    loader = type("Loader", (yaml.SafeLoader,), {})
    loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"^[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+$"),
                                 list("-+.0123456789"))
    return yaml.load(path.read_text(), loader)


def run_study(name, options):
    """Its table: runs by name, with their figures by name."""
    folder = options.folder / name
    command = [options.program, "study", CASES / f"{name}.study.yaml", "--output", folder, "--quiet"]
    if options.jobs:
        command += ["--jobs", str(options.jobs)]
    print(name, file=sys.stderr, flush=True)
    end = subprocess.run(command, check=False, stdout=subprocess.DEVNULL)
    if end.returncode not in (0, 3):  # 3: a run failed, which its row says
        sys.exit(f"{name}: brio study ended with {end.returncode}")
    with open(folder / f"{name}.study.csv", newline="") as table:
        return {row["run"]: row for row in csv.DictReader(table)}


def number(text):
    value = float(text)
    return f"{value + 0.0:.5g}" if math.isfinite(value) else "-"


def share(value):
    """An error or a tolerance."""
    if not math.isfinite(value):
        return "-"
    if value == 0:
        return "0"
    return f"{value:.1e}" if value < 1e-5 else f"{100 * value:.2g} %"


def orders_of_differences(values):
    """From the differences of neighbouring meshes, which know of no reference; nothing where they change sign."""
    steps = [b - a for a, b in zip(values, values[1:])]
    ratios = [a / b if b else 0 for a, b in zip(steps, steps[1:])]
    return [math.log2(ratio) for ratio in ratios] if ratios and min(ratios) > 0 else []


def orders(study, table, quantity):
    """Of knobs that refine the mesh, from each setting to the next; those of other knobs than the study's carry their name."""
    if "refined" not in study:
        return ""
    told = []
    meshes = study["knobs"][study["refined"]]
    for knob, settings in study["knobs"].items():
        if len(settings) != len(meshes) or set(settings) != set(meshes):
            continue
        errors = [float(table[f"{knob}.{setting}"][quantity + "_error"]) for setting in settings]
        if min(errors) < 1e-9:  # rounding
            continue
        found = [math.log2(a / b) for a, b in zip(errors, errors[1:])]
        text = ", ".join(f"{order:.1f}" for order in found)
        between = orders_of_differences([float(table[f"{knob}.{setting}"][quantity]) for setting in settings])
        if errors[-1] < CLOSE and found[-1] < SECOND_ORDER and between and min(between) >= SECOND_ORDER:
            text += " (differences: " + ", ".join(f"{order:.1f}" for order in between) + ")"
        told.append(text if knob == study["refined"] else f"{knob.replace('_', ' ')}: {text}")
    return "; ".join(told)


def reference_of(quantity):
    source = quantity.get("source", "")
    return f"{number(quantity['reference'])}" + (f" ({source})" if source else "")


def cells_of(study, table, quantity, tolerance):
    """A cell a preset, and the presets that are beyond the tolerance. A study that varies something else shows the run
    that is furthest off, as of the preset whose precision it has."""
    told = lambda run: f"{number(table[run][quantity])} ({share(error_of(run))})"
    error_of = lambda run: float(table[run][quantity + "_error"])
    beyond = lambda run: tolerance is not None and not error_of(run) <= tolerance
    if "preset" in study["knobs"]:
        return [told(run) for run in RUNS], ["balanced" if run == "default" else run.split(".")[1] for run in RUNS if beyond(run)]
    worst = max(table, key=error_of)
    preset = "fast" if study.get("set", {}).get("numerics.precision") == "float" else "balanced"
    cells = [told(worst) if preset == column else "-" for column in ("fast", "balanced", "accurate")]
    return cells, [preset] if beyond(worst) else []


def rows_of_study(name, options):
    """Rows of the table, and those of them that are beyond their tolerance."""
    study = read_yaml(CASES / f"{name}.study.yaml")
    table = run_study(name, options)
    rows, beyond = [], []
    for quantity, said in study["quantities"].items():
        tolerance = said.get("tolerance")
        cells, outside = cells_of(study, table, quantity, tolerance)
        verdict = "" if tolerance is None else "yes" if not outside else "**not " + ", ".join(outside) + "**"
        told = quantity.replace("_", " ").replace(" percent", " %")
        first = f"[{study['title']}](../inputs/verification/{name}.study.yaml)" if not rows else ""
        rows.append([first, told, reference_of(said), *cells, "" if tolerance is None else share(tolerance), verdict,
                     orders(study, table, quantity)])
        if outside:
            beyond.append(told)
    seconds = sum(float(run["processor_s"]) for run in table.values())
    return rows, (study["title"], beyond, study.get("advice", "").strip()), seconds


def row_of_test(row):
    suite, test = row["test"].split(".")
    source = re.compile(rf"TEST\w*\({suite},\s*{test}\b")
    if not any(source.search(file.read_text()) for file in (ROOT / "tests").rglob("*.cpp")):
        sys.exit(f"inputs/verification/cases.yaml: there is no test {row['test']}")
    return [f"{row['case']}: {row['what']}", f"`{row['program']} --gtest_filter='*{suite}*{test}*'`", row["holds"]]


def table_of(columns, rows):
    lines = [columns, ["---"] * len(columns), *rows]
    return "\n".join("| " + " | ".join(str(cell).replace("|", "\\|") for cell in line) + " |" for line in lines) + "\n"


def told_once(causes):
    """A line for each cause, with all cases that share it."""
    cases = {}
    for case, beyond, cause in causes:
        cases.setdefault(cause or "cause not known", []).append(f"{case} ({', '.join(beyond)})")
    return "".join(f"- {'; '.join(sharing)}. {cause}\n" for cause, sharing in cases.items())


def section(title, rows, options):
    figures, tests, causes, seconds = [], [], [], 0.0
    for row in rows:
        if "study" not in row:
            tests.append(row_of_test(row))
            continue
        lines, verdict, spent = rows_of_study(row["study"], options)
        figures += lines
        seconds += spent
        if verdict[1]:
            causes.append(verdict)
    text = f"\n## {title}\n\n" + table_of(COLUMNS, figures)
    if causes:
        text += "\nNot within their tolerance:\n\n" + told_once(causes)
    if tests:
        text += "\nHeld by tests, because no deck says it or no result shows it:\n\n"
        text += table_of(["case", "test", "what it holds"], tests)
    return text, seconds


def main():
    options = arguments()
    options.folder.mkdir(parents=True, exist_ok=True)
    text, seconds = "", 0.0
    for entry in read_yaml(CASES / "cases.yaml"):
        part, spent = section(entry["title"], entry["rows"], options)
        text += part
        seconds += spent
    head = (CASES / "begin.md").read_text()
    (ROOT / "docs/verification.md").write_text(f"{head}\nAll studies: {seconds:.0f} processor seconds.\n{text}")


if __name__ == "__main__":
    main()
