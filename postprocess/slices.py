#!/usr/bin/python3
"""Sand on a plane through the wheel at several times: displacement, and rate of equivalent plastic shear strain, as in the paper's Figs. 17 and 18.

Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import LogNorm, Normalize

from tread_post import Run, RunError
from tread_post.geometry import point_spacing
from tread_post.sections import outline_of
from tread_post.style import figure_grid, write

# The plane's normal, and the two axes in it.
PLANES = {"x": (0, 1, 2), "y": (1, 0, 2), "z": (2, 0, 1)}
NAMES = "xyz"
# Single points that fly off do not stretch the scale of displacement; slower than this share of the fastest shear is at rest.
PERCENTILE, DECADES = 99.5, 3
# Width of a point's dot, in distances of points: no gaps between sheared layers.
DOT = 1.7
# Of the highest sand, up to which wheels are shown.
ABOVE = 1.7


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run with snapshots")
    parser.add_argument("--plane", choices=PLANES, default="y", help="its normal; default: y, along the wheel's way")
    parser.add_argument("--at", type=float, metavar="M", help="where it stands; default: the middle of the first body, else of the domain")
    parser.add_argument("--snapshots", type=int, nargs="+", metavar="K", help="default: four, evenly spread over the last phase")
    parser.add_argument("--output", type=Path, metavar="FILE.png", help="default: RUN/slices.png")
    return parser.parse_args()


def chosen_snapshots(run):
    """Up to four, from the start of the last phase to the end."""
    times = run.points_times
    if not times:
        raise RunError(f"{run.path / 'snapshots'}: no snapshot has sand")
    begun = run.phases[-1].start if run.phases else 0.0
    late = [number for number, time in times.items() if time >= begun - 1e-9] or list(times)
    return sorted({late[round(i * (len(late) - 1) / 3)] for i in range(4)})


def slice_of(points, axis, at, spacing):
    """Rows of the points near the plane: one layer, or both where it lies between two."""
    return np.flatnonzero(np.abs(points.position[:, axis] - at) <= 0.75 * spacing)


def draw_panel(axis, run, number, plane, field, norm, colours):
    normal, across, up = PLANES[plane[0]]
    points = run.points(number)
    distance = point_spacing(run.scene, points)
    rows = slice_of(points, normal, plane[1], distance)
    place = points.position[rows][:, (across, up)]
    width = np.full(len(rows), DOT * distance)
    dots = EllipseCollection(width, width, np.zeros(len(rows)), units="xy",
                             offsets=place, transOffset=axis.transData, norm=norm, cmap=colours, linewidths=0)
    dots.set_array(np.maximum(field(points)[rows], norm.vmin))
    axis.add_collection(dots)
    bodies = run.bodies(number)
    if bodies is not None:
        axis.add_collection(LineCollection(outline_of(bodies, run.shapes, normal, plane[1])[:, :, (across, up)], colors="#222222", linewidths=0.9))
    return dots


def displacement(points):
    """Length, mm."""
    return 1e3 * np.linalg.norm(points.fields["displacement"], axis=1)


def shear_rate(points):
    return points.fields["plastic_rate"]


def norms_of(run, numbers):
    """One scale a field for all times."""
    snapshots = [run.points(number) for number in numbers]
    moved = max(float(np.percentile(displacement(points), PERCENTILE)) for points in snapshots) or 1e-3
    rate = max(float(np.percentile(shear_rate(points), PERCENTILE)) for points in snapshots) or 1e-3
    return Normalize(0.0, moved), LogNorm(rate * 10.0**-DECADES, rate)


def window_of(run, plane, numbers):
    """Limits across and up, m: the domain, and of its height what sand and the lower part of a wheel take."""
    _, across, up = PLANES[plane[0]]
    size = run.scene["domain"]["size"]
    highest = max(float(run.points(number).position[:, up].max()) for number in numbers)
    return (0.0, size[across]), (0.0, size[up] if plane[0] == "z" else min(size[up], ABOVE * highest))


def figure_of(run, plane, numbers, norms=None, start=0.0):
    """`plane` is its normal's name and where it stands, m. `norms` are scales of both fields, default: this run's; times count from `start` (s)."""
    normal, across, up = PLANES[plane[0]]
    wide, high = window_of(run, plane, numbers)
    figure, axes = figure_grid(len(numbers), 2, 15.0, 6.4 * high[1] / wide[1] + 0.5 + 1.8 / len(numbers), sharex=True, sharey=True)
    fields = ((displacement, "displacement  [mm]", "YlGnBu"), (shear_rate, "rate of equivalent plastic shear strain  [1/s]", "cividis"))
    for column, ((field, label, colours), norm) in enumerate(zip(fields, norms or norms_of(run, numbers))):
        for row, number in enumerate(numbers):
            axis = axes[row, column]
            dots = draw_panel(axis, run, number, plane, field, norm, colours)
            axis.set(xlim=wide, ylim=high, aspect="equal", title=f"t = {run.points(number).time - start:.2f} s")
            axis.set_ylabel(f"{NAMES[up]}  [m]" if column == 0 else "")
        axes[-1, column].set_xlabel(f"{NAMES[across]}  [m]")
        figure.colorbar(dots, ax=axes[:, column], location="bottom", label=label, shrink=0.8, aspect=40, extend="max")
    figure.suptitle(f"{run.title}\nplane {NAMES[normal]} = {plane[1]:.3f} m", fontsize=14)
    return figure


def default_place(run, normal, number):
    bodies = run.bodies(number)
    if bodies is not None and run.scene.get("body"):
        return float(bodies.position[0, normal])
    return 0.5 * run.scene["domain"]["size"][normal]


def main():
    options = arguments()
    run = Run(options.run)
    numbers = options.snapshots or chosen_snapshots(run)
    absent = [number for number in numbers if number not in run.points_times]
    if absent:
        raise RunError(f"{run.path / 'snapshots'}: no sand in snapshot {absent[0]}; this run has {run.snapshots[0]} to {run.snapshots[-1]}")
    at = default_place(run, PLANES[options.plane][0], numbers[0]) if options.at is None else options.at
    write(figure_of(run, (options.plane, at), numbers), options.output or options.run / "slices.png")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"slices: {error}")
