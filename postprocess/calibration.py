#!/usr/bin/python3
"""Measured curves of a calibration beside the fitted ones, and their residuals (docs/calibration.md).

    postprocess/calibration.py runs/calibration/plate/calibration.json
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

from tread_post.measured import UNITS
from tread_post.style import COLOURS, figure_grid, finish, with_unit, write


def figure_of(report):
    """A row for each curve: values, and fitted less measured."""
    figure, axes = figure_grid(len(report["curves"]), 2, 12.0, 4.0)
    for (values, residuals), curve in zip(axes, report["curves"]):
        places, measured = np.array(curve["places"]), np.array(curve["measured"])
        deviations = np.array([np.nan if value is None else value for value in curve["deviations"]])
        off = np.array(curve["residuals"])
        order = np.argsort(places)
        values.errorbar(places, measured, np.nan_to_num(deviations), color="black", marker="s", markersize=4, linestyle="none", capsize=2, label="measured")
        values.plot(places[order], (measured + off)[order], color=COLOURS[0], label="fitted")
        values.legend(frameon=False)
        residuals.axhline(0.0, color="black", linewidth=0.8)
        residuals.errorbar(places, off, np.nan_to_num(deviations), color=COLOURS[0], marker="o", markersize=4, linestyle="none", capsize=2)
        for axis, label in ((values, curve["y"]), (residuals, f"{curve['y']}: fitted less measured")):
            axis.set(xlabel=with_unit(curve["x"], UNITS[curve["x"]]), ylabel=with_unit(label, UNITS[curve["y"]]), title=Path(curve["file"]).name)
            finish(axis)
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("report", type=Path, metavar="calibration.json")
    path = parser.parse_args().report
    try:
        report = json.loads(path.read_text(encoding="utf-8"))
        write(figure_of(report), path.with_suffix(".png"))
    except (OSError, ValueError, KeyError, TypeError) as error:
        print(f"calibration: error: {path}: {error!r}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
