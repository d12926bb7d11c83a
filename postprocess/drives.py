#!/usr/bin/python3
"""Drawbar pull, torque and sinkage of a campaign's drives against time: what is steady in them, and what the means of slip_curves.py stand for.

A row of panels for each combination of the axes that are not slip, a line for each slip; without a slip axis a line for each case. Dots: from where
the means are taken, by the runs' verdicts (docs/verdict.md), with a ring where a drive had not become steady. Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np

import slip_curves
from tread_post import RunError
from tread_post.answers import last_drive
from tread_post.campaign import CampaignTable
from tread_post.run import DAMAGE
from tread_post.style import COLOURS, figure_grid, finish, legend_below, readable, with_unit, write
from tread_post.verdict import FAILED, headline, plot_verdicts, verdict_handles

PANELS = (("drawbar_pull", "drawbar pull / weight"), ("torque", "torque / (weight x radius)"), ("sinkage", "sinkage"))
# Of the means that are drawn, s.
WINDOW = 0.08


@dataclass(frozen=True)
class Line:
    label: str
    row: int  # of the table
    drive: object


@dataclass(frozen=True)
class Group:
    """Drives that share a row of panels."""

    name: str
    lines: list
    radius: float  # m; NaN where the scene does not say


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("campaign", type=Path, metavar="DIR", help="of a campaign, after `jobs/campaign.py collect`")
    parser.add_argument("--output", type=Path, metavar="FILE.png", help="default: DIR/drives.png")
    return parser.parse_args()


def groups_of(table):
    """Groups the cases whose runs exist."""
    groups = []
    for curve in slip_curves.curves_of(table) if table.slip_axes else [_all_cases(table)]:
        labels = [f"slip {table['slip'][row]:.2g}" if table.slip_axes else _label(table, row) for row in curve.rows]
        rows = [(label, row) for label, row in zip(labels, curve.rows) if table.verdicts[row] != FAILED]
        lines = [Line(label, row, drive) for label, row in rows if (drive := _drive(table, row))]
        if lines:
            groups.append(Group(curve.name, lines, curve.wheel.radius if curve.wheel else np.nan))
    return groups


def figure_of(table):
    groups = groups_of(table)
    if not groups:
        raise RunError(f"{table.path}: no run of it is there")
    figure, axes = figure_grid(len(groups), 3, 14.0, 3.8, sharex=True)
    _, unit = readable(table["sinkage"], "m")
    for row, group in zip(axes, groups):
        for axis, (quantity, label) in zip(row, PANELS):
            for line, colour in zip(group.lines, _colours(len(group.lines), bool(table.slip_axes))):
                _draw(axis, table, line, quantity, group.radius, colour)
            axis.set_ylabel(with_unit(label, unit if quantity == "sinkage" else "1"))
            finish(axis)
        row[0].set_title(group.name, loc="left", fontsize=13)
        row[-1].legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    for axis in axes[-1]:
        axis.set_xlabel("time  [s]")
    legend_below(figure, verdict_handles(table.verdicts), 3)
    figure.suptitle(f"{table.title}\n{headline(table.verdicts)}", fontsize=15)
    return figure


def _draw(axis, table, line, quantity, radius, colour):
    time, values = line.drive.time, line.drive.series[quantity]
    if quantity == "sinkage":
        factor = readable(table["sinkage"], "m")[0]
    else:
        factor = 1 / (line.drive.series["weight"].mean() * (radius if quantity == "torque" else 1.0))
    parts = np.array_split(np.arange(len(time)), max(1, round((time[-1] - time[0]) / WINDOW)))
    times, means = (np.array([column[part].mean() for part in parts]) for column in (time, factor * values))
    axis.plot(times, means, color=colour, linewidth=1.5, label=line.label)
    start, is_steady = table["steady_from"][line.row], table["steady"][line.row] > 0
    is_done = table["state"][line.row] == "done"
    # Dark, as a cross in the colour of its line is lost on it.
    plot_verdicts(axis, start, np.interp(start, times, means), table.verdicts[line.row], "#333333", not (is_steady and is_done), size=6.0)


def _colours(count, by_slip):
    return matplotlib.colormaps["cividis"](np.linspace(0.0, 0.92, count)) if by_slip else [COLOURS[i % len(COLOURS)] for i in range(count)]


def _all_cases(table):
    """Everything in one row of panels."""
    rows = np.flatnonzero(np.isfinite(table["torque"])) if "torque" in table.columns else np.zeros(0, int)
    if not len(rows):
        raise RunError(f"{table.path}: no case has driven a wheel to speed")
    scene = table.scene(rows[0])
    return slip_curves.Curve("", rows, slip_curves.wheel_of(scene, float(np.mean(table["weight"][rows]))), scene)


def _label(table, row):
    return ", ".join(str(table[key][row]) for key in table.label_columns)


def _drive(table, row):
    try:
        return last_drive(table.run(row))
    except DAMAGE:
        return None


def main():
    options = arguments()
    write(figure_of(CampaignTable(options.campaign)), options.output or options.campaign / "drives.png")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"drives: {error}")
