#!/usr/bin/python3
"""A picture of one snapshot, or a film of all: wheels, rocks, and sand coloured by how far it moved, or by its rank.

Needs Debian's python3-h5py, python3-numpy and python3-vtk9, xvfb where there is no display, and for films python3-pil, or ffmpeg for MP4.

    tread post render runs/quickstart --film --output quickstart.mp4 --fps 20
"""

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

from tread_post import Run, RunError
from tread_post.display import ensure_display
from tread_post.film import require_writer, write_film


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run")
    parser.add_argument("--snapshot", default="last", metavar="K|last", help="number of the snapshot; default: last")
    parser.add_argument("--film", action="store_true", help="all snapshots, one after the other")
    parser.add_argument("--fps", type=float, default=10.0, metavar="N", help="pictures a second of a film, 1 to 100; default: 10")
    parser.add_argument("--colour", default="displacement", choices=("displacement", "rank"), help="what the sand shows")
    parser.add_argument("--output", type=Path, metavar="FILE", help="default: RUN/render.png; of films, .gif or .mp4, RUN/render.gif")
    parser.add_argument("--size", type=int, nargs=2, default=(1600, 1000), metavar=("W", "H"), help="pixels")
    options = parser.parse_args()
    if not 1 <= options.fps <= 100:
        parser.error(f"--fps {options.fps:g}: accepted: 1 to 100")
    return options


def snapshot_number(run, wanted):
    numbers = run.snapshots
    if not numbers:
        raise RunError(f"{run.path / 'snapshots'}: no snapshots")
    if wanted == "last":
        return numbers[-1]
    if not wanted.isdecimal() or int(wanted) not in numbers:
        raise RunError(f"--snapshot {wanted}: this run has {numbers[0]} to {numbers[-1]}, or last")
    return int(wanted)


def rates(times, fps):
    """Simulated seconds a second of film in each picture: the time to the next one times `fps`."""
    spans = np.diff(times)
    return fps * np.append(spans, spans[-1:] if len(spans) else 0.0)


def main():
    options = arguments()
    run = Run(options.run)
    number = snapshot_number(run, options.snapshot)
    if options.film:
        require_writer(options.output or options.run / "render.gif")
    ensure_display()
    from tread_post.picture import draw, view_of

    size = tuple(options.size)
    output = options.output or options.run / ("render.gif" if options.film else "render.png")
    if not options.film:
        draw(run, number, view_of(run, [number]), output, size, options.colour)
    else:
        view = view_of(run, run.snapshots)
        of_points = run.points_times
        times = [of_points[snapshot] if snapshot in of_points else run.bodies(snapshot).time for snapshot in run.snapshots]
        with tempfile.TemporaryDirectory() as folder:
            frames = [Path(folder) / f"{snapshot:04}.png" for snapshot in run.snapshots]
            for snapshot, frame, rate in zip(run.snapshots, frames, rates(times, options.fps)):
                draw(run, snapshot, view, frame, size, options.colour, f", {rate:.2g} times as fast as real")
            write_film(frames, output, options.fps)
    print(output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"render: {error}")
