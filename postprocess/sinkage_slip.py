#!/usr/bin/python3
"""Sinkage over its largest value against slip, of wheels that are free to slip, beside published experiments: the paper's Fig. 23.

Of runs: every row of the last drive. Of campaigns: the steady means of each curve. Markers: the runs' verdicts (docs/verdict.md); runs that failed
are counted, not drawn. Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import slip_curves
from tread_post import Run, RunError
from tread_post.answers import last_drive
from tread_post.campaign import CampaignTable
from tread_post.style import COLOURS, DASHES, figure_grid, finish, legend_below, write
from tread_post.verdict import FAILED, plot_verdicts, resolution_of, verdict_handles

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


@dataclass(frozen=True)
class Trace:
    """Rows of a run's drive, or means of the cases of a campaign's curve."""

    name: str
    slip: np.ndarray  # [n]
    sinkage: np.ndarray  # [n], over the largest
    verdicts: np.ndarray  # [n]
    are_means: bool
    run_verdicts: list  # of each run behind it


def traces_of(path):
    """The Trace of a run, or of each curve of a campaign."""
    if not (path / "campaign.h5").is_file():
        run = Run(path)
        drive = last_drive(run)
        slip, sinkage = drive.series["slip"], drive.series["sinkage"]
        known = np.isfinite(slip) & (slip >= SHOWN[0]) & (slip <= SHOWN[1])
        if not known.any():
            raise RunError(f"{path}: no row of its last drive has a slip between 0 and 1")
        verdict = resolution_of(run.summary).verdict
        return [Trace(run.title, slip[known], sinkage[known] / sinkage.max(), np.full(known.sum(), verdict, object), False, [verdict])]
    table = CampaignTable(path)
    curves = [curve for curve in slip_curves.curves_of(table) if len(curve.rows) > 1]
    return [Trace(curve.name, table["slip"][curve.rows], table["sinkage"][curve.rows] / table["sinkage"][curve.rows].max(),
                  table.verdicts[curve.rows], True, list(table.verdicts[curve.rows])) for curve in curves] + _failures(table)


def _failures(table):
    """What is counted in the legend and not drawn."""
    failed = [FAILED] * int((table.verdicts == FAILED).sum())
    return [Trace("", np.zeros(0), np.zeros(0), np.zeros(0, object), True, failed)] if failed else []


def figure_of(traces):
    figure, axes = figure_grid(1, 1, 10.0, 6.0)
    axis = axes[0, 0]
    for number, trace in enumerate(traces):
        colour = COLOURS[number % len(COLOURS)]
        if trace.name:
            axis.plot(trace.slip if trace.are_means else [], trace.sinkage if trace.are_means else [], color=colour,
                      linestyle=DASHES[number % len(DASHES)], linewidth=1.4, label=trace.name)
        plot_verdicts(axis, trace.slip, trace.sinkage, trace.verdicts, colour, size=7.0 if trace.are_means else 4.0,
                      alpha=1.0 if trace.are_means else 0.5)
    for (name, (slip, sinkage)), marker in zip(PUBLISHED.items(), ("*", "^")):
        # Their largest slip is 0.6, where the sinkage is not yet the largest that a wheel reaches.
        axis.plot(slip, np.array(sinkage) / max(PUBLISHED["Ding et al. 2011, smooth"][1]), marker, color="black", markersize=9,
                  linestyle="none", label=f"{name}, over the smooth wheel's at 0.6")
    axis.set(xlabel="slip", ylabel="sinkage / largest sinkage", xlim=SHOWN, ylim=(0, 1.05))
    axis.legend(loc="lower right", framealpha=0.9, edgecolor="none")
    legend_below(figure, verdict_handles([verdict for trace in traces for verdict in trace.run_verdicts], with_steadiness=False), 3)
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
