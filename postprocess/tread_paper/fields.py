"""How far the terrain has moved, along a plane through the wheel and seen from above, and how high its surface is. From snapshots, whole ones or thinned.

Rocks of which a snapshot does not say how far they have come are grey.
"""

from dataclasses import replace

import h5py
import matplotlib
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import Normalize, TwoSlopeNorm

from tread_post.geometry import point_spacing
from tread_post.sections import outline_of
from tread_post.style import COLOURS, GREY, figure_grid, finish
from tread_post.thinned import COLUMNS

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


def surface_figure_of(title, shown, behind):
    """The height of the highest sand and of rocks, from above, and along lines across the track: a row for each (label, run, snapshot number).

    `behind` are distances (m) of the lines from the wheel's axle, against its way. Heights count from the mean of the surface along both sides of the
    bed, a tenth of its width.
    """
    size = shown[0][1].scene["domain"]["size"]
    surfaces = [_surface(run, number) for _, run, number in shown]
    largest = max(np.nanpercentile(np.abs(1e3 * height), PERCENTILE) for height, _, _ in surfaces)
    norm = TwoSlopeNorm(0.0, -largest, largest)
    figure, axes = figure_grid(len(shown), 2, 15.0, 7.5 * size[1] / size[0] + 1.4, width_ratios=(1.6, 1.0))
    for row, ((label, run, number), (height, cell, base)) in enumerate(zip(shown, surfaces)):
        above, across = axes[row]
        edges = [cell * np.arange(count + 1) for count in height.shape]
        above.pcolormesh(*edges, 1e3 * height.T, norm=norm, cmap="RdBu_r")
        drawn = _rocks_from_above(above, run, number, norm, base)
        bodies, middles = run.bodies(number), 0.5 * (edges[1][1:] + edges[1][:-1])
        axle = float(bodies.position[0, 0])
        above.add_collection(LineCollection(_outline(run, number, 2)[:, :, (0, 1)], colors="#222222", linewidths=0.9))
        for distance, colour in zip(behind, COLOURS):
            place = axle - distance
            columns = slice(max(int(place / cell) - 1, 0), int(place / cell) + 2)
            across.plot(middles, 1e3 * np.nanmean(height[columns], axis=0), color=colour, label=f"{1e3 * distance:.0f} mm behind the axle")
            above.axvline(place, color=colour, linewidth=0.9, linestyle="--")
        above.set(xlim=(0, size[0]), ylim=(0, size[1]), aspect="equal", ylabel="y  [m]", title=label)
        across.set(xlabel="y  [m]", ylabel="height of the surface  [mm]", title="across the track, means over three columns")
        across.legend(edgecolor="none", fontsize=9.5)
        finish(across)
        figure.colorbar(drawn, ax=above, label="height  [mm]", shrink=0.8, extend="both")
    axes[-1, 0].set_xlabel("x  [m]")
    figure.suptitle(title, fontsize=14)
    return figure


def _surface(run, number):
    """Height (m) of the highest point of sand in each column, [nx, ny], over the bed's own; the columns' side (m); and that bed's height (m)."""
    points, size = run.points(number), run.scene["domain"]["size"]
    cell = max(2 * point_spacing(run.scene, points), size[1] / COLUMNS)
    counts = [int(np.ceil(length / cell - 1e-6)) for length in size[:2]]
    height = np.full(counts, np.nan)
    order = np.argsort(points.position[:, 2])
    at = np.clip((points.position[order, :2] / cell).astype(int), 0, np.array(counts) - 1)
    height[at[:, 0], at[:, 1]] = points.position[order, 2]
    side = max(counts[1] // 10, 1)
    base = float(np.nanmean(height[:, [*range(side), *range(-side, 0)]]))
    return height - base, cell, base


def _rocks_from_above(axis, run, number, norm, base):
    """Draws rocks as discs, by the height of their middles over the bed; the highest last."""
    bodies, named = run.bodies(number), len(run.scene.get("body", []))
    order = named + np.argsort(bodies.position[named:, 2])
    size = bodies.scale[order]
    discs = EllipseCollection(size, size, np.zeros(len(order)), units="xy", offsets=bodies.position[order, :2], transOffset=axis.transData, norm=norm,
                              cmap="RdBu_r", edgecolors="#333333", linewidths=0.4)
    discs.set_array(1e3 * (bodies.position[order, 2] - base))
    axis.add_collection(discs)
    return discs


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


def _outline(run, number, axis=1):
    """Returns the outline of the named bodies in the plane through the first one's middle, normal to an axis: lines [n, 2, 3] (m)."""
    bodies, named = run.bodies(number), len(run.scene.get("body", []))
    if bodies is None:
        return np.empty((0, 2, 3))
    first = replace(bodies, **{name: getattr(bodies, name)[:named] for name in ("position", "orientation", "scale", "shape")}, fields={})
    return outline_of(first, run.shapes, axis, float(bodies.position[0, axis]))


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
