"""The ladder's figure: each quantity against the spacing, with its reference and its limit."""

import math

from tread_post.style import COLOURS, MARKERS, figure_grid, finish, png_of, with_unit

COLUMNS = 4


def draw(path, rows):
    """A panel a quantity of a problem."""
    panels = {}
    for row in rows:
        panels.setdefault((row.problem, row.quantity), []).append(row)
    figure, axes = figure_grid(math.ceil(len(panels) / COLUMNS), COLUMNS, width=18.0, height_each=3.6)
    for axis, ((problem, quantity), part) in zip(axes.flat, panels.items()):
        axis.plot([1e3 * row.spacing for row in part], [row.value for row in part], MARKERS[0] + "-", color=COLOURS[0], label="runs")
        if not math.isnan(part[0].reference):
            axis.axhline(part[0].reference, color=COLOURS[1], linestyle="--", label=f"reference, {part[0].kind}")
        if not math.isnan(part[0].limit):
            axis.plot(0, part[0].limit, MARKERS[1], color=COLOURS[2], label=f"limit, order {part[0].order:.2g}")
        axis.set(title=problem.replace("_", " "), xlabel="h  [mm]", ylabel=with_unit(quantity.replace("_", " "), part[0].unit), xlim=(0, None))
        axis.legend(fontsize=8)
        finish(axis)
    for axis in list(axes.flat)[len(panels):]:
        axis.set_visible(False)
    path.write_bytes(png_of(figure, 90))
