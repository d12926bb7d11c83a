#!/usr/bin/env python3
"""Finds how many times its automatic step (rocks alone: substep) each scene of limits.toml stays stable at, by bisection.

  tests/stability/step_limits.py --tread build/bin/tread --jobs 16 --output step_limits.csv

Needs Debian's python3-h5py and python3-numpy.
"""

import argparse
import csv
import dataclasses
import functools
import os
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from cells import HERE, Program, read_matrix, run_cell

GROWTH, MOST, NARROW = 1.4, 12.0, 1.05
SUBSTEPS = 10
FIRST_SHARE = 0.01  # of the first step of rocks alone, which fall freely then: a step that is surely short enough


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tread", type=Path, default=os.environ.get("TREAD", "tread"), metavar="PROGRAM", help="default: $TREAD, or tread")
    parser.add_argument("--backend", choices=("cpu", "cuda"), default="cpu", help="default: cpu")
    parser.add_argument("--steps", type=int, default=5000, help="of a run; default: 5000")
    parser.add_argument("--wall", type=float, default=600, metavar="SECONDS", help="of a run, at most")
    parser.add_argument("--jobs", type=int, default=1, help="cells at a time; default: 1")
    parser.add_argument("--only", default="", metavar="REGEX", help="cells whose names it is found in")
    parser.add_argument("--output", type=Path, default=Path("step_limits.csv"), metavar="FILE.csv", help="default: step_limits.csv")
    return parser.parse_args()


def trial_of(program, cell, options):
    """A function of the factor on the automatic step: what the cell is at that."""
    if cell.scene != "rocks":
        # A run at the automatic step itself is fixed, too, so that all have steps of one length.
        return lambda factor: run_cell(program, _with(cell, {"dt": 1.0}), options.steps, options.wall, factor)
    short = _with(cell, {"dt": FIRST_SHARE, "time.substeps": SUBSTEPS})
    seen = run_cell(program, short, 0.1 / FIRST_SHARE * options.steps, options.wall)
    automatic = FIRST_SHARE * seen.figures["margin_body_contact"]
    steps = 0.1 * options.steps / automatic
    return lambda factor: run_cell(program, _with(cell, {"dt": automatic, "time.substeps": SUBSTEPS}), max(steps / factor, 200),
                                   options.wall, factor)


def _with(cell, values):
    return dataclasses.replace(cell, values=cell.values | values)


def limit_of(trial, passing):
    """(largest factor at which the outcome was one of `passing`, smallest at which it was not, what that was)"""
    good, factor, failed, why = 0.0, 1.0, None, ""
    while factor <= MOST and failed is None:
        result = trial(factor)
        if result.outcome in passing:
            good, factor = factor, GROWTH * factor
        else:
            failed, why = factor, f"{result.outcome}: {result.reason}"
    while failed is not None and good > 0 and failed > NARROW * good:
        middle = (good * failed) ** 0.5
        result = trial(middle)
        if result.outcome in passing:
            good = middle
        else:
            failed, why = middle, f"{result.outcome}: {result.reason}"
    return good, failed or float("inf"), why


def limits_of(program, cell, options):
    """limit_of what keeps all bounds, and of what keeps all but that on unaccounted energy: inaccurate, and stable."""
    trial = functools.cache(trial_of(program, cell, options))
    return limit_of(trial, {"stable"}), limit_of(trial, {"stable", "told"})


def main():
    options = arguments()
    program = Program(options.tread, options.backend)
    cells = [cell for cell in read_matrix(HERE / "limits.toml") if re.search(options.only, cell.name)]
    with ThreadPoolExecutor(options.jobs) as pool, open(options.output, "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["name", "map", "x", "y", "backend", "accurate_to", "not_at", "what", "stable_to", "unstable_at", "how"])
        for cell, limits in zip(cells, pool.map(lambda cell: limits_of(program, cell, options), cells)):
            columns = [text for good, failed, why in limits for text in (f"{good:.3g}", f"{failed:.3g}", why)]
            rows.writerow([cell.name, cell.map, cell.x, cell.y, options.backend, *columns])
            file.flush()
            print(f"{columns[0]:>6} {columns[3]:>6}  {cell.name}: {columns[2]}; {columns[5]}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
