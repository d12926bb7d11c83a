#!/usr/bin/env python3
"""Draws pull, torque and sinkage against slip for two sizes of cells: docs/campaigns.md.

    /usr/bin/python3 studies/slip_cells.py docs/studies/slip_cells.csv docs/studies/slip_cells.png
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

QUANTITIES = (("pull [N]", "standard error [N]"), ("torque [N m]", "standard error [N m]"), ("sinkage [mm]", "standard error [mm]"))
LOAD = 635.4  # N, 170.8 kg on Mars


def draw(table: str, picture: str) -> None:
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.2), layout="constrained")
    for cells, colour in (("20", "tab:orange"), ("12.5", "tab:blue")):
        drives = [row for row in rows if row["cells [mm]"] == cells]
        slip = [float(row["slip"]) for row in drives]
        for axis, (quantity, error) in zip(axes, QUANTITIES):
            values = [float(row[quantity]) for row in drives]
            axis.errorbar(slip, values, [float(row[error]) for row in drives], fmt="o-", color=colour, mfc="none", label=f"cells of {cells} mm")
        pull = [float(row["pull [N]"]) for row in drives]
        band = [LOAD * float(row["error of the grid in the pull over the load"]) for row in drives]
        axes[0].fill_between(slip, [p - b for p, b in zip(pull, band)], [p + b for p, b in zip(pull, band)], color=colour, alpha=0.15, lw=0)
    for axis, (quantity, _) in zip(axes, QUANTITIES):
        axis.set_xlabel("slip")
        axis.set_ylabel(quantity)
        axis.grid(alpha=0.3)
    axes[0].legend()
    figure.savefig(picture, dpi=90)


if __name__ == "__main__":
    draw(*sys.argv[1:3])
