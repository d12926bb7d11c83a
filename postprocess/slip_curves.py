#!/usr/bin/python3
"""Drawbar pull, torque, sinkage and power number of a campaign's wheels against slip: mean and spread over the steady part of each drive.

Markers: the runs' verdicts (docs/verdict.md); a ring where a drive had not become steady, or goes on. Bands: Wong and Reece's formulas
with the strength of the scene's sand and the stiffness of published soils. Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tread_post import RunError
from tread_post.campaign import CampaignTable
from tread_post.style import COLOURS, DASHES, GREY, figure_grid, finish, legend_below, readable, with_unit, write
from tread_post.verdict import FAILED, headline, plot_verdicts, verdict_handles
from tread_post.wong_reece import PUBLISHED, predict, soils_like, wheel_of

PANELS = (
    ("drawbar_pull", "drawbar pull"), ("pull_share", "drawbar pull / weight"), ("torque", "driving torque"),
    ("torque_share", "torque / (weight x radius)"), ("sinkage", "sinkage"), ("power_number", "power number  P / (W v)"),
)
# Beyond a slip of 0.95 the power number, a ratio to the advance, says nothing.
MOST_POWER = 12.0


@dataclass(frozen=True)
class Curve:
    """Cases that differ in slip alone, by slip."""

    name: str
    rows: np.ndarray
    wheel: object  # None where the scene does not say its size
    scene: dict


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("campaign", type=Path, metavar="DIR", help="of a campaign, after `jobs/campaign.py collect`")
    parser.add_argument("--output", type=Path, metavar="FILE.png", help="default: DIR/slip_curves.png")
    return parser.parse_args()


def curves_of(table):
    """One Curve for each combination of the axes that are not slip, of the cases that have answers and did not fail."""
    if "torque" not in table.columns:
        raise RunError(f"{table.path}: no case has driven a wheel to speed")
    others = [key for key in table.label_columns if key.partition("/")[2] not in (*table.slip_axes, "repeat")]
    groups = {}
    for row in np.flatnonzero(np.isfinite(table["torque"]) & (table.verdicts != FAILED)):
        groups.setdefault(", ".join(_setting(table, key, row) for key in others), []).append(row)
    curves = []
    for name, rows in groups.items():
        rows = np.array(sorted(rows, key=lambda row: table["slip"][row]))
        scene = table.scene(rows[0])
        curves.append(Curve(name or table.title, rows, wheel_of(scene, float(np.mean(table["weight"][rows]))), scene))
    return curves


def _setting(table, key, row):
    """The label of a case on an axis; a bare number is given its axis and unit."""
    name = key.partition("/")[2]
    if f"axes/{name}" not in table.columns:
        return table[key][row]
    unit = table.units[f"axes/{name}"]
    return f"{name} {table[key][row]}{'' if unit == '1' else ' ' + unit}"


def values_of(table, curve, quantity):
    """Mean, spread and unit."""
    sources = {"pull_share": "drawbar_pull", "torque_share": "torque"}
    mean, spread = (table[sources.get(quantity, quantity) + suffix][curve.rows] for suffix in ("", "_spread"))
    if quantity not in sources:
        return mean, spread, table.units[quantity]
    # A wheel that is still in the air weighs on nothing.
    by = np.where(table["weight"][curve.rows] > 0, table["weight"][curve.rows], np.nan)
    if quantity == "torque_share":
        by = by * (curve.wheel.radius if curve.wheel else np.nan)
    return mean / by, spread / by, "1"


def plot_curve(axis, table, curve, quantity, style, factor):
    mean, spread, _ = values_of(table, curve, quantity)
    slip, steady = table["slip"][curve.rows], (table["steady"][curve.rows] > 0) & (table["state"][curve.rows] == "done")
    if quantity == "power_number":
        mean = np.where(np.abs(mean) <= MOST_POWER, mean, np.nan)
    colour, dashes = style
    axis.errorbar(slip, factor * mean, factor * spread, color=colour, linestyle=dashes, linewidth=1.4, capsize=3, elinewidth=0.9, zorder=2)
    plot_verdicts(axis, slip, factor * mean, table.verdicts[curve.rows], colour, ~steady)


def predictions(wheel, soils, slips):
    """[soils, slips] of Prediction's sinkage, pull / weight, torque / (weight x radius); NaN where the soil does not carry the wheel."""
    found = [[predict(wheel, soil, slip) for slip in slips] for soil in soils]
    parts = [[(p.sinkage, p.drawbar_pull / wheel.weight, p.torque / (wheel.weight * wheel.radius)) if p else (np.nan,) * 3 for p in row]
             for row in found]
    return np.moveaxis(np.array(parts), -1, 0)


def plot_predictions(axes, wheels, scene, factor):
    """On sinkage, pull share and torque share: a band for each load of the curves, dashed lines for the soils with their own strength."""
    slips = np.linspace(0.0, 0.95, 20)
    for wheel, shade in zip(wheels, ("#bbbbbb", "#e2d3b0", "#cfe0d0")):
        banded = predictions(wheel, soils_like(scene, wheel.width), slips)
        published = predictions(wheel, PUBLISHED, slips)
        for axis, band, lines, scale in zip(axes, banded, published, (factor, 1.0, 1.0)):
            axis.fill_between(slips, scale * band.min(axis=0), scale * band.max(axis=0), color=shade, alpha=0.55, linewidth=0, zorder=0,
                              label=f"Wong-Reece, {wheel.weight:.0f} N, the scene's strength")
            for line in lines:
                axis.plot(slips, scale * line, color=GREY, linestyle="--", linewidth=0.9, zorder=1)


def different_wheels(curves):
    """Lists the different wheels of the curves; weights equal to 2 % count as one."""
    wheels = []
    for curve in curves:
        if curve.wheel and all(abs(curve.wheel.weight / wheel.weight - 1) > 0.02 for wheel in wheels):
            wheels.append(curve.wheel)
    return wheels


def figure_of(table):
    curves = curves_of(table)
    figure, axes = figure_grid(3, 2, 13.0, 4.6)
    scales = {}
    for axis, (quantity, label) in zip(axes.flat, PANELS):
        values = np.concatenate([values_of(table, curve, quantity)[0] for curve in curves])
        factor, unit = readable(values, values_of(table, curves[0], quantity)[2])
        scales[quantity] = factor
        for number, curve in enumerate(curves):
            plot_curve(axis, table, curve, quantity, (COLOURS[number % 7], DASHES[number % 4]), factor)
        axis.set(xlabel="slip", ylabel=with_unit(label, unit))
        finish(axis)
    wheels = different_wheels(curves)
    if wheels and soils_like(curves[0].scene, 1.0):
        plot_predictions((axes[2, 0], axes[0, 1], axes[1, 1]), wheels, curves[0].scene, scales["sinkage"])
    legend_below(figure, legend_of(table, axes[2, 0], curves, bool(wheels)), 2)
    figure.suptitle(f"{table.title}\n{headline(table.verdicts)}", fontsize=15)
    return figure


def legend_of(table, axis, curves, with_soils):
    import matplotlib.pyplot as plt

    handles = [plt.Line2D([], [], color=COLOURS[i % 7], linestyle=DASHES[i % 4], label=curve.name) for i, curve in enumerate(curves)]
    handles += verdict_handles(table.verdicts)
    if with_soils:
        handles += axis.get_legend_handles_labels()[0]
        handles.append(plt.Line2D([], [], color=GREY, linestyle="--", label=f"Wong-Reece: {', '.join(soil.name for soil in PUBLISHED)}"))
    return handles


def main():
    options = arguments()
    write(figure_of(CampaignTable(options.campaign)), options.output or options.campaign / "slip_curves.png")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"slip_curves: {error}")
