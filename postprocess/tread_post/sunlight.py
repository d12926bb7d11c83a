"""Soft shadows: the light of a sun and of a sky at every vertex, by depth maps from many directions."""

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from tread_post.vtk_data import normals_of, positions_of

LEFT, HEIGHT = np.radians((40.0, 45.0))  # where the sun stands: left of the camera as seen in plan, and over the horizon
SUN_RADIUS = 0.08  # rad; larger than the sun's, for shadows with soft edges
SUN_SAMPLES, SKY_SAMPLES = 16, 48
AMBIENT, SKY, DIRECT = 0.12, 0.42, 0.6
MAP = 1024  # texels across a depth map
OFFSET = 1.5  # texels along the normal, and towards the light, by which a vertex clears its own surface


def add_sunlit(renderer, parts, camera):
    """Adds meshes, each (vtkPolyData with normals, colours [v, 3] from 0 to 1), lit by the sky and by a sun behind the camera, in whose direction
    `camera` points."""
    shares = illuminance([data for data, _ in parts], sun_of(camera))
    for (data, colours), share in zip(parts, shares):
        shown = np.clip(255 * colours * share[:, None], 0, 255).astype(np.uint8)
        array = numpy_to_vtk(shown, deep=True)
        array.SetName("colour")
        data.GetPointData().SetScalars(array)
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(data)
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().LightingOff()
        renderer.AddActor(actor)


def sun_of(camera):
    """Unit vector towards the sun."""
    bearing = np.arctan2(camera[1], camera[0]) - LEFT
    return np.array((np.cos(HEIGHT) * np.cos(bearing), np.cos(HEIGHT) * np.sin(bearing), np.sin(HEIGHT)))


def illuminance(meshes, sun):
    """Light at each vertex of each mesh, [v]: about 1 on open level ground. `sun` is the unit vector towards it."""
    window, renderer = _depth_window(meshes)
    bounds = np.array(renderer.ComputeVisiblePropBounds()).reshape(3, 2)
    centre, radius = bounds.mean(axis=1), 0.5 * np.linalg.norm(np.ptp(bounds, axis=1))
    texel = 2 * radius / MAP
    normals = [normals_of(data) for data in meshes]
    places = [positions_of(data) + OFFSET * texel * normal - centre for data, normal in zip(meshes, normals)]
    totals = [np.full(len(place), AMBIENT) for place in places]
    for direction, weight in _samples(sun):
        depths = _depths(window, renderer, centre, radius, direction)
        for total, place, normal in zip(totals, places, normals):
            facing = np.maximum(normal @ direction, 0)
            total += weight * facing * _is_lit(depths, place / radius, direction)
    return totals


def _samples(sun):
    """(unit vector towards the light, weight of a surface that faces it)"""
    turn = np.pi * (3 - 5**0.5)  # golden angle: directions are spread evenly
    right, up, _ = _axes(sun)
    for index in range(SUN_SAMPLES):
        off, angle = SUN_RADIUS * ((index + 0.5) / SUN_SAMPLES) ** 0.5, index * turn
        yield _unit(sun + off * (np.cos(angle) * right + np.sin(angle) * up)), DIRECT / SUN_SAMPLES
    for index in range(SKY_SAMPLES):
        height, angle = (index + 0.5) / SKY_SAMPLES, index * turn
        level = (1 - height**2) ** 0.5
        yield np.array((level * np.cos(angle), level * np.sin(angle), height)), 2 * SKY / SKY_SAMPLES


def _unit(vector):
    return vector / np.linalg.norm(vector)


def _axes(direction):
    """Unit vectors right, up and towards the viewer."""
    right = _unit(np.cross((0.0, 1.0, 0.0) if abs(direction[2]) > 0.9 else (0.0, 0.0, 1.0), direction))
    return right, np.cross(direction, right), direction


def _depth_window(meshes):
    renderer = vtk.vtkRenderer()
    for data in meshes:
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(data)
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().LightingOff()
        renderer.AddActor(actor)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(MAP, MAP)
    window.AddRenderer(renderer)
    return window, renderer


def _depths(window, renderer, centre, radius, direction):
    """Depth map [up, right] seen from the light: 0 at `radius` before the centre, 1 behind it."""
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetParallelScale(radius)
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + 2 * radius * direction))
    camera.SetViewUp(*_axes(direction)[1])
    camera.SetClippingRange(radius, 3 * radius)
    window.Render()
    buffer = vtk.vtkFloatArray()
    window.GetZbufferData(0, 0, MAP - 1, MAP - 1, buffer)
    return vtk_to_numpy(buffer).reshape(MAP, MAP)


def _is_lit(depths, place, direction):
    """Whether nothing stands between places (of the radius, from the centre) and the light."""
    right, up, towards = _axes(direction)
    column = np.clip((0.5 * MAP * (1 + place @ right)).astype(int), 0, MAP - 1)
    row = np.clip((0.5 * MAP * (1 + place @ up)).astype(int), 0, MAP - 1)
    return 0.5 * (1 - place @ towards) <= depths[row, column] + OFFSET / MAP
