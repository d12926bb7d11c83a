"""Quantities of wheels against time, several runs in a panel."""

from dataclasses import dataclass, field

import numpy as np

from tread_paper.history import UNITS, smoothed
from tread_post.style import COLOURS, GREY, figure_grid, finish, legend_below, readable, with_unit


@dataclass(frozen=True)
class Panel:
    quantity: str  # of tread_paper.history.UNITS
    label: str
    smooth: float = 0.0  # s, of the means that are drawn
    lines: tuple = ()  # (value, label), across
    marks: tuple = ()  # times (s) that the paper names
    limits: dict = field(default_factory=dict)  # xlim, ylim, in the panel's units


def figure_of(title, histories, panels, columns=2, width=15.0, height_each=3.9):
    """`histories` are (label, History)."""
    rows = -(-len(panels) // columns)
    figure, axes = figure_grid(rows, columns, width, height_each)
    for axis, panel in zip(axes.flat, panels):
        draw(axis, panel, histories)
    for axis in list(axes.flat)[len(panels):]:
        axis.remove()
    handles = [axes[0, 0].lines[number] for number in range(len(histories))]
    legend_below(figure, handles, min(len(handles), 4))
    figure.suptitle(title, fontsize=14)
    return figure


def draw(axis, panel, histories):
    drawn = [(label, history.time, smoothed(history.time, history.series(panel.quantity), panel.smooth)) for label, history in histories]
    everything = np.concatenate([values for _, _, values in drawn] + [np.array([value for value, _ in panel.lines], float)])
    factor, unit = readable(everything, UNITS[panel.quantity])
    for (label, time, values), colour in zip(drawn, COLOURS):
        axis.plot(time, factor * values, color=colour, linewidth=1.4, label=label)
    for (value, label), style in zip(panel.lines, ("--", ":", "-.")):
        axis.axhline(factor * value, color="#444444", linestyle=style, linewidth=1.1)
        axis.annotate(label, (0.99, factor * value), xycoords=axis.get_yaxis_transform(), ha="right", va="bottom", fontsize=9.5, color="#444444")
    for mark in panel.marks:
        axis.axvline(mark, color=GREY, linewidth=0.9, linestyle=(0, (2, 3)))
    axis.set(xlabel="time  [s]", ylabel=with_unit(panel.label, unit), **panel.limits)
    finish(axis)
