"""Draws a snapshot with VTK. Needs a display."""

from dataclasses import dataclass

import numpy as np
import vtk
from matplotlib import colormaps
from matplotlib.colors import to_rgba
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

from tread_post.geometry import point_spacing, rotated
from tread_post.run import RunError

# Pale where nothing moved, as sand is; tells apart without red and green.
COLOURS = "YlGnBu"
# Of ranks, again and again: Okabe and Ito (2008), told apart by all.
RANK_COLOURS = ("#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7")
WHEEL_COLOUR = (0.78, 0.79, 0.82)
ROCK_COLOUR = (0.62, 0.47, 0.38)
TEXT_COLOUR = (0.15, 0.15, 0.15)
# The largest displacements are those of single grains thrown about: they do not stretch the scale.
SCALE_PERCENTILE = 99.5
# Edges of a mesh sharper than this stay sharp.
FEATURE_ANGLE = 35.0
# From behind, from the right-hand side and from above, for a wheel that drives along +x: its rut lies open.
VIEW_DIRECTION = (-0.62, -1.0, 0.72)
VIEW_ANGLE = 24.0
# Of the picture's width and height, left free for the drawing: right of it stands the scale, over it the title.
FRAME = ((0.03, 0.87), (0.03, 0.90))
# Heights of letters in pictures of 1600 x 1000 pixels.
TITLE_LETTERS, SCALE_LETTERS = 26, 22
# Drawn larger by this factor and averaged: Mesa's software renderer shows black through VTK's own FXAA.
SMOOTHING = 2


@dataclass
class Shades:
    """What the colours of the sand say."""

    values: np.ndarray  # [points]
    table: vtk.vtkLookupTable
    title: str
    labels: np.ndarray  # on the scale


@dataclass(frozen=True)
class View:
    """What pictures of a film have in common."""

    content: np.ndarray  # [n, 3], m: points that lie inside the frame
    displacement: float  # m, the end of the scale


def view_of(run, snapshots):
    """The View that all of `snapshots` fit into."""
    contents, displacements = [], [1e-3]
    for snapshot in snapshots:
        points, bodies = run.points(snapshot), run.bodies(snapshot)
        if points is None and bodies is None:
            raise RunError(f"{run.path / 'snapshots'}: snapshot {snapshot} has neither points nor bodies")
        contents.append(outline(points, bodies, run.shapes if bodies is not None else []))
        if points is not None:
            moved = np.linalg.norm(points.fields["displacement"], axis=1)
            displacements.append(float(np.percentile(moved, SCALE_PERCENTILE)) or float(moved.max()))
    return View(np.concatenate(contents), max(displacements[1:], default=0.0) or displacements[0])


def draw(run, snapshot, view, output, size, colour="displacement", remark=""):
    """Writes the picture of a snapshot to `output` (.png), `size` pixels wide and high; the sand by `colour`:
    "displacement" or "rank". `remark` stands behind the time."""
    points, bodies = run.points(snapshot), run.bodies(snapshot)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    renderer.SetBackground2(0.80, 0.86, 0.93)
    renderer.GradientBackgroundOn()
    add_lights(renderer)
    if points is not None:
        shades = shades_of_ranks(points) if colour == "rank" else shades_of_displacement(points, view.displacement)
        add_sand(renderer, points, shades, point_spacing(run.scene, points), size)
    shapes = run.shapes if bodies is not None else []
    if bodies is not None:
        add_bodies(renderer, bodies, shapes, len(run.scene.get("body", [])))
    time = (points or bodies).time
    add_title(renderer, f"{run.title}\nt = {time:.3f} s{remark}", size)
    aim(renderer, view.content, size)
    write(renderer, output, size)


def add_lights(renderer):
    kit = vtk.vtkLightKit()
    kit.SetKeyLightIntensity(0.85)
    kit.SetKeyToFillRatio(2.5)
    kit.AddLightsToRenderer(renderer)


def shades_of_displacement(points, largest):
    """Up to `largest` (m)."""
    moved = np.linalg.norm(points.fields["displacement"], axis=1)
    factor, unit = (1e3, "mm") if largest < 0.5 else (1.0, points.units["displacement"])
    end = round_end(largest * factor)
    table = lookup_table(colormaps[COLOURS](np.linspace(0.0, 1.0, 256)), 0.0, end)
    return Shades(moved * factor, table, f"displacement\n[{unit}]", np.linspace(0.0, end, 5))


def shades_of_ranks(points):
    if "rank" not in points.fields:
        raise RunError("--colour rank: this snapshot does not say which rank has a point")
    rank = points.fields["rank"]
    count = int(rank.max()) + 1
    colours = [to_rgba(RANK_COLOURS[index % len(RANK_COLOURS)]) for index in range(count)]
    return Shades(rank, lookup_table(colours, -0.5, count - 0.5), "rank", np.arange(float(count)))


def add_sand(renderer, points, shades, spacing, size):
    """Every point as a sphere as wide as its share of the sand."""
    data = vtk.vtkPolyData()
    data.SetPoints(vtk_points(points.position))
    scalars = numpy_to_vtk(np.ascontiguousarray(shades.values, dtype=np.float32), deep=True)
    scalars.SetName("shade")
    data.GetPointData().SetScalars(scalars)
    cells = vtk.vtkCellArray()
    count = len(shades.values)
    cells.SetData(id_array(np.arange(count + 1)), id_array(np.arange(count)))
    data.SetVerts(cells)

    mapper = vtk.vtkOpenGLSphereMapper()
    mapper.SetInputData(data)
    mapper.SetRadius(0.62 * spacing)
    mapper.SetLookupTable(shades.table)
    mapper.SetScalarRange(shades.table.GetRange())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    renderer.AddActor(actor)
    add_scale(renderer, shades, size)


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


def add_bodies(renderer, bodies, shapes, named):
    """Instances of every shape; the first `named` bodies are wheels, the others rocks."""
    is_rock = np.arange(len(bodies.shape)) >= named
    for index, shape in enumerate(shapes):
        for rocks, colour in ((False, WHEEL_COLOUR), (True, ROCK_COLOUR)):
            chosen = (bodies.shape == index) & (is_rock == rocks)
            if chosen.any():
                add_instances(renderer, shape, bodies, chosen, colour)


def add_instances(renderer, shape, bodies, chosen, colour):
    data = vtk.vtkPolyData()
    data.SetPoints(vtk_points(bodies.position[chosen]))
    for name, values in (("orientation", bodies.orientation[chosen]), ("scale", bodies.scale[chosen])):
        array = numpy_to_vtk(np.ascontiguousarray(values, dtype=np.float64), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)

    mapper = vtk.vtkGlyph3DMapper()
    mapper.SetInputData(data)
    mapper.SetSourceData(surface(shape))
    mapper.SetOrientationArray("orientation")
    mapper.SetOrientationModeToQuaternion()
    mapper.SetScaleArray("scale")
    mapper.SetScaleModeToScaleByMagnitude()
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*colour)
    actor.GetProperty().SetSpecular(0.25)
    actor.GetProperty().SetSpecularPower(20)
    renderer.AddActor(actor)


def surface(shape):
    """Mesh with normals, smooth but for its sharp edges."""
    data = vtk.vtkPolyData()
    data.SetPoints(vtk_points(shape.vertices))
    cells = vtk.vtkCellArray()
    count = len(shape.triangles)
    cells.SetData(id_array(3 * np.arange(count + 1)), id_array(shape.triangles.ravel()))
    data.SetPolys(cells)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetFeatureAngle(FEATURE_ANGLE)
    normals.Update()
    return normals.GetOutput()


def vtk_points(positions):
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, dtype=np.float64), deep=True))
    return points


def id_array(values):
    return numpy_to_vtkIdTypeArray(np.ascontiguousarray(values, dtype=np.int64), deep=True)


def add_scale(renderer, shades, size):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(shades.table)
    bar.SetTitle(shades.title)
    bar.UseCustomLabelsOn()
    bar.SetCustomLabels(numpy_to_vtk(shades.labels, deep=True))
    bar.SetLabelFormat("  %-.3g")
    bar.SetPosition(0.88, 0.18)
    bar.SetPosition2(0.10, 0.55)
    bar.SetBarRatio(0.25)
    bar.SetVerticalTitleSeparation(round(14 * size[1] / 1000))
    bar.UnconstrainedFontSizeOn()
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        plain(text, SCALE_LETTERS, size)
    renderer.AddActor2D(bar)


def add_title(renderer, text, size):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    plain(actor.GetTextProperty(), TITLE_LETTERS, size)
    actor.GetTextProperty().SetVerticalJustificationToTop()
    actor.GetTextProperty().SetLineSpacing(1.3)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(0.015, 0.98)
    renderer.AddActor2D(actor)


def plain(text, letters, size):
    text.SetFontFamilyToArial()
    text.SetFontSize(round(SMOOTHING * letters * min(size[1] / 1000, size[0] / 1600)))
    text.SetColor(*TEXT_COLOUR)
    text.BoldOff()
    text.ItalicOff()
    text.ShadowOff()


def outline(points, bodies, shapes):
    """Points, [n, 3], that the picture has to hold: corners of the sand's box and of every body's."""
    corner = np.array([(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    parts = []
    if points is not None:
        low, high = points.position.min(axis=0), points.position.max(axis=0)
        parts.append(low + corner * (high - low))
    if bodies is not None:
        boxes = np.array([(shape.vertices.min(axis=0), shape.vertices.max(axis=0)) for shape in shapes])[bodies.shape]
        local = boxes[:, None, 0] + corner * (boxes[:, None, 1] - boxes[:, None, 0])
        turned = rotated(bodies.orientation, local * bodies.scale[:, None, None])
        parts.append((bodies.position[:, None] + turned).reshape(-1, 3))
    return np.concatenate(parts)


def aim(renderer, content, size):
    """Turns the camera to the drawing and fits the points `content` into FRAME."""
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*VIEW_DIRECTION)
    camera.SetFocalPoint(0.0, 0.0, 0.0)
    camera.SetViewUp(0.0, 0.0, 1.0)
    camera.SetViewAngle(VIEW_ANGLE)
    renderer.ResetCamera()

    matrix = camera.GetCompositeProjectionTransformMatrix(size[0] / size[1], -1.0, 1.0)
    projection = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    seen = np.column_stack((content, np.ones(len(content)))) @ projection.T
    seen = seen[:, :2] / seen[:, 3:]  # -1 to 1 over the picture
    low, high = seen.min(axis=0), seen.max(axis=0)
    frame = 2 * np.array(FRAME) - 1
    zoom = ((frame[:, 1] - frame[:, 0]) / (high - low)).min()
    camera.Zoom(zoom)
    camera.SetWindowCenter(*(zoom * 0.5 * (low + high) - frame.mean(axis=1)))
    renderer.ResetCameraClippingRange()


def write(renderer, output, size):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(SMOOTHING * size[0], SMOOTHING * size[1])
    window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    mean = vtk.vtkImageShrink3D()
    mean.SetInputConnection(image.GetOutputPort())
    mean.SetShrinkFactors(SMOOTHING, SMOOTHING, 1)
    mean.MeanOn()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(output))
    writer.SetInputConnection(mean.GetOutputPort())
    writer.Write()
