"""Curves of the histories of one or more runs, drawn by matplotlib.

    python3 docs/plot_history.py LABEL=RESULT.history.csv ... --column COLUMN --output PLOT.svg

  --column NAME    of the history, such as external, internal, plate.velocity_z
  --label TEXT     of the axis of the column; default its name
  --against NAME   column of the other axis, such as ram.displacement_z; default the time
  --scale FACTOR   multiply the column, such as -1
  --time FACTOR UNIT  multiply times; default 1000 ms
"""
import argparse
import csv

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "brio"  # the same file for the same curves
import matplotlib.pyplot as plt  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="LABEL=HISTORY.csv")
    parser.add_argument("--column", required=True)
    parser.add_argument("--label")
    parser.add_argument("--against")
    parser.add_argument("--scale", type=float, default=1)
    parser.add_argument("--time", nargs=2, default=["1000", "ms"], metavar=("FACTOR", "UNIT"))
    parser.add_argument("--output", required=True)
    return parser.parse_args()


def column(path, name):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows or name not in rows[0]:
        known = ", ".join(rows[0]) if rows else "none: the file has no rows"
        raise SystemExit(f"{path}: no column '{name}'; there are {known}")
    return [float(row["time"]) for row in rows], [float(row[name]) for row in rows]


def main():
    options = arguments()
    factor, unit = float(options.time[0]), options.time[1]
    figure, axes = plt.subplots(figsize=(6, 3.6))
    for run in options.runs:
        label, _, path = run.partition("=")
        times, values = column(path, options.column)
        along = column(path, options.against)[1] if options.against else [factor * t for t in times]
        axes.plot(along, [options.scale * value for value in values], label=label, linewidth=1.2)
    axes.set_xlabel(options.against or f"time, {unit}")
    axes.set_ylabel(options.label or options.column)
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(options.output, metadata={"Date": None})


if __name__ == "__main__":
    main()
