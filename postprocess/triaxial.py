#!/usr/bin/python3
"""The law with density beside measured triaxial tests: a table of differences, and a picture. unit_kernels writes what the law gives.

    TREAD_REGENERATE_DOCS=1 ../build/ci/bin/unit_kernels --gtest_filter='BoltonTriaxial*'   # in tests/
    postprocess/triaxial.py --output docs/validation/triaxial.png
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

from tread_post import RunError
from tread_post.style import COLOURS, MARKERS, figure_grid, finish, legend_below, png_of

ROOT = Path(__file__).resolve().parents[1]
PANELS = {"peak_angle [deg]": "peak friction angle  [deg]", "dilation_rate [1]": "rate of dilation",
          "end_volume [%]": "volume strain at the end  [%]"}
COMPARED = ("peak_angle [deg]", "end_angle [deg]", "dilation_rate [1]", "end_volume [%]")


def read(path):
    """Rows of a CSV file with comments behind #."""
    try:
        with open(path, encoding="utf-8") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))
    except (OSError, UnicodeDecodeError) as error:
        raise RunError(f"{path}: {error}") from error


def pairs(measured, law, sand, column):
    """Measured values and the law's [2, n] of the tests of a sand that have both."""
    both = [(one[column], other[column]) for one, other in zip(measured, law) if one["sand"] == sand]
    return np.array([[float(a), float(b)] for a, b in both if a and b]).reshape(-1, 2).T


def difference(one, other):
    """Cell of the table: mean, root mean square and largest of the law's value less the measured one."""
    if not one.size:
        return "-"
    off = other - one
    return f"{off.mean():+.2f}, {np.sqrt((off**2).mean()):.2f}, {off[np.abs(off).argmax()]:+.2f}"


def table(measured, law, sands):
    print("| sand | tests | " + " | ".join(COMPARED) + " |\n|" + "---|" * (len(COMPARED) + 2))
    for sand in sands:
        count = sum(row["sand"] == sand for row in measured)
        print(f"| {sand} | {count} | " + " | ".join(difference(*pairs(measured, law, sand, column)) for column in COMPARED) + " |")


def plot_pairs(axis, measured, law, sands, column):
    for sand, colour, marker in zip(sands, COLOURS, MARKERS):
        axis.plot(*pairs(measured, law, sand, column), marker, color=colour, markersize=5, label=sand)
    ends = [*axis.get_xlim(), *axis.get_ylim()]
    axis.plot([min(ends), max(ends)], [min(ends), max(ends)], color="#333333", linewidth=1, zorder=0)
    axis.set_title(PANELS[column], fontsize=12)
    axis.set_xlabel("measured")


def plot_stiffness(axis, measured, law, sands):
    """Strain at a stress ratio of 3 over pressure: markers measured, a line what the law gives."""
    given = [(row["sand"], float(row["cell_pressure [kPa]"]), float(row["strain_at_3 [%]"]), float(other["strain_at_3 [%]"]))
             for row, other in zip(measured, law) if row["strain_at_3 [%]"]]
    for sand, colour, marker in zip(sands, COLOURS, MARKERS):
        axis.loglog(*zip(*((pressure, strain) for name, pressure, strain, _ in given if name == sand)), marker, color=colour, markersize=5)
    axis.loglog(*zip(*sorted((pressure, strain) for _, pressure, _, strain in given)), color="#333333", linewidth=1)
    axis.set_title("strain at a stress ratio of 3  [%]", fontsize=12)
    axis.set_xlabel("cell pressure  [kPa]")


def figure_of(measured, law, sands):
    figure, axes = figure_grid(1, len(PANELS) + 1, width=16.0, height_each=4.0)
    for axis, column in zip(axes[0], PANELS):
        plot_pairs(axis, measured, law, sands, column)
    plot_stiffness(axes[0, -1], measured, law, sands)
    for axis in axes[0]:
        finish(axis)
    axes[0, 0].set_ylabel("tread")
    legend_below(figure, axes[0, 0].get_legend_handles_labels()[0], len(sands))
    return figure


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tests", type=Path, default=ROOT / "configs/validation/data/triaxial_tests.csv", metavar="FILE.csv",
                        help="what was measured")
    parser.add_argument("--law", type=Path, default=ROOT / "docs/validation/triaxial.csv", metavar="FILE.csv", help="what the law gives")
    parser.add_argument("--output", type=Path, required=True, metavar="FILE.png")
    return parser.parse_args()


def main():
    options = arguments()
    measured, law = read(options.tests), read(options.law)
    if [row.get("test") for row in measured] != [row.get("test") for row in law]:
        raise RunError(f"{options.law}: other tests than {options.tests}")
    sands = list(dict.fromkeys(row["sand"] for row in measured))
    table(measured, law, sands)
    options.output.write_bytes(png_of(figure_of(measured, law, sands), 70))
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"triaxial: {error}")
