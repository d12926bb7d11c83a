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
ENERGIES = (("kinetic_bodies", 0.4), ("kinetic_bodies", 0.7), ("gravity", 0.7), ("friction", 0.7))  # columns and times, s
HEADINGS = (
    "run",
    "ranks",
    "steps",
    f"kinetic energy at {EARLY} s: part of it off",
    *(f"{name} at {time} s (J)" for name, time in ENERGIES),
    "mean height (m)",
    "height that 1 % exceed",
    "distance of 50 % from the axis",
    "90 %",
    "99 %",
    "error of energy",
    "error of momentum",
)


def energies_of(run, first):
    energy, other = run.energy, first.energy
    row = np.searchsorted(energy["time"], EARLY)
    off = abs(energy["kinetic_bodies"][row] / other["kinetic_bodies"][row] - 1)
    return [off, *(np.interp(time, energy["time"], energy[name]) for name, time in ENERGIES)]


def heap_of(run):
    """At the end; masses are equal but for the last bits."""
    place = run.bodies(run.snapshots[-1]).position
    distance = np.linalg.norm(place[:, :2] - CENTRE, axis=1)
    return [place[:, 2].mean(), np.quantile(place[:, 2], 0.99), *np.quantile(distance, (0.5, 0.9, 0.99))]


def main():
    runs = [Run(path) for path in sys.argv[1:]]
    print(", ".join(HEADINGS))
    for run in runs:
        summary = run.summary
        values = [summary["ranks"], summary["steps"], *energies_of(run, runs[0]), *heap_of(run), summary["errors"]["energy"], summary["errors"]["momentum"]]
        print(run.path.name, *(f"{value:.5g}" for value in values), sep=", ")


if __name__ == "__main__":
    main()
