#!/usr/bin/python3
"""Error against processor time, from a CSV of work_precision_runs.py: a plot with the Pareto front marked, and the front as a table.

Needs Debian's python3-numpy and python3-matplotlib.
"""

import argparse
import csv
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from tread_post import RunError

# Okabe and Ito's colours, which the colour-blind can tell apart; one a transfer.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#333333")
MARKERS = {1: "o", 8: "s", 27: "^", 64: "D"}
SMALLEST = 1e-8  # on a logarithmic axis


@dataclass(frozen=True)
class Outcome:
    case: str
    quantity: str
    spacing: float  # m
    points_per_cell: int
    transfer: str
    precision: str
    points: int
    steps: int
    cpu_s: float
    error: float
    reference: str


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("table", type=Path, metavar="FILE.csv", help="of work_precision_runs.py")
    parser.add_argument("--output", type=Path, default=Path("work_precision.png"), metavar="FILE.png",
                        help="default: work_precision.png")
    return parser.parse_args()


def read(path):
    types = Outcome.__annotations__
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = [Outcome(**{name: of_type(row[name]) for name, of_type in types.items()}) for row in csv.DictReader(file)]
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RunError(f"{path}: no table of work_precision_runs.py ({error!r})") from error
    if not rows:
        raise RunError(f"{path}: no rows")
    panels = defaultdict(list)
    for row in rows:
        panels[row.case, row.quantity].append(row)
    return panels


def pareto_front(outcomes):
    """Those that nothing else beats in both time and error, by time."""
    front, best = [], float("inf")
    for outcome in sorted(outcomes, key=lambda row: (row.cpu_s, row.error)):
        if outcome.error < best:
            front.append(outcome)
            best = outcome.error
    return front


def plot_panel(axis, title, outcomes, colours):
    for row in outcomes:
        filled = row.precision == "single"
        axis.scatter(row.cpu_s, max(row.error, SMALLEST), marker=MARKERS.get(row.points_per_cell, "x"), s=45,
                     edgecolors=colours[row.transfer], facecolors=colours[row.transfer] if filled else "none", zorder=2)
    front = pareto_front(outcomes)
    axis.step([row.cpu_s for row in front], [max(row.error, SMALLEST) for row in front], where="post", color="#999999",
              linewidth=1.5, zorder=1)
    axis.set(xscale="log", yscale="log", xlabel="processor time  [s]", ylabel=title[1])
    axis.set_title(f"{title[0]} ({outcomes[0].reference})", fontsize=11)
    axis.grid(color="#cccccc", linewidth=0.6)
    axis.set_axisbelow(True)


def figure_of(panels):
    plt.rcParams.update({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False})
    rows = (len(panels) + 1) // 2
    figure, axes = plt.subplots(rows, min(2, len(panels)), figsize=(12, 4.5 * rows), constrained_layout=True, squeeze=False)
    outcomes = [row for panel in panels.values() for row in panel]
    colours = dict(zip(sorted({row.transfer for row in outcomes}), COLOURS))
    for axis, (title, panel) in zip(axes.flat, panels.items()):
        plot_panel(axis, title, panel, colours)
    for axis in axes.flat[len(panels):]:
        axis.set_axis_off()
    handles = [plt.Line2D([], [], marker="o", linestyle="", color=colour, label=name) for name, colour in colours.items()]
    handles += [plt.Line2D([], [], marker=MARKERS.get(points, "x"), linestyle="", color="#777777", label=f"{points} a cell")
                for points in sorted({row.points_per_cell for row in outcomes})]
    handles.append(plt.Line2D([], [], marker="o", linestyle="", color="#777777", markerfacecolor="none", label="double"))
    handles.append(plt.Line2D([], [], color="#999999", label="Pareto front"))
    axes[0][0].legend(handles=handles, fontsize=9, framealpha=0.85, edgecolor="none")
    return figure


def print_fronts(panels):
    print(f"{'case':<10} {'spacing':>8} {'a cell':>6} {'transfer':<8} {'precision':<9} {'points':>8} {'steps':>7} {'cpu s':>9} "
          f"{'error':>10}  quantity")
    for panel in panels.values():
        for row in pareto_front(panel):
            print(f"{row.case:<10} {row.spacing:>8g} {row.points_per_cell:>6} {row.transfer:<8} {row.precision:<9} "
                  f"{row.points:>8} {row.steps:>7} {row.cpu_s:>9.3g} {row.error:>10.3g}  {row.quantity}")


def main():
    options = arguments()
    panels = read(options.table)
    print_fronts(panels)
    figure_of(panels).savefig(options.output, dpi=110)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"work_precision: {error}")
