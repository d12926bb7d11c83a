"""The figure of a set: measured points, tread with the error of its grid and the band of what is assumed, and theories."""

import numpy as np

from tread_post.style import COLOURS, figure_grid, finish, legend_below, with_unit
from tread_validation.compare import tread_answers
from tread_validation.tables import SHOWN

LINES = {"resistive force theory": ("--", COLOURS[2]), "Wong and Reece": (":", COLOURS[3])}


def figure_of(measured_set, rows, theories):
    """A panel for each curve (down) and quantity (across); `theories`: of all_predictions."""
    figure, axes = figure_grid(len(measured_set.curves), len(measured_set.quantities), 5.2 * len(measured_set.quantities), 4.2)
    for line, curve in zip(axes, measured_set.curves):
        for axis, quantity in zip(line, measured_set.quantities):
            _panel(axis, measured_set, curve, quantity, rows, theories[measured_set.name, curve.name])
    handles = {label: handle for axis in axes.flat for handle, label in zip(*axis.get_legend_handles_labels())}
    legend_below(figure, list(handles.values()), 3)
    figure.suptitle(measured_set.title, fontsize=14)
    return figure


def _panel(axis, measured_set, curve, quantity, rows, theories):
    label, factor, unit, _ = SHOWN[quantity]
    places = curve.measured.column(measured_set.against)
    # A locked wheel has no slip, and what is pushed more than twice as fast as it rolls would squeeze all else.
    shown = np.isfinite(places) & (places >= -1.0)
    order = np.flatnonzero(shown)[np.argsort(places[shown])]
    x = places[order]
    for name, theory in theories.items():
        dashes, colour = LINES[name]
        band = theory[quantity]
        axis.fill_between(x, factor * band.low[order], factor * band.high[order], color=colour, alpha=0.15, linewidth=0)
        axis.plot(x, factor * band.value[order], dashes, color=colour, linewidth=1.6, label=name)
    answers = tread_answers(measured_set, curve, quantity, rows)
    if np.isfinite(answers.value).any():
        axis.fill_between(x, factor * answers.low[order], factor * answers.high[order], color=COLOURS[0], alpha=0.2, linewidth=0,
                          label="tread: what is assumed, varied")
        axis.errorbar(x, factor * answers.value[order], factor * np.nan_to_num(answers.grid[order]), color=COLOURS[0], marker="o", capsize=3,
                      linewidth=1.4, label="tread, with the estimated error of its grid")
    axis.errorbar(x, factor * curve.measured.column(quantity)[order], factor * np.nan_to_num(curve.measured.column(f"{quantity}_spread")[order]),
                  color="black", marker="s", capsize=3, linestyle="none", label="measured, with its scatter where the source gives it")
    axis.set(xlabel=with_unit("slope", "degrees") if measured_set.against == "slope" else "slip", ylabel=with_unit(label, unit or "1"),
             title=curve.name)
    finish(axis)
