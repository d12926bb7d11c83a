#!/usr/bin/python3
"""Where the energy of a run is, and where it went, against time.

What is held, what was turned into heat, and what is unaccounted: the change of everything together, less the work that came in.
Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from tread_post import Run, RunError
from tread_post.style import COLOURS, figure_grid, finish, readable, with_unit, write

HELD = {"kinetic_bodies": "motion of bodies", "kinetic_points": "motion of sand", "strain": "strain of sand", "contact": "contacts",
        "gravity": "height, from the start"}
LOST = {"plastic": "plastic work", "friction": "friction of bodies and contacts", "restitution": "impacts", "damping": "local damping",
        "transfer": "points to grid and back", "coupling": "between sand and bodies", "mass_scaling": "scaled inertia of rocks"}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run, which may still go on")
    parser.add_argument("--output", type=Path, metavar="FILE.png", help="default: RUN/energy.png")
    return parser.parse_args()


def plot_parts(axis, energy, parts, title):
    """Plots the parts that ever matter, largest first; gravity as its change, because its zero is arbitrary."""
    series = {name: energy[name] - (energy[name][0] if name == "gravity" else 0.0) for name in parts if name in energy}
    factor, unit = readable(np.concatenate(list(series.values())), "J")
    shown = [name for name in series if np.abs(series[name]).max(initial=0) > 0]
    for name, colour, dashes in zip(shown, COLOURS, ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3)), (0, (8, 2)))):
        axis.plot(energy["time"], factor * series[name], color=colour, linestyle=dashes, linewidth=1.7, label=parts[name])
    axis.set(title=title, ylabel=with_unit("energy", unit), xlabel="time  [s]")
    axis.legend(loc="best", framealpha=0.85, edgecolor="none", fontsize=10)
    finish(axis)


def figure_of(run):
    energy = run.energy
    if len(energy["time"]) == 0:
        raise RunError(f"{run.path / 'timeseries.h5'}: /energy has no rows yet")
    figure, axes = figure_grid(1, 3, 17.0, 5.2)
    plot_parts(axes[0, 0], energy, HELD, "held")
    plot_parts(axes[0, 1], energy, LOST, "lost since the start")
    plot_parts(axes[0, 2], {"time": energy["time"], "work_in": energy["work_in"], "rest": energy["total"] - energy["total"][0]},
               {"work_in": "work done from outside", "rest": "unaccounted"}, "came in, and what is unaccounted")
    figure.suptitle(run.title, fontsize=15)
    return figure


def main():
    options = arguments()
    write(figure_of(Run(options.run)), options.output or options.run / "energy.png")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"energy: {error}")
