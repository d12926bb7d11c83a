#!/usr/bin/python3
"""A picture of one snapshot, or a film of all: wheels, rocks, and sand coloured by how far it moved, or by its rank.

Needs Debian's python3-h5py, python3-numpy and python3-vtk9, xvfb where there is no display, and for films python3-pil, or ffmpeg for MP4.

    tread post render runs/quickstart --film --output quickstart.mp4 --fps 20
    tread post render runs/quickstart --sand surface --light sun --output still.png
    tread post render runs/quickstart --film --follow wheel --cut y --sand surface --output along.mp4
"""

import argparse
import multiprocessing
import re
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from tread_post import Run, RunError
from tread_post.camera import VIEWS
from tread_post.display import ensure_display
from tread_post.film import require_writer, write_film


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run")
    parser.add_argument("--snapshot", default="last", metavar="K|last", help="number of the snapshot; default: last")
    parser.add_argument("--film", action="store_true", help="all snapshots, one after the other")
    parser.add_argument("--fps", type=float, default=10.0, metavar="N", help="pictures a second of a film, 1 to 100; default: 10")
    parser.add_argument("--colour", default="displacement", choices=("displacement", "rank", "plain"), help="what the sand shows")
    parser.add_argument("--sand", default="beads", choices=("beads", "surface"), help="a bead for each point, or their surface; default: beads")
    parser.add_argument("--light", default="lamps", choices=("lamps", "sun"), help="sun: soft shadows, of sand as a surface; default: lamps")
    parser.add_argument("--view", default="oblique", choices=VIEWS, help="where the camera is; default: oblique, from behind, the right and above")
    parser.add_argument("--backdrop", default="sky", choices=("sky", "white"), help="default: sky")
    parser.add_argument("--follow", metavar="BODY", help="the camera goes with this [[body]]")
    parser.add_argument("--cut", metavar="AXIS[=M]", help="leave out sand and rocks on the camera's side of a plane, x=0.3 or y or z; default place: "
                        "the middle of the body that is followed, else of the first, else of the domain")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="pictures of a film that are drawn at a time; default: 1")
    parser.add_argument("--output", type=Path, metavar="FILE", help="default: RUN/render.png; of films, .gif or .mp4, RUN/render.gif")
    parser.add_argument("--size", type=int, nargs=2, default=(1600, 1000), metavar=("W", "H"), help="pixels")
    options = parser.parse_args()
    if not 1 <= options.fps <= 100:
        parser.error(f"--fps {options.fps:g}: accepted: 1 to 100")
    if options.jobs < 1:
        parser.error(f"--jobs {options.jobs}: at least 1")
    if options.sand == "beads" and options.light == "sun":
        parser.error("--light sun: needs --sand surface")
    if options.sand == "surface" and options.colour == "rank":
        parser.error("--colour rank: needs --sand beads, as each point has its own rank")
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


def followed_row(run, name):
    """Row of the [[body]] table of this name; None of None."""
    names = [body.get("name") for body in run.scene.get("body", [])]
    if name is not None and name not in names:
        raise RunError(f"--follow {name}: accepted: {', '.join(map(str, names)) or 'nothing, as the scene has no [[body]]'}")
    return None if name is None else names.index(name)


def cut_of(run, text, row, number):
    """(axis, place in m) of `--cut`; without a place, that of the body of the row in this snapshot."""
    if text is None:
        return None
    matched = re.fullmatch(r"([xyz])(?:=([0-9.eE+-]+))?", text)
    try:
        axis, at = "xyz".index(matched[1]), None if matched[2] is None else float(matched[2])
    except (TypeError, ValueError):
        raise RunError(f"--cut {text}: accepted: x, y or z, and a place in metres, as y=0.25") from None
    size = run.scene["domain"]["size"]
    if at is not None:
        if not 0 <= at <= size[axis]:
            raise RunError(f"--cut {text}: accepted: 0 to {size[axis]:g} m, the domain")
        return axis, at
    bodies = run.bodies(number)
    if bodies is not None and run.scene.get("body"):
        return axis, float(bodies.position[row or 0, axis])
    return axis, 0.5 * size[axis]


def rates(times, fps):
    """Simulated seconds a second of film in each picture: the time to the next one times `fps`."""
    spans = np.diff(times)
    return fps * np.append(spans, spans[-1:] if len(spans) else 0.0)


def draw_all(run, numbers, row, remarks, files, options, look):
    """Draws snapshots into files, in `options.jobs` processes; the camera follows the body of `row`, if there is one."""
    from tread_post.picture import draw, view_of, views_around

    view = view_of(run, numbers, look)
    views = [view] * len(numbers) if row is None else views_around(run, numbers, row, view)
    tasks = [(run, number, one, file, tuple(options.size), look, remark) for number, one, file, remark in zip(numbers, views, files, remarks)]
    if options.jobs == 1 or len(tasks) == 1:
        for task in tasks:
            draw(*task)
        return
    with ProcessPoolExecutor(min(options.jobs, len(tasks)), multiprocessing.get_context("spawn")) as pool:
        list(pool.map(draw, *zip(*tasks)))


def main():
    options = arguments()
    run = Run(options.run)
    number = snapshot_number(run, options.snapshot)
    row = followed_row(run, options.follow)
    output = options.output or options.run / ("render.gif" if options.film else "render.png")
    cut = cut_of(run, options.cut, row, number)
    if options.film:
        require_writer(output)
    ensure_display()
    from tread_post.picture import Look

    look = Look(options.colour, options.sand, options.light, options.view, options.backdrop, cut)
    if not options.film:
        draw_all(run, [number], row, [""], [output], options, look)
    else:
        of_points = run.points_times
        times = [of_points[snapshot] if snapshot in of_points else run.bodies(snapshot).time for snapshot in run.snapshots]
        with tempfile.TemporaryDirectory() as folder:
            frames = [Path(folder) / f"{snapshot:04}.png" for snapshot in run.snapshots]
            remarks = [f", {rate:.2g} x real time" for rate in rates(times, options.fps)]
            draw_all(run, run.snapshots, row, remarks, frames, options, look)
            write_film(frames, output, options.fps)
    print(output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"render: {error}")
