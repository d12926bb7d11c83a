#!/usr/bin/python3
"""Sinkage over its largest value against slip, of wheels that are free to slip, beside published experiments: the paper's Fig. 23.

Of runs: every row of the last drive. Of campaigns: the steady means of each curve. Needs Debian's python3-h5py, python3-numpy and
python3-matplotlib.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import slip_curves
from tread_post import Run, RunError
from tread_post.answers import last_drive
from tread_post.campaign import CampaignTable
from tread_post.style import COLOURS, MARKERS, figure_grid, finish, write

# L. Ding, H. Gao, Z. Deng, K. Nagatani, K. Yoshida, J. Terramech. 48(1), 2011, 27-45: 80 N on a wheel of 157 mm, slip and sinkage in mm; read off by
# a third party. The points in the paper's own Fig. 23 (NASA GRC, Johnson et al. 2017) are not printed as numbers.
PUBLISHED = {
    "Ding et al. 2011, smooth": ((0, 0.1, 0.2, 0.3, 0.4, 0.6), (5, 5.5, 7.5, 10, 12.5, 17.5)),
    "Ding et al. 2011, 10 mm grousers": ((0, 0.1, 0.2, 0.3, 0.4), (4.5, 5, 7.5, 10.5, 14)),
}
SHOWN = (-0.05, 1.02)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("paths", type=Path, nargs="+", metavar="RUN|DIR", help="runs, or directories of collected campaigns")
    parser.add_argument("--output", type=Path, default=Path("sinkage_slip.png"), metavar="FILE.png", help="default: sinkage_slip.png")
    return parser.parse_args()


def traces_of(path):
    """(name, slip [n], sinkage [n] over its largest, whether they are means) of a run, or of each curve of a campaign."""
    if not (path / "campaign.h5").is_file():
        run = Run(path)
        drive = last_drive(run)
        slip, sinkage = drive.series["slip"], drive.series["sinkage"]
        known = np.isfinite(slip) & (slip >= SHOWN[0]) & (slip <= SHOWN[1])
        if not known.any():
            raise RunError(f"{path}: no row of its last drive has a slip between 0 and 1")
        return [(run.title, slip[known], sinkage[known] / sinkage.max(), False)]
    table = CampaignTable(path)
    curves = [curve for curve in slip_curves.curves_of(table) if len(curve.rows) > 1]
    return [(curve.name, table["slip"][curve.rows], table["sinkage"][curve.rows] / table["sinkage"][curve.rows].max(), True) for curve in curves]


def figure_of(traces):
    figure, axes = figure_grid(1, 1, 10.0, 6.0)
    axis = axes[0, 0]
    for number, (name, slip, sinkage, are_means) in enumerate(traces):
        colour = COLOURS[number % len(COLOURS)]
        if are_means:
            axis.plot(slip, sinkage, color=colour, marker=MARKERS[number % len(MARKERS)], linewidth=1.4, label=name)
        else:
            axis.plot(slip, sinkage, ".", color=colour, markersize=4, alpha=0.5, label=name)
    for (name, (slip, sinkage)), marker in zip(PUBLISHED.items(), ("*", "x")):
        # Their largest slip is 0.6, where the sinkage is not yet the largest that a wheel reaches.
        axis.plot(slip, np.array(sinkage) / max(PUBLISHED["Ding et al. 2011, smooth"][1]), marker, color="black", markersize=9,
                  linestyle="none", label=f"{name}, over the smooth wheel's at 0.6")
    axis.set(xlabel="slip", ylabel="sinkage / largest sinkage", xlim=SHOWN, ylim=(0, 1.05))
    axis.legend(loc="lower right", framealpha=0.9, edgecolor="none")
    finish(axis)
    return figure


def main():
    options = arguments()
    write(figure_of([trace for path in options.paths for trace in traces_of(path)]), options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"sinkage_slip: {error}")
