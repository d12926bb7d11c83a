"""Draws meshes side by side with VTK. Needs a display."""

from dataclasses import dataclass

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from tread_post.canvas import add_lights, mesh_actor, plain, write
from tread_post.picture import WHEEL_COLOUR
from tread_post.run import RunError
from tread_post.vtk_data import FEATURE_ANGLE

READERS = {".stl": vtk.vtkSTLReader, ".obj": vtk.vtkOBJReader}
# From the right-hand side, ahead and above: a wheel shows its tread and its inside.
VIEW_DIRECTION = np.array((0.85, -1.0, 0.45))
EDGE_COLOUR = (0.30, 0.31, 0.33)
EDGE_WIDTH = 1.5
# Of the largest shape, between neighbours; and of a column's width, for the two lines under each.
GAP, LABEL = 0.10, 0.17
LETTERS = 20


@dataclass
class Mesh:
    name: str
    surface: vtk.vtkPolyData  # centred on its box, with normals that are smooth but for sharp edges
    welded: vtk.vtkPolyData  # the same with one point a corner, for its edges
    extent: np.ndarray  # m


def read_shape(path):
    reader_of = READERS.get(path.suffix.lower())
    if reader_of is None:
        raise RunError(f"{path}: accepted are {', '.join(READERS)}")
    if not path.is_file():
        raise RunError(f"{path}: no such file")
    reader = reader_of()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    if data.GetNumberOfPolys() == 0:
        raise RunError(f"{path}: no triangles")
    low, high = np.array(data.GetBounds()).reshape(3, 2).T
    welded = weld(moved(data, -0.5 * (low + high)))
    return Mesh(path.stem, smooth(welded), welded, high - low)


def draw_shapes(meshes, columns, output, width):
    """Writes the picture of all meshes to `output` (.png), `columns` in a row, `width` pixels wide."""
    right, up = view_axes()
    sizes = np.array([span(mesh, (right, up)) for mesh in meshes])
    cell = sizes.max(axis=0) + GAP * sizes.max()
    cell[1] += LABEL * cell[0]
    rows = -(-len(meshes) // columns)
    size = (width, round(width * rows * cell[1] / (columns * cell[0])))

    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    add_lights(renderer)
    for index, mesh in enumerate(meshes):
        row, column = divmod(index, columns)
        across = (column + 0.5 - 0.5 * columns) * cell[0]
        upwards = (0.5 * rows - row - 0.5) * cell[1]
        add_mesh(renderer, mesh, across * right + (upwards + 0.5 * LABEL * cell[0]) * up)
        label_top = 1 - (row + 1 - LABEL * cell[0] / cell[1]) / rows
        add_label(renderer, mesh, ((column + 0.5) / columns, label_top), columns, size)
    look(renderer, 0.5 * rows * cell[1], up)
    write(renderer, output, size)


def view_axes():
    """Unit vectors that point right and up in the picture."""
    right = np.cross((0.0, 0.0, 1.0), VIEW_DIRECTION)
    up = np.cross(VIEW_DIRECTION, right)
    return right / np.linalg.norm(right), up / np.linalg.norm(up)


def span(mesh, axes):
    points = vtk_to_numpy(mesh.surface.GetPoints().GetData())
    return [2 * np.abs(points @ axis).max() for axis in axes]


def moved(data, offset):
    transform = vtk.vtkTransform()
    transform.Translate(*offset)
    mover = vtk.vtkTransformPolyDataFilter()
    mover.SetInputData(data)
    mover.SetTransform(transform)
    mover.Update()
    return mover.GetOutput()


def weld(data):
    clean = vtk.vtkCleanPolyData()
    clean.SetInputData(data)
    clean.Update()
    return clean.GetOutput()


def smooth(data):
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetFeatureAngle(FEATURE_ANGLE)
    normals.Update()
    return normals.GetOutput()


def add_mesh(renderer, mesh, place):
    actor = mesh_actor(mesh.surface)
    actor.SetPosition(*place)
    actor.GetProperty().SetColor(*WHEEL_COLOUR)
    actor.GetProperty().SetSpecular(0.2)
    actor.GetProperty().SetSpecularPower(20)
    renderer.AddActor(actor)
    add_sharp_edges(renderer, mesh, place)


def add_sharp_edges(renderer, mesh, place):
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(mesh.welded)
    edges.BoundaryEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.SetFeatureAngle(FEATURE_ANGLE)
    edges.ColoringOff()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(edges.GetOutputPort())
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.SetPosition(*place)
    actor.GetProperty().SetColor(*EDGE_COLOUR)
    actor.GetProperty().SetLineWidth(EDGE_WIDTH)
    actor.GetProperty().LightingOff()
    renderer.AddActor(actor)


def add_label(renderer, mesh, place, columns, size):
    actor = vtk.vtkTextActor()
    actor.SetInput(f"{mesh.name}\n{' x '.join(f'{length:.3g}' for length in mesh.extent)} m")
    text = actor.GetTextProperty()
    plain(text, LETTERS, (size[0] * 4 / max(columns, 4), size[0]))
    text.SetJustificationToCentered()
    text.SetVerticalJustificationToTop()
    text.SetLineSpacing(1.3)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(*place)
    renderer.AddActor2D(actor)


def look(renderer, half_height, up):
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(0.0, 0.0, 0.0)
    camera.SetPosition(*VIEW_DIRECTION)
    camera.SetViewUp(*up)
    camera.SetParallelScale(half_height)
    renderer.ResetCameraClippingRange()
