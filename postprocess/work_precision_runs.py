#!/usr/bin/python3
"""Runs the cases of configs/studies over spacing, points a cell, transfer and precision, and writes what each cost and how wrong it was
as a CSV for work_precision.py.

Needs Debian's python3-h5py and python3-numpy, and a built tread.
"""

import argparse
import itertools
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np

from tread_post import RunError
from tread_post.study import processor_time, run_scene, write_table

SCENES = Path(__file__).resolve().parents[1] / "configs" / "studies"
FIELDS = ("case", "quantity", "spacing", "points_per_cell", "transfer", "precision", "points", "steps", "cpu_s",
          "measured", "error", "reference")


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
    error = np.sqrt(np.mean(np.square(errors))) / (weight * top)
    return error, error, "rho g depth"


def bar_period(run):
    """From the first to the last zero of the momentum, T/2 apart; all stand half a step late, as velocities do."""
    time, momentum = run.balance["time"], run.balance["momentum"][:, 0]
    crossing = np.nonzero(momentum[1:-1] * momentum[2:] < 0)[0] + 1
    zeros = time[crossing] - momentum[crossing] * (time[crossing + 1] - time[crossing]) / (
        momentum[crossing + 1] - momentum[crossing])
    period = 2 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
    return period, abs(period / 0.04 - 1), "T = 4 L/c"


def bar_energy(run):
    """Share that is left of the energy of swinging: all stores, over the energy that the bar has above its equilibrium
    at the start, (rho g)^2 L^3 A / (6 E)."""
    material, energy = run.scene["material"][0], run.energy
    stores = sum(energy[name] for name in ("kinetic_points", "half_step", "strain", "gravity"))
    length, width, height = run.scene["terrain"][0]["region"]["box"][1]
    weight = material["density"] * run.scene["domain"]["gravity"][0]
    left = 1 + (stores[-1] - stores[0]) / (weight**2 * length**3 * width * height / (6 * material["young"]))
    return left, abs(left - 1), "none lost in five periods"


def run_out(run):
    """How far beyond the column's foot 99 % of the points end, over its width, against 1.2 a of Lube et al. (2005) and
    Lajeunesse et al. (2005), who are 15 % apart."""
    width, _, height = run.scene["terrain"][0]["region"]["box"][1]
    ran = np.quantile(run.points(run.snapshots[-1]).position[:, 0], 0.99) / width - 1
    return ran, abs(ran / (1.2 * height / width) - 1), "1.2 a, right to 15 %"


@dataclass(frozen=True)
class Case:
    scene: str
    spacings: tuple[float, ...]
    measures: dict[str, Callable]


CASES = {
    "column": Case("column.toml", (0.1, 0.05, 0.025), {"rms error of sigma_zz over that at the floor": column_stress}),
    "bar": Case("bar.toml", (0.05, 0.025, 0.0125), {"error of the period": bar_period, "energy lost": bar_energy}),
    "collapse": Case("collapse.toml", (0.025, 0.0125, 0.00625), {"error of the run-out": run_out}),
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tread", default="tread", help="the program; default: tread")
    parser.add_argument("--output", type=Path, default=Path("work_precision.csv"), metavar="FILE.csv")
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--levels", type=int, default=3, help="spacings of a case, from its coarsest; default 3")
    parser.add_argument("--points-per-cell", type=int, nargs="+", default=(1, 8))
    parser.add_argument("--transfers", nargs="+", default=("aflip", "flip"))
    parser.add_argument("--precisions", nargs="+", default=("single", "double"))
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--threads", type=int, default=1)
    return parser.parse_args()


def rows_of(options, name):
    case = CASES[name]
    for spacing, points, transfer, precision in itertools.product(case.spacings[: options.levels], options.points_per_cell,
                                                                  options.transfers, options.precisions):
        settings = {"grid.spacing": spacing, "terrain[0].points_per_cell": points, "numerics.transfer": transfer,
                    "numerics.precision": precision}
        with tempfile.TemporaryDirectory() as folder:
            before = processor_time()
            _, run = run_scene(options, SCENES / case.scene, [f"{key}={value}" for key, value in settings.items()], Path(folder) / "run")
            spent, summary = processor_time() - before, run.summary
            for quantity, measure in case.measures.items():
                measured, error, reference = measure(run)
                yield dict(zip(FIELDS, (name, quantity, spacing, points, transfer, precision, summary["points"],
                                        summary["steps"], round(spent, 3), float(measured), float(error), reference)))


def main():
    options = arguments()
    rows = []
    for name in options.cases:
        for row in rows_of(options, name):
            rows.append(row)
            print(*(f"{row[field]}" for field in FIELDS[:-1]), sep=", ", flush=True)
    write_table(options.output, FIELDS, rows)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"work_precision_runs: {error}")
