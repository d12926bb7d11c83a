#!/usr/bin/python3
"""How evenly the sand of a run fell to its ranks, and how many points changed ranks, against time.

Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from pathlib import Path

from tread_post import Run, RunError
from tread_post.style import COLOURS, GREY, figure_grid, finish, write


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run on several ranks")
    parser.add_argument("--output", type=Path, metavar="FILE.png", help="default: RUN/balance.png")
    return parser.parse_args()


def figure_of(run):
    ranks = run.ranks
    time = ranks["time"]
    figure, axes = figure_grid(2, 1, 10.0, 3.5, sharex=True)
    above, below = axes[:, 0]
    above.plot(time, ranks["imbalance"], color=COLOURS[0], linewidth=1.6)
    threshold = run.scene.get("balance", {}).get("threshold")
    if threshold is not None and threshold < 10:
        above.axhline(threshold, color=GREY, linewidth=0.8, linestyle="--", label="threshold of the scene")
        above.legend(loc="upper right", frameon=False)
    renewed = [t for t, old, new in zip(time[1:], ranks["repartitions"], ranks["repartitions"][1:]) if new > old]
    for t in renewed:
        above.axvline(t, color=COLOURS[1], linewidth=0.8)
    above.set_ylabel("largest over mean load")
    above.set_ylim(bottom=1)
    below.plot(time, ranks["points_moved"], color=COLOURS[6], linewidth=1.6)
    below.set_ylabel("points that changed ranks")
    below.set_xlabel("time  [s]")
    for axis in (above, below):
        finish(axis)
    figure.suptitle(run.title, fontsize=15)
    return figure


def main():
    options = arguments()
    path = options.output or options.run / "balance.png"
    write(figure_of(Run(options.run)), path)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"balance: {error}")
