"""Pictures of single states without letters, and where their camera sees a place. Needs VTK and a display."""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import vtk
from matplotlib import colormaps

from tread_post.camera import VIEWS, aim, outline, seen_from
from tread_post.canvas import add_lights, empty_picture, mesh_actor, write
from tread_post.geometry import point_spacings
from tread_post.occlusion import seen_rows
from tread_post.picture import Look, body_meshes, fill, rows_of, shown
from tread_post.sand import Shades, beads, lookup_table
from tread_post.vtk_data import smooth_surface

FRAME = ((0.02, 0.98), (0.02, 0.98))
HIDING = 20_000  # rocks, of which more are sorted out before they are drawn
SPEEDS = "coolwarm"
ROCK = (0.62, 0.47, 0.38)


def still(run, number, content, size, open_at=None):
    """Pixels of a snapshot, and `where`: the pixels [n, 2] of places [n, 3] (m). The points `content` [m, 3] fill the picture, `size` pixels. Sand on the
    near side of the plane y = `open_at` (m) is left out, its rocks are not."""
    look = Look("plain", "surface", "sun", backdrop="white", cut=None if open_at is None else (1, open_at))
    points, bodies = shown(run, number, look)
    if open_at is not None:
        bodies = run.bodies(number)
    renderer = empty_picture(look.backdrop)
    aim(renderer, content, size, look.view, FRAME)
    fill(renderer, run, points, _in_sight(renderer, run, bodies, size), look, 0.0, size, with_floor=points is None or open_at is not None)
    return _taken(renderer, size)


def _in_sight(renderer, run, bodies, size):
    """The bodies without the rocks that stand behind others."""
    named = len(run.scene.get("body", []))
    if bodies is None or len(bodies.shape) - named < HIDING:
        return bodies
    places = bodies.position[named:]
    radius = 0.5 * bodies.scale[named:].mean()
    right = np.cross(VIEWS[Look.view], (0, 0, 1))
    aspect = np.array((size[0] / size[1], 1.0))
    seen, beside = (seen_from(renderer, at, size) for at in (places, places + radius * right / np.linalg.norm(right)))
    apart = float(np.median(np.linalg.norm((beside - seen)[:, :2] * aspect, axis=1)))
    return rows_of(bodies, np.concatenate((np.arange(named), named + seen_rows(seen[:, :2] * aspect, seen[:, 2], apart))))


def speeds(run, number, content, size, of_body, largest):
    """Like `still`, from the side and with a bead for each point, in the colours of speeds along x up to `largest` m/s; `of_body` is the body's."""
    look = Look(view="side", backdrop="white")
    points, bodies = shown(run, number, look)
    renderer = empty_picture(look.backdrop)
    add_lights(renderer)
    table = lookup_table(colormaps[SPEEDS](np.linspace(0, 1, 256)), -largest, largest)
    renderer.AddActor(beads(points.position, Shades(points.fields["velocity"][:, 0], table, "", np.zeros(0)), point_spacings(run.scene, points)))
    for mesh, _ in body_meshes(run, bodies):
        actor = mesh_actor(mesh)
        actor.GetProperty().SetColor(*colormaps[SPEEDS](0.5 + 0.5 * of_body / largest)[:3])
        renderer.AddActor(actor)
    aim(renderer, content, size, look.view, FRAME)
    return _taken(renderer, size)


def lone(shape, size):
    """Like `still`, of one shape at scale 1."""
    renderer = empty_picture("white")
    add_lights(renderer)
    actor = mesh_actor(smooth_surface(shape.vertices, shape.triangles))
    actor.GetProperty().SetColor(*ROCK)
    renderer.AddActor(actor)
    aim(renderer, shape.vertices, size, "oblique", ((0.2, 0.8), (0.2, 0.8)))
    return _taken(renderer, size)


def everything(run, number):
    """Points [n, 3] (m) that hold all of a snapshot."""
    return outline(run.points(number), run.bodies(number), run.shapes)


def _taken(renderer, size):
    renderer.ResetCameraClippingRange()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "still.png"
        write(renderer, path, size)
        pixels = plt.imread(path)
    return pixels, lambda places: (seen_from(renderer, np.asarray(places, float), size)[:, :2] * (1, -1) + 1) * 0.5 * np.array(size)
