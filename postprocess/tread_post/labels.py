"""Names, lengths and arrows over a picture, at places of the world that it shows. `where` gives pixels [n, 2] of places [n, 3] (m)."""

import matplotlib.patheffects as effects
import numpy as np

INK, SIZE = "#222222", 13
HALO = [effects.withStroke(linewidth=3.0, foreground="white", alpha=0.85)]
DARK = [effects.withStroke(linewidth=3.0, foreground="#3A2F28", alpha=0.8)]
MOTION = "#0072B2"
ARC = np.radians(np.linspace(150, 40, 40))  # of an arrow that goes around an axle, over its top and forwards


def label(axis, where, text, at, to, align="left"):
    """A name that stands `to` (pixels right and up) from a place, with a line to it."""
    place = where([at])[0]
    line = {"arrowstyle": "-", "color": INK, "linewidth": 0.9, "shrinkA": 2, "shrinkB": 0, "relpos": (float(align == "right"), 0.5)}
    axis.annotate(text, place, (place[0] + to[0], place[1] - to[1]), ha=align, va="center", fontsize=SIZE, color=INK, path_effects=HALO, arrowprops=line,
                  annotation_clip=False)


def upon(axis, where, text, at):
    """A name on a dark face, at a place of it."""
    axis.text(*where([at])[0], text, ha="center", va="center", fontsize=SIZE, color="white", path_effects=DARK)


def length(axis, where, text, ends, to=(0, 0), align="center"):
    """A double arrow between two places and its length, `to` (pixels right and up) from the middle."""
    first, last = where(ends)
    axis.annotate("", first, last, arrowprops={"arrowstyle": "<|-|>", "color": INK, "linewidth": 1.1, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9},
                  annotation_clip=False)
    middle = 0.5 * (first + last)
    axis.text(middle[0] + to[0], middle[1] - to[1], text, ha=align, va="center", fontsize=SIZE, color=INK, path_effects=HALO)


def motion(axis, where, text, ends, to=(0, 0), align="center", colour=MOTION):
    """An arrow from one place to another and its name, `to` (pixels right and up) from its tip."""
    first, last = where(ends)
    axis.annotate("", last, first, arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 2.2, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 16},
                  annotation_clip=False)
    axis.text(last[0] + to[0], last[1] - to[1], text, ha=align, va="center", fontsize=SIZE, color=colour, path_effects=HALO)


def spin(axis, where, text, centre, radius, to=(0, 0), align="center"):
    """An arrow around an axle along y, forwards along x over its top, and its name, `to` (pixels right and up) from the arrow's middle."""
    arc = where(np.asarray(centre) + radius * np.stack((np.cos(ARC), 0 * ARC, np.sin(ARC)), axis=1))
    axis.plot(*arc[:-2].T, color=MOTION, linewidth=2.2)
    axis.annotate("", arc[-1], arc[-4], arrowprops={"arrowstyle": "-|>", "color": MOTION, "linewidth": 2.2, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 16},
                  annotation_clip=False)
    middle = arc[len(arc) // 2]
    axis.text(middle[0] + to[0], middle[1] - to[1], text, ha=align, va="center", fontsize=SIZE, color=MOTION, path_effects=HALO)
