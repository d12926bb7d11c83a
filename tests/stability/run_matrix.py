#!/usr/bin/env python3
"""Runs the stability matrix, and writes what each cell was as CSV; exit 1 if one was not what it may be.

  tests/stability/run_matrix.py --tread build/bin/tread --steps 100000 --jobs 16 --output stability.csv

Needs Debian's python3-h5py and python3-numpy. studies/stability_map.py draws the table.
"""

import argparse
import csv
import os
import re
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from cells import HERE, Program, read_matrix, run_cell

FIGURES = ("steps", "substeps", "time", "wall_s", "energy_held", "kinetic", "energy_error", "momentum", "mass", "body_overlap",
           "point_overlap", "host_bytes", "verdict")
# Of the first step of rocks alone, which fall freely then: contacts take a tenth of it.
LATER_STEPS = {"rocks": 0.1}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tread", type=Path, default=os.environ.get("TREAD", "tread"), metavar="PROGRAM", help="default: $TREAD, or tread")
    parser.add_argument("--backend", choices=("cpu", "cuda"), default="cpu", help="default: cpu")
    parser.add_argument("--matrix", type=Path, default=HERE / "matrix.toml", metavar="FILE.toml", help="default: matrix.toml beside this")
    parser.add_argument("--steps", type=int, default=100000, help="about how many a cell; default: 100000")
    parser.add_argument("--wall", type=float, default=3600, metavar="SECONDS", help="at most, a cell: it is judged by what it did until then")
    parser.add_argument("--jobs", type=int, default=1, help="cells at a time; default: 1")
    parser.add_argument("--only", default="", metavar="REGEX", help="cells whose names it is found in")
    parser.add_argument("--output", type=Path, default=Path("stability.csv"), metavar="FILE.csv", help="default: stability.csv")
    return parser.parse_args()


def say(done, count, cell, result):
    mark = " " if result.expected else "!"
    print(f"{done:4}/{count} {mark} {result.outcome:8} {cell.name}" + (f": {result.reason}" if result.reason else ""), flush=True)


def write(path, backend, pairs):
    with open(path, "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["name", "map", "x", "y", "x_label", "y_label", "backend", "outcome", "expected", *FIGURES, "reason"])
        for cell, result in pairs:
            figures = [f"{value:.6g}" if isinstance(value, float) else value for value in (result.figures.get(name, "") for name in FIGURES)]
            rows.writerow([cell.name, cell.map, cell.x, cell.y, cell.x_label, cell.y_label, backend, result.outcome, "yes" if result.expected else "no", *figures,
                           result.reason])


def main():
    options = arguments()
    program = Program(options.tread, options.backend)
    cells = [cell for cell in read_matrix(options.matrix) if re.search(options.only, cell.name)]
    results, lock = {}, threading.Lock()

    def run(cell):
        results[cell.name] = run_cell(program, cell, cell.steps * options.steps, options.wall, steps_of_first=LATER_STEPS.get(cell.scene, 1.0))
        with lock:
            say(len(results), len(cells), cell, results[cell.name])
            write(options.output, options.backend, [(one, results[one.name]) for one in cells if one.name in results])

    with ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(run, reversed(cells)))  # among the last is one that takes as long as thirty others
    pairs = [(cell, results[cell.name]) for cell in cells]
    counts = {outcome: sum(result.outcome == outcome for _, result in pairs) for outcome in ("stable", "told", "stopped", "refused", "wrong")}
    unexpected = sum(not result.expected for _, result in pairs)
    print(", ".join(f"{count} {outcome}" for outcome, count in counts.items()) + f"; {unexpected} not as they may be")
    return 1 if unexpected else 0


if __name__ == "__main__":
    sys.exit(main())
