"""The sand of a picture: a bead for each point, or the surface around them; and what its colours say."""

from dataclasses import dataclass

import numpy as np
import vtk
from matplotlib import colormaps
from matplotlib.colors import to_rgba
from vtk.util.numpy_support import numpy_to_vtk

from tread_post.run import RunError
from tread_post.vtk_data import id_array, vtk_points

# Pale where nothing moved, as sand is; tells apart without red and green.
COLOURS = "YlGnBu"
# Of ranks, again and again: Okabe and Ito (2008), told apart by all.
RANK_COLOURS = ("#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7")
PLAIN_COLOUR = "#D9BF94"
SURFACE_FRACTION = 0.5  # of the bed's density, where the surface is
BEAD = 0.62  # radius of a bead over its spacing: beads of a lattice overlap
FULL = 0.7  # of a cell's volume, behind which no bead is seen
MARGIN = 3  # empty nodes around the points, so that their surface closes


@dataclass
class Shades:
    """What the colours of the sand say."""

    values: np.ndarray  # [points]
    table: vtk.vtkLookupTable
    title: str  # of the scale; without one there is no scale
    labels: np.ndarray  # on the scale


def shades_of(points, colour, largest):
    """Shades by `colour`: "displacement" up to `largest` (m), "rank", or "plain"."""
    if colour == "rank":
        return _shades_of_ranks(points)
    if colour == "plain":
        return Shades(np.zeros(len(points.position)), lookup_table([to_rgba(PLAIN_COLOUR)] * 2, 0.0, 1.0), "", np.zeros(0))
    moved = np.linalg.norm(points.fields["displacement"], axis=1)
    factor, unit = (1e3, "mm") if largest < 0.5 else (1.0, points.units["displacement"])
    end = round_end(largest * factor)
    table = lookup_table(colormaps[COLOURS](np.linspace(0.0, 1.0, 256)), 0.0, end)
    return Shades(moved * factor, table, f"displacement\n[{unit}]", np.linspace(0.0, end, 5))


def _shades_of_ranks(points):
    if "rank" not in points.fields:
        raise RunError("--colour rank: this snapshot does not say which rank has a point")
    rank = points.fields["rank"]
    count = int(rank.max()) + 1
    colours = [to_rgba(RANK_COLOURS[index % len(RANK_COLOURS)]) for index in range(count)]
    return Shades(rank, lookup_table(colours, -0.5, count - 0.5), "rank", np.arange(float(count)))


def round_end(value):
    """The next number whose quarters are short to write."""
    power = 10.0 ** np.floor(np.log10(value))
    return next(step * power for step in (1, 1.2, 1.6, 2, 2.4, 3, 4, 5, 6, 8, 10) if step * power >= value * (1 - 1e-9))


def lookup_table(colours, low, high):
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(len(colours))
    table.SetRange(low, high)
    for index, colour in enumerate(colours):
        table.SetTableValue(index, *colour)
    return table


def beads(position, shades, spacings):
    """Actor with points as spheres as wide as their share of the sand, without those that others hide. `spacings` (m): of each to its neighbours."""
    rows = outer_rows(position, spacings)
    data = vtk.vtkPolyData()
    data.SetPoints(vtk_points(position[rows]))
    for name, values in (("shade", shades.values[rows]), ("radius", BEAD * spacings[rows])):
        array = numpy_to_vtk(np.ascontiguousarray(values, dtype=np.float32), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    data.GetPointData().SetActiveScalars("shade")
    cells = vtk.vtkCellArray()
    count = len(rows)
    cells.SetData(id_array(np.arange(count + 1)), id_array(np.arange(count)))
    data.SetVerts(cells)
    mapper = vtk.vtkOpenGLSphereMapper()
    mapper.SetInputData(data)
    mapper.SetScaleArray("radius")
    return shaded(mapper, shades)


def outer_rows(position, spacings):
    """Rows of the points that may be seen: in cells twice as wide as the widest spacing, with a cell beside them that is not full."""
    width = 2 * spacings.max()
    cell = ((position - position.min(axis=0)) / width + 1.25).astype(np.int64)  # a lattice lies well inside of cells
    size = cell.max(axis=0) + 2
    number = (cell[:, 0] * size[1] + cell[:, 1]) * size[2] + cell[:, 2]
    inside = (np.bincount(number, (spacings / width) ** 3, np.prod(size)) >= FULL).reshape(size)
    for axis in range(3):
        inside = inside & np.roll(inside, 1, axis) & np.roll(inside, -1, axis)
    return np.flatnonzero(~inside.ravel()[number])


def shaded(mapper, shades):
    """Actor of a mapper whose scalars are values of `shades`."""
    mapper.SetLookupTable(shades.table)
    mapper.SetScalarRange(shades.table.GetRange())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor


def surface_of(position, values, spacings, box):
    """Surface (vtkPolyData with normals, and the values as scalars) around points that were `spacings` (m) apart: where they are half as dense as a
    bed at rest. Single points that fly have none. All points lie in `box`, [2, 3] (m), and the sand that touches a side of it ends there in a plane.
    """
    spacing = spacings.max()
    low = np.maximum(box[0], position.min(axis=0) - MARGIN * spacing)
    high = np.minimum(box[1], position.max(axis=0) + MARGIN * spacing)
    size = np.maximum(np.rint((high - low) / spacing).astype(int), 1)
    cell = (high - low) / size
    places = (position - low) / cell - 0.5  # nodes are the middles of cells
    shares = spacings**3 / np.prod(cell)  # of a cell that a point fills
    density = _smoothed(_deposited(places, shares, size))
    means = _smoothed(_deposited(places, shares * values, size)) / np.maximum(density, 1e-3)
    return _contour(_closed(density), np.pad(means, 1, "edge"), low - 0.5 * cell, cell)


def _contour(density, values, origin, spacing):
    """Surface where the density is SURFACE_FRACTION, with the values there; both fields are [z, y, x], with a first node and distances in m."""
    image = vtk.vtkImageData()
    image.SetDimensions(*reversed(density.shape))
    image.SetOrigin(*origin)
    image.SetSpacing(*spacing)
    for name, field in (("density", density), ("shade", values)):
        array = numpy_to_vtk(np.ascontiguousarray(field, dtype=np.float32).ravel(), deep=True)
        array.SetName(name)
        image.GetPointData().AddArray(array)
    image.GetPointData().SetActiveScalars("density")
    contour = vtk.vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, SURFACE_FRACTION)
    contour.ComputeNormalsOn()
    contour.ComputeScalarsOff()
    contour.InterpolateAttributesOn()
    contour.Update()
    surface = contour.GetOutput()
    surface.GetPointData().SetActiveScalars("shade")
    return surface


def _deposited(places, values, size):
    """Sum of the values at each node, [z, y, x]: each point at `places` (cells from the first node) shares its own among eight nodes by linear
    weights. Sides of the grid are mirrors, half a cell outside of the outermost nodes."""
    base = np.floor(places).astype(np.int64)
    rest = places - base
    total = np.zeros(np.prod(size))
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, rest, 1 - rest), axis=1)
        node = np.clip(base + corner, 0, size - 1)
        total += np.bincount((node[:, 2] * size[1] + node[:, 1]) * size[0] + node[:, 0], weight * values, len(total))
    return total.reshape(size[2], size[1], size[0])


def _smoothed(field):
    """Binomial means over five nodes along each axis; sides are mirrors."""
    for axis in (0, 1, 2):
        along = np.moveaxis(field, axis, 0)
        for _ in range(2):
            padded = np.concatenate((along[:1], along, along[-1:]))
            along = 0.5 * along + 0.25 * (padded[:-2] + padded[2:])
        field = np.moveaxis(along, 0, axis)
    return field


def _closed(density):
    """The densities with a layer of nodes around them, with which the surface of sand that touches a side of the grid lies in it."""
    padded = np.pad(density, 1, "edge")
    inner = np.zeros(padded.shape, bool)
    inner[1:-1, 1:-1, 1:-1] = True
    return np.where(inner, padded, np.where(padded > SURFACE_FRACTION, 2 * SURFACE_FRACTION - padded, 0.0))
