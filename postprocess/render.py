#!/usr/bin/python3
"""A picture of one snapshot, or a film of all: wheels, rocks, and sand coloured by how far it moved, or by its rank.

Needs Debian's python3-h5py, python3-numpy and python3-vtk9, xvfb where there is no display, and python3-pil for films.
"""

import argparse
import sys
import tempfile
from pathlib import Path

from tread_post import Run, RunError
from tread_post.display import ensure_display


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run")
    parser.add_argument("--snapshot", default="last", metavar="K|last", help="number of the snapshot; default: last")
    parser.add_argument("--film", action="store_true", help="all snapshots, one after the other, as a GIF")
    parser.add_argument("--colour", default="displacement", choices=("displacement", "rank"), help="what the sand shows")
    parser.add_argument("--output", type=Path, metavar="FILE", help="default: RUN/render.png, or RUN/render.gif")
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


def write_film(frames, output):
    """GIF of pictures, a tenth of a second each, the last one for a second."""
    from PIL import Image

    pictures = [Image.open(frame).convert("RGB").quantize(128) for frame in frames]
    pictures[0].save(output, save_all=True, append_images=pictures[1:], duration=[100] * (len(frames) - 1) + [1000], loop=0)


def main():
    options = arguments()
    run = Run(options.run)
    number = snapshot_number(run, options.snapshot)
    ensure_display()
    from tread_post.picture import draw, view_of

    size = tuple(options.size)
    output = options.output or options.run / ("render.gif" if options.film else "render.png")
    if not options.film:
        draw(run, number, view_of(run, [number]), output, size, options.colour)
    else:
        view = view_of(run, run.snapshots)
        with tempfile.TemporaryDirectory() as folder:
            frames = [Path(folder) / f"{snapshot:04}.png" for snapshot in run.snapshots]
            for snapshot, frame in zip(run.snapshots, frames):
                draw(run, snapshot, view, frame, size, options.colour)
            write_film(frames, output)
    print(output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"render: {error}")
