#!/usr/bin/python3
"""What sleeping sand changes: torque and sinkage of a drive, and its time, beside the same drive with all sand awake.

Runs of one scene: the first without sleep, others without sleep from a start that was shifted by next to nothing (what
chance does to the drive), others with sleep. Means are over the rows of the last drive from SECONDS after its ramp on,
as far as all runs have come. Errors are relative to the mean of the first run and its repeats; speed is simulated time
over wall time, that of the first run being 1.

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
from tread_post.style import COLOURS, GREY, figure_grid, finish, write

QUANTITIES = {"torque": "N m", "sinkage": "m", "drawbar_pull": "N"}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("awake", type=Path, metavar="RUN", help="run in which no sand sleeps")
    parser.add_argument("--repeats", type=Path, nargs="*", default=[], metavar="RUN", help="the same from a start shifted by next to nothing")
    parser.add_argument("--asleep", type=Path, nargs="+", required=True, metavar="RUN", help="runs in which sand sleeps")
    parser.add_argument("--from", type=float, default=1.0, dest="begin", metavar="SECONDS", help="after the ramp (default: 1)")
    parser.add_argument("--table", type=Path, metavar="FILE.csv")
    parser.add_argument("--output", type=Path, metavar="FILE.png")
    return parser.parse_args()


def means(drive, begin, until):
    rows = (drive.time >= drive.start + begin) & (drive.time <= until)
    if not rows.any():
        raise RunError(f"no row {begin:g} s after the ramp")
    return {name: float(drive.series[name][rows].mean()) for name in QUANTITIES}


def row_of(path, kind, begin, until):
    run = Run(path)
    summary = run.summary
    if summary is None:
        raise RunError(f"{path}: not ended")
    row = {"run": path.name, "kind": kind, "distance": run.scene.get("sleep", {}).get("distance", "")}
    row |= means(last_drive(run), begin, until)
    row |= {name: summary[name] for name in ("points", "steps", "time", "wall_s", "asleep")}
    row["energy_error"], row["momentum_error"] = summary["errors"]["energy"], summary["errors"]["momentum"]
    return row


def compare(rows):
    """Adds speed and errors to the rows; the first is the one to compare with."""
    awake = [row for row in rows if row["kind"] != "asleep"]
    for row in rows:
        row["speed"] = row["time"] / row["wall_s"] * rows[0]["wall_s"] / rows[0]["time"]
        for name in QUANTITIES:
            mean = np.mean([other[name] for other in awake])
            row[f"{name}_error"] = row[name] / mean - 1


def figure_of(options):
    figure, axes = figure_grid(len(QUANTITIES), 1, 11.0, 2.8, sharex=True)
    runs = [(options.awake, GREY, "all sand awake")]
    runs += [(path, GREY, None) for path in options.repeats]
    runs += [(path, COLOURS[i % len(COLOURS)], path.name) for i, path in enumerate(options.asleep)]
    for axis, (name, unit) in zip(axes[:, 0], QUANTITIES.items()):
        for path, colour, label in runs:
            drive = last_drive(Run(path))
            axis.plot(drive.time, drive.series[name], color=colour, linewidth=1.0, label=label)
        axis.set_ylabel(f"{name.replace('_', ' ')}  [{unit}]")
        finish(axis)
    axes[0, 0].legend(loc="upper right", frameon=False)
    axes[-1, 0].set_xlabel("time  [s]")
    return figure


def say(rows):
    for row in rows:
        errors = ", ".join(f"{name} {100 * row[f'{name}_error']:+.3f} %" for name in QUANTITIES)
        share = "" if row["asleep"] is None else f", {100 * row['asleep']:.1f} % asleep"
        print(f"{row['run']} ({row['kind']}): {row['wall_s']:.1f} s, {row['speed']:.2f} times as fast{share}; {errors}")


def main():
    options = arguments()
    runs = [(options.awake, "awake"), *((path, "repeat") for path in options.repeats), *((path, "asleep") for path in options.asleep)]
    until = min(last_drive(Run(path)).time[-1] for path, _ in runs)
    rows = [row_of(path, kind, options.begin, until) for path, kind in runs]
    compare(rows)
    say(rows)
    if options.table:
        write_rows(options.table, rows)
    if options.output:
        write(figure_of(options), options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"sleep: {error}")
