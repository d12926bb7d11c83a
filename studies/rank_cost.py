#!/usr/bin/python3
"""What a step of sand costs on several ranks, fitted to measured steps, and what that says for more of them.

A rank's step takes a + b n + c p: n its points (volume), p the pages of others beside its own (surface), a what it takes whatever
there is to do (latency). On P ranks a grows by l for each doubling: the sums of all ranks. a and b are fitted to steps less their
halo, c to the halo, timed alone; it was not the same everywhere, so predictions are given for its least and its largest value.

Needs Debian's python3-numpy.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

MEASURED = Path(__file__).resolve().parent.parent / "docs" / "studies" / "rank_cost.csv"
POINTS_A_PAGE = 512  # 64 cells of 8
# us: a report takes 12 us more on two ranks than on one, and there is one every eighth step.
LATENCY = 12 / 8


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("measured", type=Path, nargs="?", default=MEASURED, metavar="FILE.csv", help=f"default: {MEASURED.name}")
    parser.add_argument("--points", type=float, nargs="+", default=[1e7, 1e8, 5e8], metavar="N", help="of a rank")
    parser.add_argument("--ranks", type=int, nargs="+", default=[8, 64, 1024], metavar="P")
    return parser.parse_args()


def read(path):
    """Columns by name."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    if not rows:
        sys.exit(f"rank_cost: {path}: no rows")
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def fit_volume(table):
    """a (us) and b (us a point): least squares of relative errors."""
    step = table["step_us"] - table["halo_us"] - LATENCY * np.log2(table["ranks"])
    terms = np.stack((np.ones_like(step), table["points"] / table["ranks"]), axis=-1)
    return np.linalg.lstsq(terms / step[:, None], np.ones(len(step)), rcond=None)[0]


def surface_costs(table):
    """c (us a page), least and largest."""
    shared = table["pages"] > 0
    costs = table["halo_us"][shared] / table["pages"][shared]
    return costs.min(), costs.max()


def pages_around(points):
    """Number of pages of other ranks beside a cube of that many points with neighbours on all sides."""
    edge = np.cbrt(points / POINTS_A_PAGE)
    return (edge + 2) ** 3 - edge**3


def main():
    options = arguments()
    table = read(options.measured)
    latency, volume = fit_volume(table)
    surface = surface_costs(table)
    print(f"a = {latency:.1f} us, b = {1e3 * volume:.4f} ns a point, c = {surface[0]:.3f} to {surface[1]:.3f} us a page")
    print("ranks    points     measured    a + b n + halo")
    own = table["points"] / table["ranks"]
    fitted = latency + volume * own + table["halo_us"] + LATENCY * np.log2(table["ranks"])
    for ranks, points, step, model in zip(table["ranks"], table["points"], table["step_us"], fitted):
        print(f"{ranks:5.0f}  {points:9.3g}  {step:8.1f} us  {100 * (model / step - 1):+5.1f} %")
    print("weak scaling predicted, neighbours on all sides, share of one rank's speed by the largest and the least c")
    for points in options.points:
        alone = latency + volume * points
        cells = []
        for ranks in options.ranks:
            steps = [alone + c * pages_around(points) + LATENCY * np.log2(ranks) for c in reversed(surface)]
            cells.append(f"{ranks} ranks {100 * alone / steps[0]:.0f} to {100 * alone / steps[1]:.0f} %")
        print(f"{points:7.1e} a rank, alone {alone:8.0f} us: " + "; ".join(cells))


if __name__ == "__main__":
    main()
