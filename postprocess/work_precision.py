#!/usr/bin/python3
"""Error against run time, points and memory, from the table of a study (`tread study`, docs/study.md): a plot with the Pareto front marked, the front as
a table, and the cheapest setting within a tolerance in a sentence.

Needs Debian's python3-numpy and python3-matplotlib.
"""

import argparse
import math
import sys
from pathlib import Path

from tread_post.fronts import cheapest_within, pareto_front, times_cheaper
from tread_post.run import RunError
from tread_post.study_table import read_study, short_name
from tread_post.style import COLOURS, GREY, MARKERS, figure_grid, finish, legend_below, plt, write

SMALLEST = 1e-8  # on a logarithmic axis


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("table", type=Path, metavar="STUDY.csv")
    parser.add_argument("--output", type=Path, metavar="FILE.png", help="default: beside the table, with its name")
    parser.add_argument("--within", type=float, default=0.05, metavar="SHARE", help="tolerance of the sentences; default 0.05")
    return parser.parse_args()


def cost(row):
    return row.wall_s


def error(row):
    return row.error


def candidates(rows):
    return [row for row in rows if row.is_candidate]


def sentence(rows, within):
    """Of one quantity: the cheapest setting within a tolerance, or why there is none to name."""
    name, choice = rows[0].quantity, candidates(rows)
    uncertainty, reference = rows[0].uncertainty, rows[0].reference
    known = known_text(uncertainty, reference)
    if not uncertainty <= within:
        return f"{name}: nothing can be said within {percent(within)}: {known}"
    found = cheapest_within(choice, within, cost, error)
    if found is None:
        best = min((row for row in choice if math.isfinite(row.error)), key=error, default=None)
        nearest = f"; the best of the others is off by {percent(best.error)} ({best.setting_text})" if best else ""
        return f"{name}: no variant is within {percent(within)}{nearest}; {known}"
    scatter = f"; perturbed repeats scatter by {percent(found.scatter)}" if found.scatter > 0 else ""
    return f"{name} within {percent(within)}: {found.setting_text}; {cheaper(found, choice)}; {known}{scatter}"


def known_text(uncertainty, reference):
    if math.isnan(uncertainty):
        return f"what is right is not known ({reference})"
    return f"against {reference}" if uncertainty == 0 else f"what is right is known to {percent(uncertainty)} ({reference})"


def sentence_of_all(study, within):
    """Of all quantities that can be told within the tolerance together; empty if they are fewer than two."""
    told = [name for name in study.quantities if study.of(name)[0].uncertainty <= within]
    if len(told) < 2:
        return ""
    rows = {name: {row.variant: row for row in candidates(study.of(name))} for name in told}
    worst = {row.variant: max(rows[name][row.variant].error for name in told) for row in rows[told[0]].values()}
    found = cheapest_within(list(rows[told[0]].values()), within, cost, lambda row: worst[row.variant])
    if found is None:
        return f"{', '.join(told)} together within {percent(within)}: no variant"
    return f"{', '.join(told)} together within {percent(within)}: {found.setting_text}; {cheaper(found, list(rows[told[0]].values()))}"


def cheaper(found, choice):
    dearest = max(choice, key=cost)
    if dearest.variant == found.variant:
        return "the dearest variant"
    return f"{times_cheaper(dearest.wall_s, found.wall_s)} times cheaper than the dearest ({found.wall_s:.3g} s against {dearest.wall_s:.3g} s)"


def percent(value):
    return f"{100 * value:.2g} %"


def print_front(rows):
    keys = list(rows[0].settings)
    print(f"\n{rows[0].quantity} [{rows[0].unit}]; right: {rows[0].right:.6g}, {rows[0].reference}")
    names = [short_name(key, keys) for key in keys]
    print("  ".join(["  variant", *(f"{name:>12}" for name in names), f"{'points':>9}", f"{'memory MB':>9}", f"{'wall s':>9}", f"{'measured':>11}", f"{'error':>9}"]))
    front = pareto_front(candidates(rows), cost, error)
    for row in sorted(rows, key=lambda row: (row.wall_s if math.isfinite(row.wall_s) else math.inf)):
        mark = "*" if row in front else " "
        told = row.repeat or (row.state if row.state != "done" else "")
        print("  ".join([f"{mark} {row.variant:<7}", *(f"{row.settings[key]:>12}" for key in keys), f"{row.points:>9.0f}", f"{row.memory_bytes / 1e6:>9.3g}",
                         f"{row.wall_s:>9.3g}", f"{row.measured:>11.5g}", f"{100 * row.error:>7.3g} %", told]).rstrip())


def figure_of(study, within):
    figure, axes = figure_grid((len(study.quantities) + 1) // 2, min(2, len(study.quantities)))
    looks = looks_of(study)
    for axis, name in zip(axes.flat, study.quantities):
        plot_panel(axis, study.of(name), looks, within)
    for axis in axes.flat[len(study.quantities):]:
        axis.set_axis_off()
    legend_below(figure, legend(looks), 4)
    return figure


def looks_of(study):
    """For each of the first three keys its values, in the order in which they come: colours, markers, and whether they are filled."""
    values = {key: list(dict.fromkeys(row.settings[key] for row in study.rows)) for key in study.keys}
    most_first = sorted(study.keys, key=lambda key: -len(values[key]))
    return [(key, values[key]) for key in most_first[:3]]


def look(row, looks):
    index = [values.index(row.settings[key]) for key, values in looks] + [0, 0, 0]
    colour = COLOURS[index[0] % len(COLOURS)]
    return {"marker": MARKERS[index[1] % len(MARKERS)], "edgecolors": colour, "facecolors": colour if index[2] == 0 else "none"}


def plot_panel(axis, rows, looks, within):
    shown = [row for row in candidates(rows) if math.isfinite(row.error)]
    for row in shown:
        axis.scatter(row.wall_s, max(row.error, SMALLEST), s=55, zorder=3, **look(row, looks))
    front = pareto_front(shown, cost, error)
    axis.step([row.wall_s for row in front], [max(row.error, SMALLEST) for row in front], where="post", color=GREY, linewidth=1.5, zorder=1)
    axis.axhline(within, color=GREY, linestyle=":", linewidth=1)
    axis.set(xscale="log", yscale="log", xlabel="wall time  [s]", ylabel=f"error of {rows[0].quantity}")
    if rows[0].uncertainty > SMALLEST:
        low, high = axis.get_ylim()
        axis.axhspan(min(low, rows[0].uncertainty), rows[0].uncertainty, color="#eeeeee", zorder=0)
        axis.set_ylim(min(low, rows[0].uncertainty), max(high, 1.2 * rows[0].uncertainty))
    finish(axis)


def legend(looks):
    handles = []
    for place, (key, values) in enumerate(looks):
        for index, value in enumerate(values):
            style = {"color": COLOURS[index % len(COLOURS)] if place == 0 else GREY, "marker": MARKERS[index % len(MARKERS)] if place == 1 else "o",
                     "markerfacecolor": "none" if place == 2 and index else None}
            handles.append(plt.Line2D([], [], linestyle="", label=f"{short_name(key, [name for name, _ in looks])} {value}",
                                      **{name: setting for name, setting in style.items() if setting}))
    handles.append(plt.Line2D([], [], color=GREY, label="Pareto front"))
    handles.append(plt.Line2D([], [], color=GREY, linestyle=":", label="tolerance"))
    handles.append(plt.Rectangle((0, 0), 1, 1, color="#eeeeee", label="within what is known"))
    return handles


def main():
    options = arguments()
    study = read_study(options.table)
    for line in study.comments:
        print(line)
    for name in study.quantities:
        print_front(study.of(name))
    print("\n* on the Pareto front of wall time and error\n")
    for name in study.quantities:
        print(sentence(study.of(name), options.within))
    together = sentence_of_all(study, options.within)
    if together:
        print(together)
    print()
    write(figure_of(study, options.within), options.output or options.table.with_suffix(".png"))


if __name__ == "__main__":
    try:
        main()
    except RunError as problem:
        sys.exit(f"work_precision: {problem}")
