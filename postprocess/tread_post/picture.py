"""Draws a snapshot with VTK. Needs a display."""

from dataclasses import dataclass, replace

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from tread_post.camera import VIEWS, aim, around, outline
from tread_post.canvas import add_lights, add_scale, add_title, empty_picture, mesh_actor, write
from tread_post.detail import choose_levels, levels_of
from tread_post.geometry import point_spacings
from tread_post.run import RunError
from tread_post.sand import beads, shaded, shades_of, surface_of
from tread_post.sunlight import add_sunlit
from tread_post.surfaces import mesh_of
from tread_post.vtk_data import smooth_surface

WHEEL_COLOUR = (0.78, 0.79, 0.82)
ROCK_COLOUR = (0.62, 0.47, 0.38)
FLOOR_COLOUR = (0.86, 0.85, 0.82)
FLOOR_CELLS = 200  # along the longer side: shadows fall on its vertices
# Triangles of all rocks, at most: more are smaller than pixels.
ROCK_TRIANGLES = 250_000
# The largest displacements are those of single grains thrown about: they do not stretch the scale.
SCALE_PERCENTILE = 99.5


@dataclass(frozen=True)
class Look:
    """How a picture shows a snapshot."""

    colour: str = "displacement"  # of the sand: "displacement", "rank" or "plain"
    sand: str = "beads"  # or "surface"
    light: str = "lamps"  # or "sun", with soft shadows; of sand as a surface
    view: str = "oblique"  # of camera.VIEWS
    backdrop: str = "sky"  # or "white"
    cut: tuple[int, float] | None = None  # axis and place (m) of a plane: sand and rocks on the camera's side are left out


@dataclass(frozen=True)
class View:
    """What pictures of a film have in common."""

    content: np.ndarray  # [n, 3], m: points that lie inside the frame
    displacement: float  # m, the end of the scale


def view_of(run, snapshots, look=Look()):
    """The View that all of `snapshots` fit into."""
    contents, displacements = [], [1e-3]
    for snapshot in snapshots:
        points, bodies = shown(run, snapshot, look)
        contents.append(outline(points, bodies, run.shapes if bodies is not None else []))
        if points is not None and len(points.position):
            moved = np.linalg.norm(points.fields["displacement"], axis=1)
            displacements.append(float(np.percentile(moved, SCALE_PERCENTILE)) or float(moved.max()))
    return View(np.concatenate(contents), max(displacements[1:], default=0.0) or displacements[0])


def views_around(run, snapshots, row, view):
    """A View for each of the snapshots, of what is around the body of a row; its scale is that of `view`."""
    shapes, views = run.shapes, []
    for snapshot in snapshots:
        bodies = run.bodies(snapshot)
        if bodies is None:
            raise RunError(f"{run.path / 'snapshots'}: snapshot {snapshot} has no bodies to follow")
        views.append(replace(view, content=around(bodies, row, shapes)))
    return views


def shown(run, snapshot, look):
    """Points and bodies of a snapshot, without what is before the cut; None where there are none."""
    points, bodies = run.points(snapshot), run.bodies(snapshot)
    if points is None and bodies is None:
        raise RunError(f"{run.path / 'snapshots'}: snapshot {snapshot} has neither points nor bodies")
    if look.cut is None:
        return points, bodies
    if points is not None:
        points = rows_of(points, _is_behind(points.position, look))
    if bodies is not None:
        bodies = rows_of(bodies, _is_behind(bodies.position, look) | (np.arange(len(bodies.shape)) < len(run.scene.get("body", []))))
    if not any(len(table.position) for table in (points, bodies) if table is not None):
        raise RunError(f"{run.path / 'snapshots'}: in snapshot {snapshot} nothing lies behind the cut")
    return points, bodies


def _is_behind(position, look):
    axis, at = look.cut
    return position[:, axis] <= at if VIEWS[look.view][axis] > 0 else position[:, axis] >= at


def rows_of(table, kept):
    """The rows of Points or Bodies that are kept."""
    columns = {name: values[kept] for name, values in vars(table).items() if isinstance(values, np.ndarray)}
    return replace(table, **columns, fields={name: values[kept] for name, values in table.fields.items()})


def draw(run, snapshot, view, output, size, look=Look(), remark=""):
    """Writes the picture of a snapshot to `output` (.png), `size` pixels wide and high. `remark` stands behind the time."""
    points, bodies = shown(run, snapshot, look)
    renderer = empty_picture(look.backdrop)
    fill(renderer, run, points, bodies, look, view.displacement, size, with_floor=points is None)
    add_title(renderer, f"{run.title}\nt = {(points or bodies).time:.3f} s{remark}", size)
    aim(renderer, view.content, size, look.view)
    write(renderer, output, size)


def fill(renderer, run, points, bodies, look, largest, size, with_floor):
    """Adds sand, bodies, their light and the scale, which ends at a displacement of `largest` (m), to the renderer of a picture."""
    meshes, sand = list(body_meshes(run, bodies)) if bodies is not None else [], None
    if with_floor:
        meshes += floor_meshes(run)
    if points is not None and len(points.position):
        shades, spacings = shades_of(points, look.colour, largest), point_spacings(run.scene, points)
        if look.sand == "surface":
            sand = surface_of(points.position, shades.values, spacings, sand_box(run, look)), shades
        else:
            renderer.AddActor(beads(points.position, shades, spacings))
        if shades.title:
            add_scale(renderer, shades, size)
    if look.light == "lamps":
        add_lamplit(renderer, meshes, sand)
    else:
        add_under_sun(renderer, meshes, sand, VIEWS[look.view])


def sand_box(run, look):
    """Box, [2, 3] (m), on whose sides the sand is cut off: the domain, as far as it is shown."""
    box = np.array([(0.0, 0.0, 0.0), run.scene["domain"]["size"]])
    if look.cut is not None:
        axis, at = look.cut
        box[int(VIEWS[look.view][axis] > 0), axis] = at
    return box


def body_meshes(run, bodies):
    """(mesh with normals, its colour) of the bodies of [[body]] tables, and of the rocks."""
    levels = [levels_of(shape) for shape in run.shapes]
    named = min(len(run.scene.get("body", [])), len(bodies.shape))
    for rows, most, colour in ((np.arange(named), np.inf, WHEEL_COLOUR), (np.arange(named, len(bodies.shape)), ROCK_TRIANGLES, ROCK_COLOUR)):
        if len(rows):
            mesh = mesh_of(bodies, rows, levels, choose_levels(levels, bodies, rows, most))
            yield smooth_surface(mesh.vertices, mesh.triangles), colour


def floor_meshes(run):
    """(mesh, colour) of the domain's floor; none where it is open."""
    domain = run.scene["domain"]
    if domain.get("walls", {}).get("bottom") == "open":
        return []
    cells = np.maximum(np.rint(FLOOR_CELLS * np.array(domain["size"][:2]) / max(domain["size"][:2])), 1).astype(int)
    lines = [np.linspace(0, length, count + 1) for length, count in zip(domain["size"], cells)]
    vertices = np.stack([*np.meshgrid(*lines, indexing="ij"), np.zeros(cells + 1)], axis=-1).reshape(-1, 3)
    across = cells[1] + 1
    first = (np.arange(cells[0])[:, None] * across + np.arange(cells[1])).ravel()
    triangles = np.concatenate([np.stack(corners, axis=1) for corners in
                                ((first, first + across, first + 1), (first + 1, first + across, first + across + 1))])
    return [(smooth_surface(vertices, triangles), FLOOR_COLOUR)]


def add_lamplit(renderer, meshes, sand):
    add_lights(renderer)
    for data, colour in meshes:
        actor = mesh_actor(data)
        actor.GetProperty().SetColor(*colour)
        actor.GetProperty().SetSpecular(0.25)
        actor.GetProperty().SetSpecularPower(20)
        renderer.AddActor(actor)
    if sand is not None:
        surface, shades = sand
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(surface)
        renderer.AddActor(shaded(mapper, shades))


def add_under_sun(renderer, meshes, sand, camera):
    parts = [(data, np.broadcast_to(np.array(colour), (data.GetNumberOfPoints(), 3))) for data, colour in meshes]
    if sand is not None:
        surface, shades = sand
        colours = shades.table.MapScalars(surface.GetPointData().GetArray("shade"), vtk.VTK_COLOR_MODE_MAP_SCALARS, 0)
        parts.append((surface, vtk_to_numpy(colours)[:, :3] / 255))
    add_sunlit(renderer, parts, camera)
