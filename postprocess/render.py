#!/usr/bin/python3
"""A picture of one snapshot: wheels, rocks, and sand coloured by how far it moved, or by the rank that has it.

Needs Debian's python3-h5py, python3-numpy and python3-vtk9, and xvfb where there is no display.
"""

import argparse
import sys
from pathlib import Path

from tread_post import Run, RunError
from tread_post.display import ensure_display


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run")
    parser.add_argument("--snapshot", default="last", metavar="K|last", help="number of the snapshot; default: last")
    parser.add_argument("--colour", default="displacement", choices=("displacement", "rank"), help="what the sand shows")
    parser.add_argument("--output", type=Path, metavar="FILE.png", help="default: RUN/render.png")
    parser.add_argument("--size", type=int, nargs=2, default=(1600, 1000), metavar=("W", "H"), help="pixels")
    return parser.parse_args()


def snapshot_number(run, wanted):
    numbers = run.snapshots
    if not numbers:
        raise RunError(f"{run.path / 'snapshots'}: no snapshots")
    if wanted == "last":
        return numbers[-1]
    if not wanted.isdecimal() or int(wanted) not in numbers:
        raise RunError(f"--snapshot {wanted}: this run has {numbers[0]} to {numbers[-1]}, or last")
    return int(wanted)


def main():
    options = arguments()
    run = Run(options.run)
    number = snapshot_number(run, options.snapshot)
    ensure_display()
    from tread_post.picture import draw

    output = options.output or options.run / "render.png"
    draw(run, number, output, tuple(options.size), options.colour)
    print(output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"render: {error}")
