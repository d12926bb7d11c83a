#!/usr/bin/python3
"""What points do in the contact substeps: a plot from the CSV of bench_point_motions.

Needs Debian's python3-matplotlib.
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

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post import RunError

# Okabe and Ito's colours, which the colour-blind can tell apart.
COLOURS = {"N = 1": "#333333", "supported": "#0072B2", "frozen": "#009E73", "ballistic": "#D55E00"}


@dataclass(frozen=True)
class Row:
    case: str
    points_per_cell: int
    motion: str
    substeps: int
    spring: float | None
    creep_m_s: float | None
    pull: float | None
    jitter: float | None

    @property
    def kind(self):
        return "N = 1" if self.substeps == 1 else self.motion


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("table", type=Path, metavar="FILE.csv", help="of bench_point_motions")
    parser.add_argument("--output", type=Path, default=Path("point_motions.png"), metavar="FILE.png", help="default: point_motions.png")
    return parser.parse_args()


def number(text):
    """None of a run that was stopped."""
    return float(text) if text else None


def read(path):
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = [Row(row["case"], int(row["points_per_cell"]), row["motion"], int(row["substeps"]),
                        *(number(row[name]) for name in ("spring", "creep_m_s", "pull", "jitter"))) for row in csv.DictReader(file)]
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RunError(f"{path}: no table of bench_point_motions ({error!r})") from error
    if not rows:
        raise RunError(f"{path}: no rows")
    return rows


def plot_bars(axis, rows, value, title):
    cases = list(dict.fromkeys((row.case, row.points_per_cell) for row in rows))
    for place, kind in enumerate(COLOURS):
        found = [(cases.index((row.case, row.points_per_cell)), value(row)) for row in rows if row.kind == kind and row.pull is not None]
        axis.barh([index + 0.2 * (place - 1.5) for index, _ in found], [size for _, size in found], height=0.18, color=COLOURS[kind], label=kind)
    axis.set_yticks(range(len(cases)), [f"{case.partition(' at ')[2]}\n{points} a cell" for case, points in cases])
    axis.invert_yaxis()
    axis.set_title(title, fontsize=13)


def plot_rattle(axis, rows):
    lines = defaultdict(list)
    for row in rows:
        if row.spring is not None:
            lines[row.kind].append((row.spring, row.jitter))
    for kind, points in lines.items():
        axis.plot(*zip(*points), marker="o", color=COLOURS[kind], label=kind)
    axis.set(xscale="log", yscale="log", xlabel=r"$k\,dt^2/m_p$")
    axis.set_title("at rest, 64 a cell:\nstandard deviation of the force over W", fontsize=13)


def figure_of(rows):
    plt.rcParams.update({"font.size": 12, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(1, 3, figsize=(16, 5.6), constrained_layout=True)
    chosen = {word: [row for row in rows if row.case.startswith(word)] for word in ("held", "drawn", "at rest")}
    plot_bars(axes[0], chosen["held"], lambda row: 1e3 * abs(row.creep_m_s), "pushed sideways:\ncreep  [mm/s]")
    axes[0].set_xscale("log")
    axes[0].axvline(0.2, color="#999999", linewidth=1)
    plot_bars(axes[1], chosen["drawn"], lambda row: row.pull, "drawn along:\ndrag over W (friction 0.3)")
    axes[1].axvline(0.3, color="#999999", linewidth=1)
    plot_rattle(axes[2], chosen["at rest"])
    for axis in axes:
        axis.grid(color="#cccccc", linewidth=0.6)
        axis.set_axisbelow(True)
    axes[2].legend(fontsize=11, edgecolor="none")
    return figure


def main():
    options = arguments()
    figure_of(read(options.table)).savefig(options.output, dpi=110)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"point_motions: {error}")
