#!/usr/bin/python3
"""Error against run time, points and memory, from the table of a study (`tread study`, docs/study.md): a plot with the Pareto front marked, the front as
a table, the cheapest setting within a tolerance in a sentence, and the order of convergence with the extrapolated value.

Needs Debian's python3-numpy and python3-matplotlib.
"""

import argparse
import math
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

from tread_post.fronts import cheapest_within, pareto_front, times_cheaper
from tread_post.orders import order_sentences
from tread_post.run import RunError
from tread_post.study_table import read_study, short_name
from tread_post.style import COLOURS, GREY, MARKERS, figure_grid, finish, legend_below, plt, write

SMALLEST = 1e-8  # on a logarithmic axis


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("table", type=Path, metavar="STUDY.csv")
    parser.add_argument("--output", type=Path, metavar="FILE.png", help="default: beside the table, with its name")
    parser.add_argument("--against", choices=COSTS, default="time", help="what fronts, picture and sentences count as cost; default time")
    parser.add_argument("--within", type=float, default=0.05, metavar="SHARE", help="tolerance of the sentences; default 0.05")
    return parser.parse_args()


@dataclass(frozen=True)
class Cost:
    label: str
    of: Callable  # of a Row
    unit: str


COSTS = {"time": Cost("wall time", lambda row: row.wall_s, "s"), "points": Cost("points", lambda row: row.points, ""),
         "memory": Cost("memory", lambda row: row.memory_bytes / 1e6, "MB")}


def error(row):
    return row.error


def candidates(rows):
    return [row for row in rows if row.is_candidate]


def sentence(rows, within, cost=COSTS["time"]):
    """Names the cheapest setting within a tolerance of one quantity, or says why there is none."""
    name, choice = rows[0].quantity, candidates(rows)
    uncertainty, reference = rows[0].uncertainty, rows[0].reference
    known = known_text(uncertainty, reference)
    if not uncertainty <= within:
        return f"{name}: nothing can be said within {percent(within)}: {known}"
    found = cheapest_within(choice, within, cost.of, error)
    if found is None:
        best = min((row for row in choice if math.isfinite(row.error)), key=error, default=None)
        nearest = f"; the best of the others is off by {percent(best.error)} ({best.setting_text})" if best else ""
        return f"{name}: no variant is within {percent(within)}{nearest}; {known}"
    scatter = f"; perturbed repeats scatter by {percent(found.scatter)}" if found.scatter > 0 else ""
    verdict = f"; the run calls itself {found.verdict}" if found.verdict not in ("", "resolved") else ""
    return f"{name} within {percent(within)}: {found.setting_text}; {cheaper(found, choice, cost)}; {known}{scatter}{verdict}"


def known_text(uncertainty, reference):
    if math.isnan(uncertainty):
        return f"what is right is not known ({reference})"
    return f"against {reference}" if uncertainty == 0 else f"what is right is known to {percent(uncertainty)} ({reference})"


def sentence_of_all(study, within, cost=COSTS["time"]):
    """Names the cheapest setting within the tolerance of all quantities together that can reach it; empty if they are fewer than two."""
    told = [name for name in study.quantities if study.of(name)[0].uncertainty <= within]
    if len(told) < 2:
        return ""
    rows = {name: {row.variant: row for row in candidates(study.of(name))} for name in told}
    worst = {row.variant: max(rows[name][row.variant].error for name in told) for row in rows[told[0]].values()}
    found = cheapest_within(list(rows[told[0]].values()), within, cost.of, lambda row: worst[row.variant])
    if found is None:
        return f"{', '.join(told)} together within {percent(within)}: no variant"
    return f"{', '.join(told)} together within {percent(within)}: {found.setting_text}; {cheaper(found, list(rows[told[0]].values()), cost)}"


def cheaper(found, choice, cost):
    dearest = max(choice, key=cost.of)
    if dearest.variant == found.variant:
        return "the dearest variant"
    amounts = " against ".join(f"{cost.of(row):.3g} {cost.unit}".rstrip() for row in (found, dearest))
    return f"{times_cheaper(cost.of(dearest), cost.of(found))} times cheaper than the dearest ({amounts})"


def percent(value):
    return f"{100 * value:.2g} %"


def print_table(rows, cost):
    keys = list(rows[0].settings)
    print(f"\n{rows[0].quantity} [{rows[0].unit}]; right: {rows[0].right:.6g}, {rows[0].reference}")
    names = [short_name(key, keys) for key in keys]
    widths = [max(len(name), *(len(row.settings[key]) for row in rows)) for name, key in zip(names, keys)]
    print("  ".join(["  variant", *(name.rjust(width) for name, width in zip(names, widths)), "   points", "memory MB", "   wall s", "   measured", "    error"]))
    front = pareto_front(candidates(rows), cost.of, error)
    for row in sorted(rows, key=lambda row: (row.wall_s if math.isfinite(row.wall_s) else math.inf)):
        mark = "*" if row in front else " "
        told = row.repeat or (row.state if row.state != "done" else row.verdict)
        print("  ".join([f"{mark} {row.variant:<7}", *(row.settings[key].rjust(width) for key, width in zip(keys, widths)), f"{row.points:>9.0f}",
                         f"{row.memory_bytes / 1e6:>9.3g}", f"{row.wall_s:>9.3g}", f"{row.measured:>11.5g}", f"{100 * row.error:>7.3g} %", told]).rstrip())


def figure_of(study, within, cost):
    figure, axes = figure_grid((len(study.quantities) + 1) // 2, min(2, len(study.quantities)))
    looks = star_looks(study) or grid_looks(study)
    for axis, name in zip(axes.flat, study.quantities):
        plot_panel(axis, study.of(name), looks, within, cost)
    for axis in axes.flat[len(study.quantities):]:
        axis.set_axis_off()
    legend_below(figure, looks.handles + common_handles(), 4)
    return figure


@dataclass(frozen=True)
class Looks:
    marker: Callable  # of a Row: how it is drawn
    label: Callable  # of a Row: what stands beside it
    handles: list  # of the legend


def star_looks(study):
    """Returns the looks of variants that differ from the usual ones in one key at most: a colour for each key, its value as label; None for others."""
    rows = candidates(study.rows)
    usual = {key: Counter(row.settings[key] for row in rows).most_common(1)[0][0] for key in study.keys}
    differing = {row.variant: [key for key in study.keys if row.settings[key] != usual[key]] for row in rows}
    if not rows or max(map(len, differing.values())) > 1 or len(study.keys) < 2:
        return None
    colours = dict(zip(study.keys, COLOURS * len(study.keys)))

    def marker(row):
        colour = next((colours[key] for key in differing[row.variant]), "#333333")
        return {"marker": "o" if differing[row.variant] else "*", "edgecolors": colour, "facecolors": colour}

    handles = [plt.Line2D([], [], linestyle="", marker="*", color="#333333", markersize=10, label="the scene as it is")]
    varied = [key for key in study.keys if any(key in keys for keys in differing.values())]
    handles += [plt.Line2D([], [], linestyle="", marker="o", color=colours[key], label=f"{short_name(key, study.keys)} instead of {usual[key]}")
                for key in varied]
    return Looks(marker, lambda row: "".join(row.settings[key] for key in differing[row.variant]), handles)


def grid_looks(study):
    """The key with most values gives the colour, the next the marker, a third whether it is filled."""
    values = {key: list(dict.fromkeys(row.settings[key] for row in candidates(study.rows))) for key in study.keys}
    shown = sorted(study.keys, key=lambda key: -len(values[key]))[:3]

    def marker(row):
        index = [values[key].index(row.settings[key]) for key in shown] + [0, 0, 0]
        colour = COLOURS[index[0] % len(COLOURS)]
        return {"marker": MARKERS[index[1] % len(MARKERS)], "edgecolors": colour, "facecolors": colour if index[2] == 0 else "none"}

    handles = []
    for place, key in enumerate(shown):
        for index, value in enumerate(values[key]):
            style = [{"color": COLOURS[index % len(COLOURS)], "marker": "o"}, {"color": GREY, "marker": MARKERS[index % len(MARKERS)]},
                     {"color": GREY, "marker": "o", "markerfacecolor": "none" if index else GREY}][place]
            handles.append(plt.Line2D([], [], linestyle="", label=f"{short_name(key, study.keys)} {value}", **style))
    return Looks(marker, lambda row: "", handles)


def common_handles():
    return [plt.Line2D([], [], color=GREY, label="Pareto front"), plt.Line2D([], [], color=GREY, linestyle=":", label="tolerance"),
            plt.Rectangle((0, 0), 1, 1, color="#eeeeee", label="within what is known")]


def plot_panel(axis, rows, looks, within, cost):
    shown = [row for row in candidates(rows) if math.isfinite(row.error)]
    for row in shown:
        place = cost.of(row), max(row.error, SMALLEST)
        axis.scatter(*place, s=55, zorder=3, **looks.marker(row))
        axis.annotate(looks.label(row), place, xytext=(5, 4), textcoords="offset points", fontsize=8)
    front = pareto_front(shown, cost.of, error)
    axis.step([cost.of(row) for row in front], [max(row.error, SMALLEST) for row in front], where="post", color=GREY, linewidth=1.5, zorder=1)
    axis.axhline(within, color=GREY, linestyle=":", linewidth=1)
    axis.set(xscale="log", yscale="log", xlabel=f"{cost.label}  [{cost.unit}]" if cost.unit else cost.label, ylabel=f"error of {rows[0].quantity}")
    if rows[0].uncertainty > SMALLEST:
        low, high = axis.get_ylim()
        axis.axhspan(min(low, 0.5 * rows[0].uncertainty), rows[0].uncertainty, color="#eeeeee", zorder=0)
        axis.set_ylim(min(low, 0.5 * rows[0].uncertainty), max(high, 1.2 * rows[0].uncertainty))
    finish(axis)


def main():
    options = arguments()
    study, cost = read_study(options.table), COSTS[options.against]
    for line in study.comments:
        print(line)
    for name in study.quantities:
        print_table(study.of(name), cost)
    print(f"\n* on the Pareto front of {cost.label} and error\n")
    for name in study.quantities:
        print(sentence(study.of(name), options.within, cost))
    together = sentence_of_all(study, options.within, cost)
    if together:
        print(together)
    orders = order_sentences(study)
    if orders:
        print("\norder of convergence, and the value extrapolated to zero:")
        print("\n".join(orders))
    print()
    write(figure_of(study, options.within, cost), options.output or options.table.with_suffix(".png"))


if __name__ == "__main__":
    try:
        main()
    except RunError as problem:
        sys.exit(f"work_precision: {problem}")
