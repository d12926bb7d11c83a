"""Quantities of wheels against time, several runs in a panel."""

from dataclasses import dataclass, field

import numpy as np

from tread_paper.history import UNITS, smoothed
from tread_post.style import COLOURS, DASHES, GREY, figure_grid, finish, legend_below, readable, with_unit


@dataclass(frozen=True)
class Panel:
    quantity: str  # of tread_paper.history.UNITS
    label: str
    smooth: float = 0.0  # s, of the means that are drawn
    lines: tuple = ()  # (value, label), across
    marks: tuple = ()  # times (s) that the paper names
    limits: dict = field(default_factory=dict)  # xlim, ylim, in the panel's units


def figure_of(title, histories, panels, columns=2, width=15.0, height_each=3.9):
    """`histories` are (label, [History of a run and of its repeats])."""
    rows = -(-len(panels) // columns)
    figure, axes = figure_grid(rows, columns, width, height_each)
    handles = [draw(axis, panel, histories) for axis, panel in zip(axes.flat, panels)][0]
    for axis in list(axes.flat)[len(panels):]:
        axis.remove()
    legend_below(figure, handles, min(len(handles), 3))
    figure.suptitle(title, fontsize=14)
    return figure


def draw(axis, panel, histories):
    """Draws a quantity, repeats as thin lines. Returns the line of each first run."""
    smooth = [(label, [(one.time, smoothed(one.time, one.series(panel.quantity), panel.smooth)) for one in repeats]) for label, repeats in histories]
    everything = np.concatenate([values for _, curves in smooth for _, values in curves] + [np.array([value for value, _ in panel.lines], float)])
    factor, unit = readable(everything, UNITS[panel.quantity])
    first = []
    for number, (label, curves) in enumerate(smooth):
        look = {"color": COLOURS[number % len(COLOURS)], "linestyle": DASHES[number // len(COLOURS)]}
        for place, (time, values) in enumerate(curves):
            lines = axis.plot(time, factor * values, linewidth=0.7 if place else 1.4, label=label, **look)
            first += [] if place else lines
    for (value, label), style in zip(panel.lines, ("--", ":", "-.")):
        axis.axhline(factor * value, color="#444444", linestyle=style, linewidth=1.1)
        axis.annotate(label, (0.99, factor * value), xycoords=axis.get_yaxis_transform(), ha="right", va="bottom", fontsize=9.5, color="#444444")
    for mark in panel.marks:
        axis.axvline(mark, color=GREY, linewidth=0.9, linestyle=(0, (2, 3)))
    axis.set(xlabel="time  [s]", ylabel=with_unit(panel.label, unit), **panel.limits)
    finish(axis)
    return first
