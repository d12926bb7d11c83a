#!/usr/bin/python3
"""Compares the heaps of configs/studies/rock_avalanche.toml: docs/ranks.md.

    studies/avalanche.py RUN RUN ...     # the first is the one that the others are compared with
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post.run import Run

CENTRE = np.array([1.8, 1.8])  # m, of the column
EARLY = 0.1  # s: before chaos has grown


def heap_of(run):
    """Heights and distances from the column's centre, m, at the end; masses are equal but for the last bits."""
    place = run.bodies(run.snapshots[-1]).position
    return place[:, 2], np.linalg.norm(place[:, :2] - CENTRE, axis=1)


def row_of(run, first):
    height, distance = heap_of(run)
    energy, start = run.energy, first.energy
    early = np.searchsorted(energy["time"], EARLY)
    kinetic = abs(energy["kinetic_bodies"][early] / start["kinetic_bodies"][early] - 1)
    quantiles = [np.quantile(distance, share) for share in (0.5, 0.9, 0.99)]
    return [run.summary["ranks"], run.summary["steps"], kinetic, height.mean(), np.quantile(height, 0.99), *quantiles, run.summary["errors"]["energy"], run.summary["errors"]["momentum"]]


def main():
    runs = [Run(path) for path in sys.argv[1:]]
    print("run, ranks, steps, kinetic energy at 0.1 s: part of it off, mean height, height of 99 %, distance of 50, 90, 99 % (m), errors of energy and momentum")
    for run in runs:
        print(run.path.name, *(f"{value:.5g}" for value in row_of(run, runs[0])), sep=", ")


if __name__ == "__main__":
    main()
