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
FULL_CELL = 6  # points of a cell that eight would fill, behind which none is seen
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


def beads(position, shades, spacing):
    """Actor with points as spheres as wide as their share of the sand, without those that others hide."""
    rows = outer_rows(position, spacing)
    data = vtk.vtkPolyData()
    data.SetPoints(vtk_points(position[rows]))
    scalars = numpy_to_vtk(np.ascontiguousarray(shades.values[rows], dtype=np.float32), deep=True)
    scalars.SetName("shade")
    data.GetPointData().SetScalars(scalars)
    cells = vtk.vtkCellArray()
    count = len(rows)
    cells.SetData(id_array(np.arange(count + 1)), id_array(np.arange(count)))
    data.SetVerts(cells)
    mapper = vtk.vtkOpenGLSphereMapper()
    mapper.SetInputData(data)
    mapper.SetRadius(0.62 * spacing)
    return shaded(mapper, shades)


def outer_rows(position, spacing):
    """Rows of the points that may be seen: in cells of eight points with a cell beside them that is not full."""
    cell = ((position - position.min(axis=0)) / (2 * spacing) + 1.25).astype(np.int64)  # a lattice lies well inside of cells
    size = cell.max(axis=0) + 2
    number = (cell[:, 0] * size[1] + cell[:, 1]) * size[2] + cell[:, 2]
    inside = (np.bincount(number, minlength=np.prod(size)) >= FULL_CELL).reshape(size)
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


def surface_of(position, values, spacing, box):
    """Surface (vtkPolyData with normals, and the values as scalars) around points that were `spacing` (m) apart: where they are half as dense as a
    bed at rest. Single points that fly have none. All points lie in `box`, [2, 3] (m), and the sand that touches a side of it ends there in a plane.
    """
    low = np.maximum(box[0], position.min(axis=0) - MARGIN * spacing)
    high = np.minimum(box[1], position.max(axis=0) + MARGIN * spacing)
    size = np.maximum(np.rint((high - low) / spacing).astype(int), 1)
    cell = (high - low) / size
    places = (position - low) / cell - 0.5  # nodes are the middles of cells
    density = _smoothed(_deposited(places, np.full(len(places), spacing**3 / np.prod(cell)), size))
    sums = _smoothed(_deposited(places, values * spacing**3 / np.prod(cell), size))
    means = np.pad(sums / np.maximum(density, 1e-3), 1, "edge")
    density = _closed(density)
    image = vtk.vtkImageData()
    image.SetDimensions(*map(int, size + 2))
    image.SetOrigin(*(low - 0.5 * cell))
    image.SetSpacing(*cell)
    for name, field in (("density", density), ("shade", means)):
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
        for _ in range(2):
            first, last = np.take(field, [0], axis), np.take(field, [-1], axis)
            padded = np.concatenate((first, field, last), axis)
            middle = [slice(None)] * 3
            sides = []
            for begin, end in ((0, -2), (2, None)):
                middle[axis] = slice(begin, end)
                sides.append(padded[tuple(middle)])
            field = 0.5 * field + 0.25 * (sides[0] + sides[1])
    return field


def _closed(density):
    """The densities with a layer of nodes around them, with which the surface of sand that touches a side is half a cell outside of it."""
    padded = np.pad(density, 1, "edge")
    inner = np.zeros(padded.shape, bool)
    inner[1:-1, 1:-1, 1:-1] = True
    return np.where(inner, padded, np.where(padded > SURFACE_FRACTION, 2 * SURFACE_FRACTION - padded, 0.0))
