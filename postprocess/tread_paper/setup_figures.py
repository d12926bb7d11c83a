"""Draws the set-ups of setups.py with VTK, and names their parts and lengths. Needs a display."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from tread_paper.stills import SPEEDS, everything, lone, speeds, still
from tread_post.labels import INK, label, length, motion, spin, upon
from tread_post.style import figure_grid

CLOSE_TO_SPHERES = np.array([(0.15, 0, 0.02), (1.25, 0, 0.57)])  # m, of Fig. 7 a
OPENED = "near half: rocks alone"
OUT = 0.06  # m, by which lengths stand off the edges that they belong to


def collision(runs):
    """Fig. 7 a: the first state, that in which the spheres are closest, and the last."""
    made, = runs
    run, ball = made.run, made.scene["body"][0]
    radius = 0.5 * ball["diameter"]
    closest = min(run.snapshots, key=lambda number: np.ptp([middle[0] for middle in _middles(run, number)]))
    figure, axes = figure_grid(3, 1, 9.0, 3.7)
    for axis, number in zip(axes.flat, (run.snapshots[0], closest, run.snapshots[-1])):
        points, bodies = run.points(number), run.bodies(number)
        # The first state is that before the body is let go with its velocity.
        of_ball = bodies.fields["velocity"][0, 0] if points.time > 0 else ball["velocity"][0]
        pixels, where = speeds(run, number, CLOSE_TO_SPHERES, (1100, 550), of_ball, 1.0)
        _show(axis, pixels, f"t = {1e3 * points.time:.1f} ms")
        for middle, speed in zip(_middles(run, number), (of_ball, points.fields["velocity"][:, 0].mean())):
            tail = middle - (0.08 * speed, 0, radius + 0.03)
            motion(axis, where, "", (tail, tail + (0.16 * speed, 0, 0)), colour=INK)
            motion(axis, where, f"{speed:+.2f} m/s", (middle - (0, 0, radius + 0.03),) * 2, (0, -26), colour=INK)
        if number == run.snapshots[0]:
            _name_spheres(axis, where, _middles(run, number), radius, len(points.position))
    figure.colorbar(ScalarMappable(Normalize(-1, 1), SPEEDS), ax=axes, label="speed along x  [m/s]", shrink=0.5, aspect=30)
    return figure


def _middles(run, number):
    """Centres (m) of the body and of the points."""
    return run.bodies(number).position[0], run.points(number).position.mean(axis=0)


def _name_spheres(axis, where, middles, radius, points):
    ball, sphere = middles
    label(axis, where, f"DEM sphere,\nrigid, {2 * radius:g} m", ball + (-0.7 * radius, 0, 0.7 * radius), (-30, 25), "right")
    label(axis, where, f"elastic sphere, {2 * radius:g} m,\n{points:,} material points", sphere + (0.7 * radius, 0, 0.7 * radius), (30, 25))
    up = (0, 0, radius + 0.02)
    length(axis, where, f"{sphere[0] - ball[0]:g} m", (ball + up, sphere + up), (0, 18))


def drops(runs):
    """Fig. 9: beds of rocks, of sand, and of both, under the wheel; and the rock."""
    figure, axes = figure_grid(2, 2, 14.0, 5.9)
    content, size = _content(runs), (840, 700)
    for axis, made, title in zip(axes.flat, runs, ("(a) rocks", "(b) sand", f"(c) sand with rocks; {OPENED}")):
        _fall(axis, _bed(axis, made, title, content, size), made)
    rock, diameter = runs[0].run.shapes[1], runs[0].scene["rocks"][0]["diameter"]
    pixels, _ = lone(rock, size)
    extent = " x ".join(f"{1e3 * diameter * size:.1f}" for size in np.ptp(rock.vertices, axis=0))
    _show(axes[1, 1], pixels, f"the rock of (a) and (c): {extent} mm")
    return figure


def rolls(runs):
    """Fig. 12: the wheel over beds of spheres, of irregular rocks, of sand, and of sand with rocks."""
    figure, axes = figure_grid(2, 2, 14.0, 6.9)
    content = _content(runs)
    titles = ("(a) spheres", "(b) irregular rocks", "(c) sand", f"(d) sand with rocks; {OPENED}")
    for axis, made, title in zip(axes.flat, runs, titles):
        _fall(axis, _bed(axis, made, title, content, (760, 740)), made)
    return figure


def slips(runs):
    """Fig. 15: the wheel on sand, and on sand with rocks."""
    figure, axes = figure_grid(1, 2, 15.0, 6.0)
    content = _content(runs)
    for axis, made, title in zip(axes.flat, runs, ("sand", f"sand with rocks; {OPENED}")):
        _drive(axis, _bed(axis, made, f"{title}; gravity {_gravity(made)}", content, (900, 700)), made)
    return figure


def crust(runs):
    """Fig. 20: the wheel on a strip of rocks on sand."""
    figure, axes = figure_grid(1, 1, 11.0, 7.4)
    made, = runs
    _drive(axes[0, 0], _bed(axes[0, 0], made, f"gravity {_gravity(made)}", _content(runs), (1100, 740)), made)
    return figure


def _content(runs):
    """Points [n, 3] (m) that hold all runs' states, so that their pictures have one scale."""
    return np.concatenate([everything(made.run, made.run.snapshots[0]) for made in runs])


def _show(axis, pixels, title):
    axis.imshow(pixels, interpolation="antialiased")
    axis.set_axis_off()
    axis.set_title(title, fontsize=14, loc="left")


def _box(tables):
    """Box [2, 3] (m) that the regions of a scene's tables fill together."""
    boxes = np.array([table["region"]["box"] for table in tables], float)
    return np.stack((boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)))


def _bed(axis, made, title, content, size):
    """Draws the first state, and names the bed's parts, its lengths and the wheel. Returns `where`."""
    run, sand, rocks = made.run, made.scene.get("terrain", []), made.scene.get("rocks", [])
    low, high = _box(sand or rocks)
    mixed = bool(sand) and any(table["placement"] != "rain" for table in rocks)
    face = 0.5 * (low[1] + high[1]) if mixed else low[1]
    pixels, where = still(run, run.snapshots[0], content, size, face if mixed else None)
    _show(axis, pixels, title)
    near = (0.5 * (low[0] + high[0]), face, 0.5 * (low[2] + high[2]))
    upon(axis, where, f"sand: {len(run.points(run.snapshots[0]).position):,} points" if sand else _named(run, rocks[0]), near)
    for number, table in enumerate(rocks if sand else []):
        layer = _box([table])
        text = _named(run, table) + ("" if np.allclose(layer, (low, high)) else ",\nin {:.3g} x {:.3g} x {:.2g} m".format(*np.ptp(layer, axis=0)))
        label(axis, where, text, layer[0] + (1.0, 0.45, 0.7) * (layer[1] - layer[0]), (25, 70 + 60 * number))
    _lengths(axis, where, low, high)
    centre, radius, half = wheel_of(run)
    label(axis, where, "wheel", centre + (-0.7 * radius, half, 0.7 * radius), (-40, 20), "right")
    return where


def _named(run, table):
    kind = "spheres" if run.shapes[-1].name == "sphere" else "rocks"
    return f"{table['count']:,} {kind} of {1e3 * table['diameter']:g} mm"


def _lengths(axis, where, low, high):
    """A bed's lengths along the edges that the oblique view shows."""
    (x, y, z), (far_x, far_y, top) = low, high
    for ends, to, align in ((((x, y - OUT, z), (far_x, y - OUT, z)), (22, -14), "left"), (((x - OUT, y, z), (x - OUT, far_y, z)), (-10, -16), "right"),
                            (((far_x + OUT, y, z), (far_x + OUT, y, top)), (10, 0), "left")):
        length(axis, where, f"{np.ptp(ends, axis=0).max():.3g} m", ends, to, align)


def wheel_of(run):
    """Centre [3], radius over the grousers and half of the width (m) of a run's wheel."""
    bodies = run.bodies(run.snapshots[0])
    vertices = run.shapes[bodies.shape[0]].vertices * bodies.scale[0]
    return bodies.position[0], float(np.hypot(vertices[:, 0], vertices[:, 2]).max()), float(vertices[:, 1].max())


def _fall(axis, where, made):
    """Names the height from which the wheel falls."""
    (x, y, z), radius, half = wheel_of(made.run)
    top = _box([*made.scene.get("terrain", []), *made.scene.get("rocks", [])])[1, 2]
    length(axis, where, f"{z - radius - top:.2f} m", ((x, y, z - radius), (x, y, top)), (12, 0), "left")


def _drive(axis, where, made):
    """Names how the wheel is driven."""
    drive = next(phase["drive"] for phase in made.scene["phase"] if "drive" in phase)
    centre, radius, half = wheel_of(made.run)
    spin(axis, where, f"{drive['angular_velocity']:g} rad/s", centre - (0, half, 0), 0.75 * radius, (0, -26))
    if "slip" in drive:
        speed = (1 - drive["slip"]) * drive["angular_velocity"] * radius
        motion(axis, where, f"{speed:.3f} m/s, slip {drive['slip']:g}", (centre + (1.1 * radius, 0, 0), centre + (1.8 * radius, 0, 0)), (0, 22))


def _gravity(made):
    return f"{-made.scene['domain']['gravity'][2]:g} m/s²"
