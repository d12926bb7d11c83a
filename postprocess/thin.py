#!/usr/bin/python3
"""A small copy of a run: fewer rows, and of snapshots only what a section along the wheel's way and a view from above show.

The copy is a run directory: all other commands read it. Needs Debian's python3-h5py and python3-numpy.
"""

import argparse
import sys
from pathlib import Path

from tread_post import Run, RunError
from tread_post.thinned import thin


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run")
    parser.add_argument("copy", type=Path, metavar="DIR", help="where the copy goes")
    parser.add_argument("--rows", type=int, default=800, metavar="N", help="of each table, at most; default: 800")
    parser.add_argument("--phase", metavar="NAME", help="leave out what was before this phase; default: nothing")
    parser.add_argument("--times", type=float, nargs="*", default=[], metavar="S", help="of snapshots to keep, since that phase began (or since the "
                        "start); the nearest are taken; default: none")
    return parser.parse_args()


def start_of(run, phase):
    if phase is None:
        return 0.0
    starts = {begun.name: begun.start for begun in run.phases}
    if phase not in starts:
        raise RunError(f"{run.path}: no phase '{phase}' has begun; there are {', '.join(starts) or 'none'}")
    return starts[phase]


def nearest(run, times):
    """Numbers of the snapshots nearest to the times (s)."""
    if not times:
        return []
    there = run.points_times or {number: run.bodies(number).time for number in run.snapshots}
    if not there:
        raise RunError(f"{run.path}: no snapshots to keep")
    return sorted({min(there, key=lambda number: abs(there[number] - time)) for time in times})


def main():
    options = arguments()
    run = Run(options.run)
    start = start_of(run, options.phase)
    thin(run, options.copy, options.rows, start, nearest(run, [start + time for time in options.times]))
    print(options.copy)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"thin: {error}")
