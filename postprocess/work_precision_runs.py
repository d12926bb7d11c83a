#!/usr/bin/python3
"""Runs the cases of configs/studies over spacing, points a cell, transfer and precision, and writes what each cost and how wrong it was
as a CSV for work_precision.py.

Needs Debian's python3-h5py and python3-numpy, and a built tread.
"""

import argparse
import csv
import itertools
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np

from tread_post import Run, RunError

SCENES = Path(__file__).resolve().parents[1] / "configs" / "studies"
FIELDS = ("case", "quantity", "spacing", "points_per_cell", "transfer", "precision", "points", "steps", "wall_s", "error",
          "reference")


def column_stress(run):
    """Root mean square error of sigma_zz against the weight above, over that at the floor, per layer of points."""
    last = run.points(run.snapshots[-1])
    scene = run.scene
    weight = scene["material"][0]["density"] * -scene["domain"]["gravity"][2]
    top = scene["terrain"][0]["region"]["box"][1][2]
    layers = np.unique(np.round(run.points(0).position[:, 2], 9))
    start = np.round(last.position[:, 2] - last.fields["displacement"][:, 2], 6)
    errors = []
    for height in layers:
        here = np.abs(start - height) < 1e-5
        errors.append(np.mean(last.fields["stress"][here, 2]) + weight * (top - height))
    return float(np.sqrt(np.mean(np.square(errors))) / (weight * top)), "rho g depth"


def bar_period(run):
    """Error of the period, from the zeros of the momentum, which stand at multiples of T/2."""
    time, momentum = run.balance["time"], run.balance["momentum"][:, 0]
    crossing = np.nonzero(momentum[1:-1] * momentum[2:] < 0)[0] + 1
    zeros = time[crossing] - momentum[crossing] * (time[crossing + 1] - time[crossing]) / (
        momentum[crossing + 1] - momentum[crossing])
    period = 2 * zeros[-1] / len(zeros)
    return float(abs(period / 0.04 - 1)), "T = 4 L/c"


def bar_energy(run):
    """Loss of the kinetic energy's peak from the first period to the last."""
    time, kinetic = run.energy["time"], run.energy["kinetic_points"]
    first, last = kinetic[time < 0.04].max(), kinetic[(time > 0.16) & (time < 0.2)].max()
    return float(abs(last / first - 1)), "none lost in four periods"


def run_out(run):
    """How far the front is, m: 99 % of the points are behind it."""
    return float(np.quantile(run.points(run.snapshots[-1]).position[:, 0], 0.99))


@dataclass(frozen=True)
class Case:
    scene: str
    spacings: tuple[float, ...]
    measures: dict[str, Callable]


CASES = {
    "column": Case("column.toml", (0.1, 0.05, 0.025), {"rms error of sigma_zz over that at the floor": column_stress}),
    "bar": Case("bar.toml", (0.05, 0.025, 0.0125), {"error of the period": bar_period, "energy lost": bar_energy}),
    "collapse": Case("collapse.toml", (0.05, 0.025, 0.0125), {"error of the run-out": run_out}),
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tread", default="tread", help="the program; default: tread")
    parser.add_argument("--output", type=Path, default=Path("work_precision.csv"), metavar="FILE.csv")
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--levels", type=int, default=3, help="spacings of a case, from its coarsest; default 3")
    parser.add_argument("--points-per-cell", type=int, nargs="+", default=(1, 8))
    parser.add_argument("--transfers", nargs="+", default=("flip", "apic"))
    parser.add_argument("--precisions", nargs="+", default=("single", "double"))
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--threads", type=int, default=1)
    return parser.parse_args()


def run_one(options, case, settings, folder):
    command = [options.tread, "run", str(SCENES / case.scene), "--output", str(folder), "--quiet", "--backend",
               options.backend, "--threads", str(options.threads)]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    ended = subprocess.run(command, capture_output=True, text=True)
    if ended.returncode != 0:
        raise RunError(f"{' '.join(command)}: exit {ended.returncode}: {ended.stderr.strip()}")
    return Run(folder)


def rows_of(options, name):
    case = CASES[name]
    for spacing, points, transfer, precision in itertools.product(case.spacings[: options.levels], options.points_per_cell,
                                                                  options.transfers, options.precisions):
        settings = {"grid.spacing": spacing, "terrain[0].points_per_cell": points, "numerics.transfer": transfer,
                    "numerics.precision": precision}
        with tempfile.TemporaryDirectory() as folder:
            run = run_one(options, case, settings, Path(folder) / "run")
            summary = run.summary
            for quantity, measure in case.measures.items():
                measured = measure(run)
                error, reference = measured if isinstance(measured, tuple) else (measured, "")
                yield dict(zip(FIELDS, (name, quantity, spacing, points, transfer, precision, summary["points"],
                                        summary["steps"], round(summary["wall_s"], 4), error, reference)))


def against_finest(rows):
    """A case without a closed form is measured against its own most expensive run in double precision; that run and its
    twin in single say nothing then."""
    open_rows = [row for row in rows if not row["reference"]]
    if not open_rows:
        return
    finest = max(open_rows, key=lambda row: (row["points"], row["precision"] == "double", row["transfer"] == "flip"))
    value = finest["error"]
    for row in open_rows:
        row["reference"] = f"{value:.6g} m, the finest run"
        row["error"] = abs(row["error"] / value - 1)
    same = ("spacing", "points_per_cell", "transfer")
    rows[:] = [row for row in rows if row not in open_rows or any(row[key] != finest[key] for key in same)]


def main():
    options = arguments()
    rows = []
    for name in options.cases:
        of_case = []
        for row in rows_of(options, name):
            of_case.append(row)
            print(*(f"{row[field]}" for field in FIELDS[:-2]), sep=", ", flush=True)
        against_finest(of_case)
        rows += of_case
    with open(options.output, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"work_precision_runs: {error}")
