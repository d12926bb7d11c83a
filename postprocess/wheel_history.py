#!/usr/bin/python3
"""Position, velocity, force, torque, sinkage and slip of a run's wheels against time, as one picture.

Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from tread_post import Run, RunError
from tread_post.style import COLOURS, figure_grid, finish, readable, with_unit, write
from tread_post.verdict import resolution_of, text_of

# x, y, z, and one for scalars.
COMPONENT_COLOURS = (COLOURS[1], COLOURS[2], COLOURS[0])
SCALAR_COLOUR = COLOURS[6]
# Panels in the order of reading: column, label, name of the axis.
PANELS = (
    ("position", "displacement"),
    ("velocity", "velocity"),
    ("force", "force of the ground"),
    ("torque", "torque of the ground"),
    ("sinkage", "sinkage"),
    ("slip", "slip"),
)
# Beyond this a slip is that of a wheel which hardly turns, and says nothing.
SLIP_RANGE = (-1.1, 1.1)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run")
    parser.add_argument("--output", type=Path, metavar="FILE.png", help="default: RUN/wheel_history.png")
    parser.add_argument("--wheel", metavar="NAME", help="of the scene's bodies; default: all, one picture each")
    return parser.parse_args()


def shade_phases(axes, phases, end):
    """Every second phase lies on grey; names stand over the first row."""
    ends = [phase.start for phase in phases[1:]] + [end]
    for number, (phase, stop) in enumerate(zip(phases, ends)):
        for axis in axes.flat:
            if number % 2 == 1:
                axis.axvspan(phase.start, stop, color="#e9e9e9", linewidth=0, zorder=0)
        # A name wider than its phase would run into its neighbour's.
        if stop - phase.start < 0.04 * end:
            continue
        for axis in axes[0]:
            axis.text(
                0.5 * (phase.start + stop), 1.02, phase.name, transform=axis.get_xaxis_transform(),
                ha="center", va="bottom", fontsize=11, color="#555555",
            )


def plot_vector(axis, time, values, unit, label):
    factor, unit = readable(values, unit)
    for component, name in enumerate("xyz"):
        axis.plot(time, factor * values[:, component], color=COMPONENT_COLOURS[component], label=name, linewidth=1.6)
    axis.set_ylabel(with_unit(label, unit))
    axis.legend(ncol=3, loc="best", frameon=True, framealpha=0.85, edgecolor="none", handlelength=1.4)


def plot_scalar(axis, time, values, unit, label):
    factor, unit = readable(values, unit)
    axis.plot(time, factor * values, color=SCALAR_COLOUR, linewidth=1.6)
    axis.set_ylabel(with_unit(label, unit))


def plot_panel(axis, series, column, label):
    values, unit = series[column], series.units[column]
    if column == "position":
        values = values - values[0]
    if column == "slip":
        values = np.where((values >= SLIP_RANGE[0]) & (values <= SLIP_RANGE[1]), values, np.nan)
    (plot_vector if values.ndim == 2 else plot_scalar)(axis, series["time"], values, unit, label)
    if column == "slip" and not np.isfinite(values).any():
        axis.text(0.5, 0.5, "the wheel does not turn", transform=axis.transAxes, ha="center", color="#555555")
        axis.set_yticks([])


def figure_of(run, name):
    series = run.wheel(name)
    time = series["time"]
    if len(time) == 0:
        raise RunError(f"{run.path / 'timeseries.h5'}: /wheel/{name} has no rows yet")
    figure, axes = figure_grid(3, 2, height_each=3.3, sharex=True)
    for axis, (column, label) in zip(axes.flat, PANELS):
        plot_panel(axis, series, column, label)
        axis.axhline(0, color="#999999", linewidth=0.8)
        finish(axis)
    shade_phases(axes, run.phases, time[-1])
    axes[0, 0].set_xlim(time[0], max(time[-1], time[0] + 1e-9))
    for axis in axes[-1]:
        axis.set_xlabel("time  [s]")
    figure.suptitle(f"{run.title}\n{name} ({text_of(resolution_of(run.summary).verdict)})", fontsize=15)
    return figure


def main():
    options = arguments()
    run = Run(options.run)
    names = [options.wheel] if options.wheel else run.wheels
    if not names:
        raise RunError(f"{options.run}: the scene has no bodies, hence no history of one")
    output = options.output or options.run / "wheel_history.png"
    for name in names:
        path = output if len(names) == 1 else output.with_stem(f"{output.stem}_{name}")
        write(figure_of(run, name), path)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"wheel_history: {error}")
