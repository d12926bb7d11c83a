"""How far the terrain has moved: along a plane through the wheel, and seen from above. From snapshots, whole ones or thinned.

Rocks of which a snapshot does not say how far they have come are grey.
"""

from dataclasses import replace

import h5py
import matplotlib
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import Normalize

from tread_post.geometry import point_spacing
from tread_post.sections import outline_of
from tread_post.style import GREY, figure_grid

PERCENTILE = 99.5
# Over the terrain, up to which sections are shown, m.
ABOVE = 0.25
# Of the view from above, across the domain, at most.
CELLS = 80
# In place of how far something has moved, m: below every scale.
UNKNOWN = -1.0
SHADES = matplotlib.colormaps["YlGnBu"].with_extremes(under=GREY)


def figure_of(title, shown, common_scale=True):
    """A row for each (label, run, snapshot number): section, view from above."""
    terrains = [_terrain(run, number) for _, run, number in shown]
    largest = [_largest(moved[moved != UNKNOWN]) for _, moved, _ in terrains]
    outlines = [_outline(run, number) for _, run, number in shown]
    size = shown[0][1].scene["domain"]["size"]
    tops = [ABOVE + np.percentile(place[:, 2], PERCENTILE) for place, _, _ in terrains] + [cut[..., 2].max() for cut in outlines if len(cut)]
    high = min(size[2], max(tops))
    figure, axes = figure_grid(len(shown), 2, 15.0, 7.5 * max(high, size[1]) / size[0] * 0.85 + 1.1)
    for row, ((label, run, number), terrain, cut, scale) in enumerate(zip(shown, terrains, outlines, largest)):
        norm = Normalize(0, 1e3 * (max(largest) if common_scale else scale))
        section, above = axes[row]
        dots = _dots(section, terrain, norm, (0, 2), _near(run, number, terrain))
        _draw_from_above(above, terrain, norm, size)
        section.add_collection(LineCollection(cut[:, :, (0, 2)], colors="#222222", linewidths=0.9))
        section.set(xlim=(0, size[0]), ylim=(0, high), aspect="equal", ylabel="z  [m]", title=label)
        above.set(xlim=(0, size[0]), ylim=(0, size[1]), aspect="equal", ylabel="y  [m]", title="from above")
        figure.colorbar(dots, ax=axes[row, :], label="displacement  [mm]", shrink=0.8, extend="max")
    for axis in axes[-1]:
        axis.set_xlabel("x  [m]")
    figure.suptitle(title, fontsize=14)
    return figure


def last_snapshot(run):
    return run.snapshots[-1]


def _largest(moved):
    return max(np.percentile(moved, PERCENTILE), 1e-4) if len(moved) else 1e-4


def _terrain(run, number):
    """Places [n, 3] (m), how far each has moved (m, or UNKNOWN), and their sizes (m), of points and rocks."""
    places, moved, sizes = [], [], []
    points, bodies = run.points(number), run.bodies(number)
    if points is not None:
        places.append(points.position)
        moved.append(np.linalg.norm(points.fields["displacement"], axis=1))
        sizes.append(np.full(len(points.position), 1.2 * point_spacing(run.scene, points)))
    named = len(run.scene.get("body", []))
    if bodies is not None:
        places.append(bodies.position[named:])
        moved.append(_way_of_bodies(run, number, len(bodies.position))[named:])
        sizes.append(bodies.scale[named:])
    return np.concatenate(places), np.concatenate(moved), np.concatenate(sizes)


def _way_of_bodies(run, number, count):
    """Returns how far bodies have come, from a thinned snapshot that holds it; UNKNOWN for any other."""
    with h5py.File(run.path / "snapshots" / f"bodies_{number:04}.h5", "r", locking=False) as file:
        return np.linalg.norm(file["displacement"], axis=1) if "displacement" in file else np.full(count, UNKNOWN)


def _outline(run, number):
    """Returns the outline of the named bodies in the plane of the section: lines [n, 2, 3] (m)."""
    bodies, named = run.bodies(number), len(run.scene.get("body", []))
    if bodies is None:
        return np.empty((0, 2, 3))
    first = replace(bodies, **{name: getattr(bodies, name)[:named] for name in ("position", "orientation", "scale", "shape")}, fields={})
    return outline_of(first, run.shapes, 1, float(bodies.position[0, 1]))


def _near(run, number, terrain):
    bodies = run.bodies(number)
    middle = bodies.position[0, 1] if bodies is not None else 0.5 * run.scene["domain"]["size"][1]
    return np.flatnonzero(np.abs(terrain[0][:, 1] - middle) <= 0.75 * terrain[2])


def _draw_from_above(axis, terrain, norm, size):
    """The displacement of what is highest in each cell of a lattice."""
    place, moved, sizes = terrain
    cell = max(2.5 * np.median(sizes), size[1] / CELLS)
    counts = [int(np.ceil(length / cell)) for length in size[:2]]
    seen = np.full(counts, np.nan)
    order = np.argsort(place[:, 2])
    at = np.clip((place[order, :2] / cell).astype(int), 0, np.array(counts) - 1)
    seen[at[:, 0], at[:, 1]] = 1e3 * moved[order]  # the highest comes last
    axis.pcolormesh(cell * np.arange(counts[0] + 1), cell * np.arange(counts[1] + 1), seen.T, norm=norm, cmap=SHADES)


def _dots(axis, terrain, norm, plane, rows):
    place, moved, size = (part[rows] for part in terrain)
    dots = EllipseCollection(size, size, np.zeros(len(rows)), units="xy", offsets=place[:, plane], transOffset=axis.transData, norm=norm,
                             cmap=SHADES, linewidths=0)
    dots.set_array(1e3 * moved)
    axis.add_collection(dots)
    return dots
