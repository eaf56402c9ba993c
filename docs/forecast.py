#!/usr/bin/python3
"""Writes docs/forecast.md: the forecast of `brio check` for each shipped deck, and the measured run.

    docs/forecast.py [--program build/release/brio] [--jobs N] [--folder build/forecast]

One thread each. What was measured before with the same program is taken up.
"""
import argparse
import hashlib
import json
import os
import statistics
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUDGETS = {"default": [], "10 s": ["--coarse-run=10"]}
# Scenes on which no constant of the forecast was chosen.
OTHERS = {
    "can_buckling, 72 x 45": ("can_buckling.yaml", ["parts.can.mesh.cylinder.elements=[72, 45]"]),
    "pipe_cutting, 48 x 36 x 3, until 1.6 ms":
        ("pipe_cutting.yaml", ["parts.pipe.mesh.tube.elements=[48, 36, 3]", "time.end=1.6e-3"]),
    "taylor_bar, fully integrated": ("taylor_bar.yaml", ["parts.bar.element=hex8_full"]),
    "verification/tube_crush": ("verification/tube_crush.yaml", []),
    "verification/roll_up": ("verification/roll_up.yaml", []),
}
TOLERANCE = {"steps": 5, "time": 25}  # %


def scenes():
    shipped = {deck.stem: (deck.name, []) for deck in sorted((ROOT / "inputs").glob("*.yaml"))}
    return {**shipped, **OTHERS}


def settings(overrides):
    return [word for setting in overrides for word in ("--set", setting)]


def processor_time(command):
    """Runs it. Returns what it printed and its seconds of the processor."""
    with tempfile.TemporaryFile() as printed:
        process = subprocess.Popen(command, stdout=printed)
        _, status, usage = os.wait4(process.pid, 0)
        if status:
            raise SystemExit(f"{' '.join(map(str, command))} ended with {os.waitstatus_to_exitcode(status)}")
        printed.seek(0)
        return printed.read(), usage.ru_utime + usage.ru_stime


def measure(program, deck, overrides):
    deck = ROOT / "inputs" / deck
    measured = {}
    with tempfile.TemporaryDirectory() as folder:
        summary, seconds = processor_time([program, "run", deck, "--threads", "1", "--quiet", "--json", "--output", folder,
                                           *settings(overrides)])
    measured["run"] = {"steps": json.loads(summary)["steps"], "seconds": seconds}
    for budget, words in BUDGETS.items():
        report, seconds = processor_time([program, "check", deck, "--threads", "1", "--json", *words,
                                          *settings(overrides)])
        forecast = json.loads(report)["forecast"]
        measured[budget] = {"steps": forecast["steps"], "seconds": forecast["wall_seconds"], "spent": seconds,
                            "least": forecast["steps_least"], "most": forecast["steps_most"],
                            "exact": forecast["steps_exact"]}
    return measured


def off(predicted, measured, kind):
    error = 100 * (predicted / measured - 1)
    text = f"{error:+.0f} %" if abs(error) >= 0.5 else "0"
    return f"**{text}**" if abs(error) > TOLERANCE[kind] else text


def row(name, measured):
    run = measured["run"]
    cells = [name, f"{run['steps']:,}", f"{run['seconds']:.3g}"]
    for budget in BUDGETS:
        told = measured[budget]
        steps = "exact" if told["exact"] else off(told["steps"], run["steps"], "steps")
        cells += [f"{told['spent']:.2g}", steps, off(told["seconds"], run["seconds"], "time")]
    return "| " + " | ".join(cells) + " |"


def counts(all_measured, names, budget):
    errors = {kind: [abs(all_measured[n][budget][key] / all_measured[n]["run"][key] - 1) * 100 for n in names]
              for kind, key in (("steps", "steps"), ("time", "seconds"))}
    within = {kind: sum(e <= TOLERANCE[kind] for e in values) for kind, values in errors.items()}
    return (f"steps within {TOLERANCE['steps']} % in {within['steps']} of {len(names)} (median {statistics.median(errors['steps']):.1f} %, "
            f"at most {max(errors['steps']):.0f} %), time within {TOLERANCE['time']} % in {within['time']} "
            f"(median {statistics.median(errors['time']):.0f} %, at most {max(errors['time']):.0f} %)")


def page(all_measured):
    shipped = [name for name in all_measured if name not in OTHERS]
    head = ["| deck | steps | s | " + " | ".join(f"{b}: s | steps | time" for b in BUDGETS) + " |",
            "| --- | --- | --- |" + " --- | --- | --- |" * len(BUDGETS)]
    budgets = "\n".join(f"- {b}, shipped decks: {counts(all_measured, shipped, b)}" for b in BUDGETS)
    return f"""# The forecast of `brio check`

<!-- Written by docs/forecast.py; do not edit. -->

Of each deck: time steps and processor seconds of the run on one thread, output included; and the processor seconds of `brio check`,
with its default budget of coarse runs (90 s, but at most 40 % of the predicted run; about 1 s before that) and with `--coarse-run=10`. Steps: predicted over
measured number, time likewise; **bold** is beyond {TOLERANCE['steps']} % of steps or {TOLERANCE['time']} % of time. Exact: `check` reached the end time itself.

{budgets}

The method is described in src/forecast/forecast.hpp. A coarser mesh and the first steps do not show where the finer mesh folds, fractures
or is crushed in another way; a larger budget does.

{chr(10).join(head + [row(n, all_measured[n]) for n in shipped])}

Scenes on which no constant of the forecast was chosen:

{chr(10).join(head + [row(n, all_measured[n]) for n in OTHERS])}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/brio")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--folder", type=Path, default=ROOT / "build/forecast")
    chosen = parser.parse_args()
    chosen.folder.mkdir(parents=True, exist_ok=True)
    version = hashlib.sha256(chosen.program.read_bytes()).hexdigest()[:16]

    def known_or_measured(scene):
        name, (deck, overrides) = scene
        file = chosen.folder / f"{version}.{name.replace('/', '_').replace(' ', '_')}.json"
        if not file.exists():
            file.write_text(json.dumps(measure(chosen.program, deck, overrides)))
        print(name, flush=True)
        return name, json.loads(file.read_text())

    with ThreadPoolExecutor(chosen.jobs) as pool:
        all_measured = dict(pool.map(known_or_measured, scenes().items()))
    (ROOT / "docs/forecast.md").write_text(page(all_measured))


if __name__ == "__main__":
    main()
