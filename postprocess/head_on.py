#!/usr/bin/python3
"""The head-on collision of a rigid and an elastic sphere (configs/paper/head_on_*.toml) as the paper's Figs. 7 and 8: velocities and
contact force, energies, and energies less those of Hertz's law. Two references: the rigid sphere on an elastic one, which is what the scene says,
and two elastic ones, as the paper's parameters may be read.

Needs Debian's python3-h5py, python3-matplotlib, python3-numpy.
"""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from tread_post import Run, RunError
from tread_post.hertz_impact import hertz, history_of

# Okabe and Ito's colours, which the colour-blind can tell apart; one a run.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("runs", type=Path, nargs="+", metavar="RUN", help="run directories, one a number of points a cell")
    parser.add_argument("--output", type=Path, default=Path("head_on.png"), metavar="FILE.png", help="default: head_on.png")
    return parser.parse_args()


def errors_of(history, reference):
    """Share of the energy at the start that kinetic, elastic and total energy are off by."""
    start = reference.total[0]
    kinetic = np.interp(history.time, reference.time, reference.kinetic)
    elastic = np.interp(history.time, reference.time, reference.elastic)
    return {"kinetic": (history.kinetic - kinetic) / start, "elastic": (history.elastic - elastic) / start,
            "total": history.total / history.total[0] - 1}


def figure_of(histories, references):
    plt.rcParams.update({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(2, 3, figsize=(16, 8), constrained_layout=True)
    for reference, style in zip(references, ("-", ":")):
        draw(axes, reference, "#777777", style, 2.5)
    for history, colour in zip(histories, COLOURS):
        draw(axes, history, colour, "-", 1.2)
        draw_errors(axes[1], errors_of(history, references[0]), history.time, colour)
    titles = (("velocity of the body (falls) and of the points  [m/s]", "contact force  [kN]", "kinetic energy  [J]"),
              ("elastic energy  [J]", "kinetic (line) and elastic (dashed) energy\nless Hertz's, rigid and elastic, over the start  [%]",
               "total energy over the start less 1  [%]"))
    for axis, title in zip(axes.flat, sum(titles, ())):
        axis.set_title(title, fontsize=11)
        axis.set_xlabel("time  [ms]")
        axis.grid(color="#cccccc", linewidth=0.6)
    axes[0][1].set_xlim(45, 90)
    axes[0][1].legend(fontsize=9, edgecolor="none")
    return figure


def draw(axes, history, colour, style, width):
    line = {"color": colour, "linestyle": style, "linewidth": width}
    ms = 1e3 * history.time
    axes[0][0].plot(ms, history.body_velocity, **line)
    axes[0][0].plot(ms, history.points_velocity, **line)
    axes[0][1].plot(ms, history.force / 1e3, label=history.label, **line)
    axes[0][2].plot(ms, history.kinetic, **line)
    axes[1][0].plot(ms, history.elastic, **line)


def draw_errors(axes, errors, time, colour):
    axes[1].plot(1e3 * time, 100 * errors["kinetic"], color=colour, linewidth=1.2)
    axes[1].plot(1e3 * time, 100 * errors["elastic"], color=colour, linewidth=1.2, linestyle="--")
    axes[2].plot(1e3 * time, 100 * errors["total"], color=colour, linewidth=1.2)


def print_row(history, references):
    push = np.nonzero(history.force > 1)[0]
    worst = [100 * np.max(np.abs(errors_of(history, reference)["kinetic"])) for reference in references]
    print(f"{history.label:<12} contact {1e3 * (history.time[push[-1]] - history.time[push[0]]):.2f} ms, largest force "
          f"{history.force.max() / 1e3:.3f} kN, final speeds {history.body_velocity[-1]:+.4f} and {history.points_velocity[-1]:+.4f} m/s, total energy "
          f"{100 * (history.total[-1] / history.total[0] - 1):+.2f} %, kinetic energy off by at most {worst[0]:.1f} % (rigid and elastic) and "
          f"{worst[1]:.1f} % (both elastic)")


def main():
    options = arguments()
    runs = [Run(path) for path in options.runs]
    histories = [history_of(run) for run in runs]
    time = np.linspace(0, histories[0].time[-1], 2001)
    references = [hertz(runs[0].scene, elastic_spheres, time) for elastic_spheres in (1, 2)]
    for history in histories:
        print_row(history, references)
    figure_of(histories, references).savefig(options.output, dpi=110)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"head_on: {error}")
