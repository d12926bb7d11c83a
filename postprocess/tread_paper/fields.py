"""How far the terrain has moved, along a plane through the wheel and seen from above, and how high its surface is. From snapshots, whole ones or thinned.

Rocks of which a snapshot does not say how far they have come are grey.
"""

from dataclasses import replace

import h5py
import matplotlib
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import LightSource, Normalize

from tread_post.geometry import point_spacing
from tread_post.sections import outline_of
from tread_post.style import COLOURS, DASHES, GREY, figure_grid, finish
from tread_post.thinned import COLUMNS

PERCENTILE = 99.5
# Over the terrain, up to which sections are shown, m.
ABOVE = 0.25
# In place of how far something has moved, m: below every scale.
UNKNOWN = -1.0
# Around the wheel's middle, m across and up, of the section close to it; from which displacement on sand has moved, m: the paper's of Fig. 21.
CLOSE = (0.55, 0.4)
MOVED = 0.01
ROCK = "#A5713B"
MOVED_SHADES = matplotlib.colormaps["YlGnBu"].with_extremes(under="#E9E4DA")
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
        _draw_from_above(above, terrain, norm, size, _column(run, number))
        section.add_collection(LineCollection(cut[:, :, (0, 2)], colors="#222222", linewidths=0.9))
        section.set(xlim=(0, size[0]), ylim=(0, high), aspect="equal", ylabel="z  [m]", title=label)
        above.set(xlim=(0, size[0]), ylim=(0, size[1]), aspect="equal", ylabel="y  [m]", title="from above")
        figure.colorbar(dots, ax=axes[row, :], label="displacement  [mm]", shrink=0.8, extend="max")
    for axis in axes[-1]:
        axis.set_xlabel("x  [m]")
    figure.suptitle(title, fontsize=14)
    return figure


def surface_figure_of(title, shown, behind):
    """The surface of sand with its rocks: from above, along the wheel's plane behind it, and across the track. A row for each (label, run, snapshot number).

    `behind` are distances (m) of the lines across from the wheel's axle, against its way. Heights count from the mean of the surface along both sides of the
    bed, a tenth of its width. From above the sand is shaded as by a lamp at the end of the bed.
    """
    size = shown[0][1].scene["domain"]["size"]
    figure, axes = figure_grid(len(shown), 3, 17.0, 7.5 * size[1] / size[0] + 0.6, width_ratios=(1.25, 1.0, 1.0))
    for row, (label, run, number) in enumerate(shown):
        height, cell, base = _surface(run, number)
        above, along, across = axes[row]
        axle = float(run.bodies(number).position[0, 0])
        lamp = LightSource(azdeg=90, altdeg=30)
        shade = lamp.hillshade(np.nan_to_num(height.T, nan=np.nanmin(height)), vert_exag=2, dx=cell, dy=cell)
        above.imshow(shade, extent=(0, cell * height.shape[0], 0, cell * height.shape[1]), origin="lower", cmap="gray", vmin=0, vmax=1)
        _rocks_from_above(above, run, number)
        above.add_collection(LineCollection(_outline(run, number, 2)[:, :, (0, 1)], colors="#222222", linewidths=1.2))
        place, top = _along(run, number)
        along.plot(place, 1e3 * (top - base), color="#222222", linewidth=1.1)
        along.set(xlim=(0, axle), xlabel="x  [m]", ylabel="height of the sand  [mm]", title="along the wheel's plane, to its axle")
        middles = cell * (np.arange(height.shape[1]) + 0.5)
        for distance, colour, dash in zip(behind, COLOURS, DASHES):
            columns = slice(max(int((axle - distance) / cell) - 1, 0), int((axle - distance) / cell) + 2)
            across.plot(middles, 1e3 * np.nanmean(height[columns], axis=0), color=colour, linestyle=dash, label=f"{1e3 * distance:.0f} mm behind the axle")
            above.axvline(axle - distance, color=colour, linewidth=1.1, linestyle=dash)
        above.set(xlim=(0, size[0]), ylim=(0, size[1]), aspect="equal", xlabel="x  [m]", ylabel="y  [m]", title=label)
        across.set(xlabel="y  [m]", title="across the track, means over three columns")
        across.legend(edgecolor="none", fontsize=9.5, loc="lower right")
        finish(along)
        finish(across)
    figure.suptitle(title, fontsize=14)
    return figure


def _along(run, number):
    """Places (m) and heights (m) of the highest sand in bins of a spacing along the plane through the wheel."""
    points, middle = run.points(number), float(run.bodies(number).position[0, 1])
    spacing = point_spacing(run.scene, points)
    near = points.position[np.abs(points.position[:, 1] - middle) <= 0.75 * spacing]
    top = np.full(int(run.scene["domain"]["size"][0] / spacing) + 1, np.nan)
    order = np.argsort(near[:, 2])
    top[np.clip((near[order, 0] / spacing).astype(int), 0, len(top) - 1)] = near[order, 2]
    return spacing * (np.arange(len(top)) + 0.5), top


def _surface(run, number):
    """Height (m) of the highest point of sand in each column, [nx, ny], over the bed's own; the columns' side (m); and that bed's height (m)."""
    points, size = run.points(number), run.scene["domain"]["size"]
    cell = _column(run, number)
    counts = [int(np.ceil(length / cell - 1e-6)) for length in size[:2]]
    height = np.full(counts, np.nan)
    order = np.argsort(points.position[:, 2])
    at = np.clip((points.position[order, :2] / cell).astype(int), 0, np.array(counts) - 1)
    height[at[:, 0], at[:, 1]] = points.position[order, 2]
    side = max(counts[1] // 10, 1)
    base = float(np.nanmean(height[:, [*range(side), *range(-side, 0)]]))
    return height - base, cell, base


def _rocks_from_above(axis, run, number):
    """Draws rocks as discs, the highest last."""
    bodies, named = run.bodies(number), len(run.scene.get("body", []))
    order = named + np.argsort(bodies.position[named:, 2])
    if len(order):
        size = bodies.scale[order]
        axis.add_collection(EllipseCollection(size, size, np.zeros(len(order)), units="xy", offsets=bodies.position[order, :2], transOffset=axis.transData,
                                              facecolors=ROCK, edgecolors="#4A2F12", linewidths=0.4))


def close_up_of(title, shown):
    """A row for each (label, run, snapshot number): the section close to the wheel, with sand by how far it has moved and rocks brown, and the view from
    above."""
    terrains = [_terrain(run, number) for _, run, number in shown]
    largest = max(_largest(moved[moved != UNKNOWN]) for _, moved, _ in terrains)
    norm, whole = Normalize(1e3 * MOVED, 1e3 * max(largest, 2 * MOVED)), Normalize(0, 1e3 * largest)
    size = shown[0][1].scene["domain"]["size"]
    figure, axes = figure_grid(len(shown), 2, 15.0, 7.5 * max(2 * CLOSE[1] / (2 * CLOSE[0]), size[1] / size[0]) * 0.8 + 0.6)
    for row, ((label, run, number), terrain) in enumerate(zip(shown, terrains)):
        section, above = axes[row]
        middle = run.bodies(number).position[0]
        _sand_and_rocks(section, run, number, norm, _near(run, number, terrain), terrain)
        section.add_collection(LineCollection(_outline(run, number)[:, :, (0, 2)], colors="#222222", linewidths=0.9))
        section.set(xlim=(middle[0] - CLOSE[0], middle[0] + CLOSE[0]), ylim=(middle[2] - CLOSE[1], middle[2] + 0.6 * CLOSE[1]), aspect="equal", ylabel="z  [m]",
                    title=label)
        seen = _draw_from_above(above, terrain, whole, size, _column(run, number))
        above.set(xlim=(0, size[0]), ylim=(0, size[1]), aspect="equal", ylabel="y  [m]", title="from above")
        figure.colorbar(seen, ax=axes[row, :], label="displacement  [mm]", shrink=0.8, extend="max")
    for axis in axes[-1]:
        axis.set_xlabel("x  [m]")
    figure.suptitle(title, fontsize=14)
    return figure


def _sand_and_rocks(axis, run, number, norm, near, terrain):
    """Draws what is near the plane: sand by displacement, rocks brown."""
    points = run.points(number)
    sand = 0 if points is None else len(points.position)
    place, moved, size = (part[near] for part in terrain)
    of_sand = near < sand
    for rows, colours in ((of_sand, None), (~of_sand, ROCK)):
        look = {"facecolors": colours, "edgecolors": "#4A2F12", "linewidths": 0.3} if colours else {"norm": norm, "cmap": MOVED_SHADES, "linewidths": 0}
        if not rows.any():
            continue
        drawn = EllipseCollection(size[rows], size[rows], np.zeros(rows.sum()), units="xy", offsets=place[rows][:, (0, 2)], transOffset=axis.transData, **look)
        if not colours:
            drawn.set_array(1e3 * moved[rows])
        axis.add_collection(drawn)


def last_snapshot(run):
    """Number of the last snapshot that says how far the terrain has moved; of the last one where none does."""
    return next((number for number in reversed(run.snapshots) if (_terrain(run, number)[1] != UNKNOWN).any()), run.snapshots[-1])


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


def _column(run, number):
    """Side (m) of the columns whose highest point or rock a thinned snapshot keeps."""
    points, bodies, across = run.points(number), run.bodies(number), run.scene["domain"]["size"][1]
    if points is not None:
        return max(2 * point_spacing(run.scene, points), across / COLUMNS)
    sizes = np.array([np.linalg.norm(shape.vertices, axis=1).max() for shape in run.shapes])
    return max(3 * np.median(bodies.scale * sizes[bodies.shape]), across / COLUMNS)


def _draw_from_above(axis, terrain, norm, size, cell):
    """The displacement of what is highest in each column of side `cell` (m)."""
    place, moved, _ = terrain
    counts = [int(np.ceil(length / cell - 1e-6)) for length in size[:2]]
    seen = np.full(counts, np.nan)
    order = np.argsort(place[:, 2])
    at = np.clip((place[order, :2] / cell).astype(int), 0, np.array(counts) - 1)
    seen[at[:, 0], at[:, 1]] = 1e3 * moved[order]  # the highest comes last
    return axis.pcolormesh(cell * np.arange(counts[0] + 1), cell * np.arange(counts[1] + 1), seen.T, norm=norm, cmap=SHADES)


def _dots(axis, terrain, norm, plane, rows):
    place, moved, size = (part[rows] for part in terrain)
    dots = EllipseCollection(size, size, np.zeros(len(rows)), units="xy", offsets=place[:, plane], transOffset=axis.transData, norm=norm,
                             cmap=SHADES, linewidths=0)
    dots.set_array(1e3 * moved)
    axis.add_collection(dots)
    return dots
