#!/usr/bin/python3
"""The largest substep of settled piles against stiffness: a plot from the CSV of bench_contact_step.

Needs Debian's python3-matplotlib.
"""

import argparse
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from matplotlib.lines import Line2D

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post import RunError
from tread_post.rows import read_rows
from tread_post.style import figure_grid, finish, write

# Okabe and Ito's colours, which the colour-blind can tell apart.
COLOURS = {"exact spheres": "#000000", "spheres of nodes": "#0072B2", "irregular rocks": "#009E73", "cubes": "#D55E00"}
STYLES = {1e-2: ("o", "-"), 1e-3: ("s", "--"), 1e-4: ("^", ":")}
TAKEN, STOPPED = 0.2, 0.8  # of sqrt(m / sum K): what the solver takes, and where it stops a scene that fixes more


@dataclass(frozen=True)
class Row:
    kind: str
    young_Pa: float
    linear_overlap: float
    live_body_s: float
    stable_s: float
    rayleigh_s: float
    hertz_impact_s: float


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("steps", type=Path, metavar="FILE.csv", help="of bench_contact_step")
    parser.add_argument("--output", type=Path, default=Path("contact_step.png"), metavar="FILE.png", help="default: contact_step.png")
    return parser.parse_args()


def plot_lines(axis, rows, value):
    lines = defaultdict(list)
    for row in rows:
        lines[row.kind, row.linear_overlap].append((row.young_Pa, value(row)))
    for (kind, knee), points in lines.items():
        marker, style = STYLES.get(knee, ("x", "-"))
        axis.plot(*zip(*sorted(points)), marker=marker, linestyle=style, color=COLOURS.get(kind, "#777777"), markersize=6, linewidth=1.2)


def plot_references(axis, rows):
    times = sorted({(row.young_Pa, row.rayleigh_s, row.hertz_impact_s) for row in rows})
    young = [time[0] for time in times]
    axis.plot(young, [0.2 * time[1] for time in times], color="#999999", linewidth=3, alpha=0.6, label="0.2 of Rayleigh's time")
    axis.plot(young, [time[2] / 50 for time in times], color="#CC79A7", linewidth=3, alpha=0.6, label="Hertz, 50th of an impact at 1 m/s")
    axis.legend(fontsize=9, edgecolor="none", loc="lower left")


def figure_of(rows):
    figure, ((steps, shares),) = figure_grid(1, 2, 14.0, 5.0)
    plot_lines(steps, rows, lambda row: row.stable_s)
    plot_references(steps, rows)
    steps.set(xscale="log", yscale="log", xlabel="Young's modulus  [Pa]", title="largest stable substep  [s]")
    plot_lines(shares, rows, lambda row: row.stable_s / row.live_body_s)
    for share, text in ((TAKEN, "taken by the solver"), (STOPPED, "a scene that fixes more is stopped"), (2, "one body between fixed springs")):
        shares.axhline(share, color="#999999", linewidth=1)
        shares.annotate(text, (1, share), xycoords=("axes fraction", "data"), xytext=(0, 3), textcoords="offset points", ha="right", fontsize=9)
    shares.set(xscale="log", ylim=(0, 2.2), xlabel="Young's modulus  [Pa]", title=r"the same over $\sqrt{m / \Sigma K}$ of live contacts")
    for axis in (steps, shares):
        finish(axis)
    handles = [Line2D([], [], color=colour, label=kind) for kind, colour in COLOURS.items()]
    handles += [
        Line2D([], [], marker=marker, linestyle=style, color="#777777", label=f"$d_0$ = {knee:g} R*") for knee, (marker, style) in STYLES.items()
    ]
    shares.legend(handles=handles, fontsize=9, edgecolor="none", loc="upper left", bbox_to_anchor=(1.02, 1))
    return figure


def main():
    options = arguments()
    write(figure_of(read_rows(options.steps, Row, "bench_contact_step")), options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"contact_step: {error}")
