#!/usr/bin/python3
"""What sleep changes before chance does: drives that go on from checkpoints of one in which all sand is awake, beside that one.

AWAKE was run with a sleep.distance that keeps all sand awake, and with [checkpoint]; each BRANCH went on from one of its
checkpoints (tread run --restart FILE), with a smaller distance, or as a control with the same from a state that was moved
by next to nothing. A branch begins at the last row that it shares with AWAKE. Means of torque and sinkage are over the
same span of time of both, from SECONDS after that to SECONDS after that, or as far as the branch has come: integrals
over time, since rows are means over the steps since the row before, and do not end at the same times. Errors are
relative to AWAKE. The mean over branches that sleep, with its standard error, is what sleep does.

Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post import Run, RunError
from tread_post.answers import last_drive
from tread_post.rows import write_rows
from tread_post.style import COLOURS, GREY, figure_grid, finish, legend_below, write

QUANTITIES = ("torque", "sinkage")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("awake", type=Path, metavar="AWAKE")
    parser.add_argument("branches", type=Path, nargs="+", metavar="BRANCH")
    parser.add_argument("--from", type=float, default=0.1, dest="begin", metavar="SECONDS", help="default: 0.1")
    parser.add_argument("--until", type=float, default=0.75, metavar="SECONDS", help="default: 0.75")
    parser.add_argument("--table", type=Path, metavar="FILE.csv")
    parser.add_argument("--output", type=Path, metavar="FILE.png")
    return parser.parse_args()


def shared_until(awake, branch):
    """s, the last row that both have."""
    rows = min(len(awake.time), len(branch.time))
    same = (awake.time[:rows] == branch.time[:rows]) & (awake.series["torque"][:rows] == branch.series["torque"][:rows])
    shared = rows if same.all() else int(np.argmin(same))
    if shared == 0:
        raise RunError("a branch shares no row of the drive")
    return awake.time[shared - 1]


def mean(drive, name, begin, end):
    """Over time, of rows that are means since the row before."""
    integral = np.cumsum(drive.series[name] * np.diff(drive.time, prepend=drive.time[0]))
    at_begin, at_end = np.interp([begin, end], drive.time, integral)
    return (at_end - at_begin) / (end - begin)


def row_of(awake, path, options):
    run = Run(path)
    branch = last_drive(run)
    begins = shared_until(awake, branch)
    begin, end = begins + options.begin, min(begins + options.until, branch.time[-1], awake.time[-1])
    row = {"run": path.name, "distance": run.scene["sleep"]["distance"], "begins": begins, "from": begin, "until": end}
    for name in QUANTITIES:
        row[f"{name}_awake"], row[name] = (mean(drive, name, begin, end) for drive in (awake, branch))
        row[f"{name}_error"] = row[name] / row[f"{name}_awake"] - 1
    return row


def say(rows, sleeps):
    for row in rows:
        errors = ", ".join(f"{name} {100 * row[f'{name}_error']:+.3f} %" for name in QUANTITIES)
        print(f"{row['run']} ({row['distance']:g} m), {row['from']:.3f} to {row['until']:.3f} s: {errors}")
    for name in QUANTITIES:
        errors = 100 * np.array([row[f"{name}_error"] for row in rows if sleeps(row)])
        if len(errors) > 1:
            print(f"{name}: {errors.mean():+.3f} % +- {errors.std(ddof=1) / np.sqrt(len(errors)):.3f} %, {len(errors)} branches asleep")


def figure_of(awake, paths, rows, sleeps):
    figure, axes = figure_grid(1, len(QUANTITIES), 13.0, 4.2)
    for axis, name in zip(axes[0], QUANTITIES):
        for colour, path, row in zip(np.resize(COLOURS, len(rows)), paths, rows):
            branch = last_drive(Run(path))
            after = branch.time > row["begins"]
            beside = np.interp(branch.time[after], awake.time, awake.series[name])
            off = np.abs(branch.series[name][after] - beside) / row[f"{name}_awake"]
            asleep = sleeps(row)
            label = f"asleep from {row['begins']:.1f} s on" if asleep else f"awake, moved, {row['begins']:.1f} s"
            axis.plot(branch.time[after] - row["begins"], np.maximum(off, 1e-9), color=colour if asleep else GREY, linestyle="-" if asleep else ":",
                      label=label, linewidth=1.3)
        axis.set(yscale="log", xlabel="time since the checkpoint  [s]", title=f"difference of {name}, over its mean")
        finish(axis)
    legend_below(figure, axes[0, 0].get_lines(), 4)
    return figure


def main():
    options = arguments()
    whole = Run(options.awake)
    awake, awake_distance = last_drive(whole), whole.scene["sleep"]["distance"]
    rows = [row_of(awake, path, options) for path in options.branches]

    def sleeps(row):
        return row["distance"] < awake_distance

    say(rows, sleeps)
    if options.table:
        write_rows(options.table, rows)
    if options.output:
        write(figure_of(awake, options.branches, rows, sleeps), options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"sleep_pairs: {error}")
