#!/usr/bin/python3
"""Largest force of a dropped wheel against the substeps a step, and its error against run time: a plot from the CSV of substep_runs.py.

Needs Debian's python3-matplotlib.
"""

import argparse
import csv
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post import RunError

# Okabe and Ito's colours, which the colour-blind can tell apart.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
MARKERS = ("o", "s", "^", "D")


@dataclass(frozen=True)
class Row:
    reading: str
    substeps: str  # a number, or "auto"
    dt_s: float
    substep_s: float
    young_Pa: float
    peak_N: float
    rest_over_weight: float
    cpu_s: float

    @property
    def substeps_a_step(self):
        return self.dt_s / self.substep_s

    @property
    def line(self):
        return f"{self.reading}, {self.young_Pa:.0e} Pa"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("runs", type=Path, metavar="FILE.csv", help="of substep_runs.py")
    parser.add_argument("--output", type=Path, default=Path("substeps.png"), metavar="FILE.png", help="default: substeps.png")
    return parser.parse_args()


def read(path):
    """Rows of the runs that ended, and (line, substeps) of those that were stopped."""
    types = Row.__annotations__
    ended, stopped = [], []
    try:
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["peak_N"]:
                    ended.append(Row(**{name: of_type(row[name]) for name, of_type in types.items()}))
                else:
                    stopped.append((f"{row['reading']}, {float(row['young_Pa']):.0e} Pa", float(row["substeps"])))
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RunError(f"{path}: no table of substep_runs.py ({error!r})") from error
    if not ended:
        raise RunError(f"{path}: no run has ended")
    return ended, stopped


def reference_of(rows):
    """The run with the smallest substep and step of a line: its force is what the others are compared with."""
    return min(rows, key=lambda row: (row.substep_s, row.dt_s))


def plot_line(peaks, errors, rows, reference, colour, marker):
    fixed = sorted((row for row in rows if row.substeps != "auto"), key=lambda row: row.substeps_a_step)
    chosen = [row for row in rows if row.substeps == "auto"]
    if fixed:
        first = fixed[0].peak_N
        peaks.plot([row.substeps_a_step for row in fixed], [row.peak_N / first for row in fixed], marker=marker, color=colour)
        peaks.plot([row.substeps_a_step for row in chosen], [row.peak_N / first for row in chosen], marker="*", markersize=15,
                   linestyle="", color=colour)
    for row in fixed + chosen:
        if row == reference:
            continue
        auto = row.substeps == "auto"
        off = abs(row.peak_N / reference.peak_N - 1)
        errors.plot(row.cpu_s, max(off, 1e-5), marker="*" if auto else marker, markersize=15 if auto else 6, linestyle="", color=colour)
        errors.annotate(row.substeps, (row.cpu_s, max(off, 1e-5)), xytext=(5, 4), textcoords="offset points", fontsize=8)


def figure_of(ended, stopped):
    plt.rcParams.update({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False})
    figure, (peaks, errors) = plt.subplots(1, 2, figsize=(14, 5), constrained_layout=True)
    lines = sorted({row.line for row in ended} | {line for line, _ in stopped})
    for number, line in enumerate(lines):
        colour, marker = COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)]
        rows = [row for row in ended if row.line == line]
        if rows:
            plot_line(peaks, errors, rows, reference_of(rows), colour, marker)
        at = [substeps for stopped_line, substeps in stopped if stopped_line == line]
        peaks.plot(at, [1] * len(at), marker="x", markersize=10, linestyle="", color=colour)
        peaks.plot([], [], color=colour, marker=marker, label=line)
    peaks.plot([], [], color="#555555", marker="*", markersize=12, linestyle="", label='substeps = "auto"')
    peaks.plot([], [], color="#555555", marker="x", linestyle="", label="stopped as unstable")
    peaks.legend(fontsize=9, edgecolor="none")
    peaks.set(xscale="log", xlabel="substeps a step", title="largest force over that of one substep a step")
    errors.set(xscale="log", yscale="log", xlabel="processor time  [s]", title="error of the largest force, against the finest of its kind")
    return figure


def main():
    options = arguments()
    ended, stopped = read(options.runs)
    figure_of(ended, stopped).savefig(options.output, dpi=130)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"substeps: {error}")
