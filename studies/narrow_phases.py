#!/usr/bin/python3
"""Error against run time of the narrow phases: a plot from the CSV of bench_narrow_phases and, if there is one, that of narrow_phase_piles.py.

Needs Debian's python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogLocator

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post import RunError
from tread_post.rows import read_rows
from tread_post.style import figure_grid, finish, legend_below, write

# Okabe and Ito's colours, which the colour-blind can tell apart.
COLOURS = {("sdf", 32): "#0072B2", ("sdf", 64): "#009E73", ("sdf", 128): "#E69F00", "rays": "#D55E00"}
MARKERS = {42: "o", 162: "s", 642: "^", 2562: "D"}


@dataclass(frozen=True)
class Impact:
    narrow_phase: str
    nodes: int
    sdf_cells: int
    cpu_ms: float
    energy_median: float
    energy_worst: float
    force_off: float


@dataclass(frozen=True)
class Pile:
    narrow_phase: str
    nodes: int
    sdf_cells: int
    height_m: float
    wall_s: float


@dataclass(frozen=True)
class Dot:
    narrow_phase: str
    nodes: int
    sdf_cells: int
    time: float
    error: float
    low: float
    high: float


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("impacts", type=Path, metavar="FILE.csv", help="of bench_narrow_phases")
    parser.add_argument("--piles", type=Path, metavar="FILE.csv", help="of narrow_phase_piles.py")
    parser.add_argument("--output", type=Path, default=Path("narrow_phases.png"), metavar="FILE.png",
                        help="default: narrow_phases.png")
    return parser.parse_args()


def heights_off(rows):
    """Returns how far the mean of each variant over the seeds is from that of the finest distance field; the bars are the standard error
    of that difference."""
    groups = defaultdict(list)
    for row in rows:
        groups[row.narrow_phase, row.nodes, row.sdf_cells].append(row)
    finest = max(key for key in groups if key[0] == "sdf")
    heights = {key: np.array([row.height_m for row in group]) for key, group in groups.items()}
    expected, own = heights[finest].mean(), standard_error(heights[finest])
    for key, group in groups.items():
        if key == finest:
            continue
        off, bar = abs(heights[key].mean() / expected - 1), np.hypot(standard_error(heights[key]), own) / expected
        yield Dot(*key, float(np.mean([row.wall_s for row in group])), off, bar, bar)


def standard_error(values):
    return values.std(ddof=1) / np.sqrt(len(values)) if len(values) > 1 else 0.0


def panels_of(impacts, piles):
    panels = {
        ("energy that an impact wins or loses:\nmedian of 12, and the worst", "processor time of an impact  [ms]"): [
            Dot(row.narrow_phase, row.nodes, row.sdf_cells, row.cpu_ms, row.energy_median, 0, row.energy_worst - row.energy_median)
            for row in impacts
        ],
        ("largest force of an impact, rms error\nagainst 10,242 nodes and 128 cells", "processor time of an impact  [ms]"): [
            Dot(row.narrow_phase, row.nodes, row.sdf_cells, row.cpu_ms, row.force_off, 0, 0) for row in impacts
        ],
    }
    if piles:
        panels["mean height of 1,000 rocks at rest, off that of the\nfinest field (bars: its standard error)", "wall time  [s]"] = list(
            heights_off(piles))
    return panels


def plot_panel(axis, title, dots):
    for dot in dots:
        colour = COLOURS.get((dot.narrow_phase, dot.sdf_cells), COLOURS.get(dot.narrow_phase, "#333333"))
        axis.errorbar(dot.time, dot.error, yerr=[[min(dot.low, 0.9 * dot.error)], [dot.high]], fmt=MARKERS.get(dot.nodes, "x"),
                      color=colour, markersize=7, elinewidth=0.8, capsize=2)
    axis.set(xscale="log", yscale="log", xlabel=title[1])
    axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.xaxis.set_minor_formatter("")
    axis.set_title(title[0], fontsize=12)
    finish(axis)


def figure_of(panels):
    figure, axes = figure_grid(1, len(panels), 5.0 * len(panels), 5.0)
    for axis, (title, dots) in zip(axes.flat, panels.items()):
        plot_panel(axis, title, dots)
    handles = [
        plt.Line2D([], [], marker="o", linestyle="", color=colour,
                   label="rays" if key == "rays" else f"distance field, {key[1]} cells") for key, colour in COLOURS.items()
    ]
    handles += [plt.Line2D([], [], marker=marker, linestyle="", color="#777777", label=f"{nodes} nodes") for nodes, marker in MARKERS.items()]
    legend_below(figure, handles, len(COLOURS))
    return figure


def main():
    options = arguments()
    impacts = read_rows(options.impacts, Impact, "bench_narrow_phases")
    piles = read_rows(options.piles, Pile, "narrow_phase_piles.py") if options.piles else []
    write(figure_of(panels_of(impacts, piles)), options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"narrow_phases: {error}")
