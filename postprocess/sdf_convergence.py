#!/usr/bin/python3
"""How signed distance fields converge with their cells, from files of `tread sdf SHAPE --report FILE.h5`, as one picture.

Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from tread_post import RunError

# Okabe and Ito's colours, which the colour-blind can tell apart; one a file.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#333333")
COLUMNS = ("cells", "mean_surface", "worst_surface", "volume_ratio", "mean_normal", "worst_normal", "seconds", "bytes")
# Off by more than this, tread warns.
VOLUME_TOLERANCE = 0.02


@dataclass(frozen=True)
class Report:
    shape: str
    columns: dict[str, np.ndarray]

    def __getitem__(self, name):
        return self.columns[name]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("reports", type=Path, nargs="+", metavar="FILE.h5", help="of tread sdf --report")
    parser.add_argument("--output", type=Path, metavar="FILE.png", default=Path("sdf_convergence.png"),
                        help="default: sdf_convergence.png")
    options = parser.parse_args()
    if len(options.reports) > len(COLOURS):
        parser.error(f"at most {len(COLOURS)} files")
    return options


def read(path):
    try:
        with h5py.File(path) as file:
            return Report(file.attrs["shape"], {name: file[name][...] for name in COLUMNS})
    except (OSError, KeyError) as error:
        raise RunError(f"{path}: no report of tread sdf ({error})") from error


def plot_pair(axis, report, colour, mean, worst):
    axis.loglog(report["cells"], report[mean], "o-", color=colour, markersize=4, label=report.shape)
    axis.loglog(report["cells"], report[worst], "s--", color=colour, markersize=3, linewidth=1)


def guide(axis, cells, start, power):
    """The slope that a method of this order has."""
    axis.loglog(cells, start * (cells / cells[0]) ** -power, color="#999999", linewidth=1, zorder=0)
    axis.annotate(f"$N^{{-{power}}}$", (cells[-1], start * (cells[-1] / cells[0]) ** -power), xytext=(3, 0),
                  textcoords="offset points", color="#777777", fontsize=11, va="center")


def figure_of(reports):
    plt.rcParams.update({"font.size": 12, "axes.spines.top": False, "axes.spines.right": False})
    figure, ((surface, volume), (normal, cost)) = plt.subplots(2, 2, figsize=(13, 9), constrained_layout=True)
    for report, colour in zip(reports, COLOURS):
        plot_pair(surface, report, colour, "mean_surface", "worst_surface")
        plot_pair(normal, report, colour, "mean_normal", "worst_normal")
        volume.semilogx(report["cells"], report["volume_ratio"], "o-", color=colour, markersize=4, label=report.shape)
        cost.loglog(report["cells"], report["bytes"] / 2**20, "o-", color=colour, markersize=4, label=report.shape)
        cost.loglog(report["cells"], report["seconds"], "s--", color=colour, markersize=3, linewidth=1)
    cells = np.array([20.0, 200.0])
    guide(surface, cells, 0.4 * min(report["mean_surface"][2] for report in reports), 2)
    guide(normal, cells, 0.6 * min(report["mean_normal"][2] for report in reports), 1)
    volume.axhspan(1 - VOLUME_TOLERANCE, 1 + VOLUME_TOLERANCE, color="#e9e9e9", zorder=0)
    surface.set_ylabel("distance on the surface, over the extent")
    surface.set_title("surface: mean (solid), largest (dashed)", fontsize=12)
    volume.set_ylabel("enclosed volume, over the mesh's")
    volume.set_title("volume: grey, where tread does not warn", fontsize=12)
    normal.set_ylabel("angle between gradient and normal  [degree]")
    normal.set_title("normals: mean (solid), largest (dashed)", fontsize=12)
    cost.set_title("size in MiB (solid), time to build in s (dashed)", fontsize=12)
    ticks = reports[0]["cells"]
    for axis in figure.axes:
        axis.set_xlabel("cells along the longest axis, N")
        axis.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axis.minorticks_off()
        axis.grid(color="#cccccc", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.legend(frameon=True, framealpha=0.85, edgecolor="none")
    return figure


def main():
    options = arguments()
    figure = figure_of([read(path) for path in options.reports])
    figure.savefig(options.output, dpi=110)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"sdf_convergence: {error}")
