#!/usr/bin/python3
"""What a step of sand costs on several ranks, fitted to measured steps, and what that says for more of them.

A rank's step takes a + b n + c p: n its points (volume), p the pages of others beside its own (surface), a what it takes whatever
there is to do (latency). On P ranks a grows by l for each doubling: the sums of all ranks. a and b are fitted to steps less their
halo, c to the halo, timed alone; it was not the same everywhere, so predictions are given for its least and its largest value. The
halo travels beside P2G of the pages that no other rank shares, and only what takes longer than that is left.

Where bodies are, a step takes v / P + f + s m on P ranks: v is what ranks divide, f what each does whatever its share, s substeps cost
m each where there are several ranks. Three measured numbers of ranks give the three.

Needs Debian's python3-numpy.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

STUDIES = Path(__file__).resolve().parent.parent / "docs" / "studies"
MEASURED = STUDIES / "rank_cost.csv"
WITH_BODIES = STUDIES / "rank_cost_bodies.csv"
POINTS_A_PAGE = 512  # 64 cells of 8
# us: a report takes 12 us more on two ranks than on one, and there is one every eighth step.
LATENCY = 12 / 8
P2G = 0.0988e-3  # us a point: tread-bench scaling, 1e7 points on one GPU, 27b3e3fc


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
    return {name: np.array([row[name] if name == "scene" else float(row[name]) for row in rows]) for name in rows[0]}


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


def left_of_halo(points, cost):
    """us of the halo that P2G of the inner pages of such a cube does not hide."""
    edge = np.cbrt(points / POINTS_A_PAGE)
    return max(0.0, cost * pages_around(points) - P2G * points * ((edge - 2) / edge) ** 3)


def print_bodies(table):
    print("with bodies: what ranks divide, what each does, a substep of several; twice, four times, many times the ranks; weak scaling")
    for scene in dict.fromkeys(table["scene"]):
        of = table["scene"] == scene
        ranks, substeps, step = table["ranks"][of], table["substeps"][of], table["step_us"][of]
        terms = np.stack((1 / ranks, np.ones_like(ranks), np.where(ranks > 1, substeps, 0)), axis=-1)
        divided, fixed, message = np.linalg.lstsq(terms, step, rcond=None)[0]
        several = fixed + substeps.mean() * message
        gains = [step[0] / (divided / more + several) for more in (2, 4, 8, np.inf)]
        weak = step[0] / (divided + several)
        print(f"{scene:8} v = {divided:6.0f} us, f = {fixed:6.0f} us, m = {message:5.0f} us; 2, 4, 8, many ranks: "
              f"{', '.join(f'{gain:.2f}' for gain in gains)} times; weak {100 * weak:.0f} %")


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
            steps = [alone + left_of_halo(points, c) + LATENCY * np.log2(ranks) for c in reversed(surface)]
            cells.append(f"{ranks} ranks {100 * alone / steps[0]:.0f} to {100 * alone / steps[1]:.0f} %")
        print(f"{points:7.1e} a rank, alone {alone:8.0f} us: " + "; ".join(cells))
    print_bodies(read(WITH_BODIES))


if __name__ == "__main__":
    main()
