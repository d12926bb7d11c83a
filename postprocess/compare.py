#!/usr/bin/python3
"""Two runs side by side: what differs in their scenes, whether their bits agree, means of the last drive, and the wheel's history of both.

Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from tread_post import Run, RunError
from tread_post.answers import QUANTITIES, answers_of
from tread_post.style import COLOURS, figure_grid, finish, legend_below, readable, with_unit, write
from tread_post.verdict import resolution_of, text_of

# Title, column of /wheel, component.
PANELS = (("way", "position", 0), ("sinkage", "sinkage", None), ("drawbar pull", "drawbar_pull", None), ("lift", "force", 2),
          ("torque of the ground", "torque", 1), ("slip", "slip", None))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("runs", type=Path, nargs=2, metavar="RUN")
    parser.add_argument("--output", type=Path, default=Path("compare.png"), metavar="FILE.png", help="default: compare.png")
    return parser.parse_args()


def differences(one, other, place=""):
    """Lines "key: one | other" for everything in which two scenes differ; tables in arrays are paired by their names."""
    if isinstance(one, dict) and isinstance(other, dict):
        keys = [*one, *(key for key in other if key not in one)]
        return [line for key in keys for line in differences(one.get(key), other.get(key), f"{place}.{key}" if place else key)]
    if _has_tables(one) or _has_tables(other):
        return differences(_by_name(one), _by_name(other), place)
    if one == other:
        return []
    return [f"{place}: {'absent' if one is None else one} | {'absent' if other is None else other}"]


def _has_tables(value):
    return isinstance(value, list) and any(isinstance(item, dict) for item in value)


def _by_name(tables):
    return {table.get("name") or "-".join(table.get("between", [])) or str(index): table for index, table in enumerate(tables or [])}


def first_difference(series):
    """The time (s) of the first row of two Series that is not the same to the bit; None where all rows of both are."""
    rows = min(len(one["time"]) for one in series)
    same = np.ones(rows, bool)
    for name in series[0].columns:
        one, other = (table[name][:rows].reshape(rows, -1) for table in series)
        same &= ((one == other) | (np.isnan(one) & np.isnan(other))).all(axis=1)
    if not same.all():
        return float(series[0]["time"][np.argmin(same)])
    longest = max(series, key=lambda table: len(table["time"]))
    return None if len(longest["time"]) == rows else float(longest["time"][rows])


def print_means(runs):
    (one, units), (other, _) = (answers_of(run) for run in runs)
    if not one or not other:
        print("means: one of the runs has driven no wheel to speed")
        return
    print(f"{'last drive':<14} {'unit':<5} {'first':>12} {'spread':>10} {'second':>12} {'spread':>10} {'second/first':>13}")
    for name in QUANTITIES:
        ratio = other[name] / one[name] if one[name] else np.nan
        print(f"{name:<14} {units[name]:<5} {one[name]:>12.5g} {one[name + '_spread']:>10.2g} {other[name]:>12.5g} "
              f"{other[name + '_spread']:>10.2g} {ratio:>13.4f}")
    for word, answers in (("first", one), ("second", other)):
        print(f"{word}: {'steady' if answers['steady'] else 'not steady: last half of the drive, from'} {answers['steady_from']:.3g} s")


def print_verdicts(runs):
    for word, run in zip(("first", "second"), runs):
        found = resolution_of(run.summary)
        print(f"{word}: {text_of(found.verdict)}{': ' if found.worst_figure else ''}{found.worst_figure}")
        for warning in found.warnings:
            print(f"{word}: warning: {warning}")


def figure_of(runs, wheel):
    figure, axes = figure_grid(3, 2, 14.0, 3.6, sharex=True)
    series = [run.wheel(wheel) for run in runs]
    for axis, (label, column, component) in zip(axes.flat, PANELS):
        values = [table[column] if component is None else table[column][:, component] for table in series]
        if column == "position":
            values = [value - value[0] for value in values]
        if column == "slip":
            values = [np.where(np.abs(value) <= 1.1, value, np.nan) for value in values]
        factor, unit = readable(np.concatenate(values), series[0].units[column])
        for table, value, colour, dashes, run in zip(series, values, COLOURS, ("-", "--"), runs):
            axis.plot(table["time"], factor * value, color=colour, linestyle=dashes, linewidth=1.6, 
                      label=f"{run.path}: {run.title} ({text_of(resolution_of(run.summary).verdict)})")
        axis.set_ylabel(with_unit(label, unit))
        finish(axis)
    for axis in axes[-1]:
        axis.set_xlabel("time  [s]")
    legend_below(figure, axes[0, 0].get_lines(), 1)
    return figure


def main():
    options = arguments()
    runs = [Run(path) for path in options.runs]
    for line in differences(*(run.scene for run in runs)) or ["same scene"]:
        print(line)
    common = [name for name in runs[0].wheels if name in runs[1].wheels]
    if not common:
        raise RunError("the two runs have no body of the same name")
    for name in common:
        time = first_difference([run.wheel(name) for run in runs])
        print(f"{name}: " + ("all rows agree to the bit" if time is None else f"rows differ from {time:.6g} s on"))
    print_means(runs)
    print_verdicts(runs)
    write(figure_of(runs, common[0]), options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"compare: {error}")
