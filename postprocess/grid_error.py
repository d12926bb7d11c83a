#!/usr/bin/python3
"""Convergence of a driven wheel over the grid's spacing: the rows of `measured_convergence` in src/run/grid_error.hpp.

Takes runs of one scene at three spacings or more. Fits answer = limit + slope / cells^order by least squares, cells being the run's own contact_cells;
the orders are those of the table (ORDERS), and the scatter about the fits of both orders is printed. Needs Debian's python3-h5py and python3-numpy.

    postprocess/grid_error.py --name "smooth drum on sand" runs/drum_20mm runs/drum_12mm runs/drum_7mm
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tread_post import Run, RunError
from tread_post.quantities import QUANTITIES, window_of

FEWEST = 3  # spacings, of two unknowns
ORDERS = {"pull": 1, "torque": 2, "sinkage": 1}  # fitted to the measured ladders of docs/verdict.md
COHESIVE = 5.0  # degrees, the friction angle under which a soil counts as cohesive


@dataclass(frozen=True)
class Law:
    """answer = limit + slope / cells^order; the error over `scale` is factor / cells^order."""

    limit: float
    slope: float
    order: int
    scatter: float  # rms of the answers about the fit
    scale: float  # what errors are shares of

    @property
    def factor(self):
        return abs(self.slope) / abs(self.scale)


def fit(cells, values, order, scale=None):
    """The Law of that order; `scale`: what errors are shares of, None for the limit itself."""
    powers = np.stack([np.ones(len(cells)), np.asarray(cells, float) ** -order], axis=1)
    (limit, slope), *_ = np.linalg.lstsq(powers, np.asarray(values, float), rcond=None)
    scatter = float(np.sqrt(np.mean((powers @ (limit, slope) - values) ** 2)))
    return Law(float(limit), float(slope), order, scatter, float(limit) if scale is None else scale)


def contact_cells(run):
    figures = (run.summary.get("resolution") or {}).get("figures", {})
    if "contact_cells" not in figures:
        raise RunError(f"{run.path}: summary.json has no contact_cells: no named body touched sand")
    return figures["contact_cells"]["value"]


def laws_of(runs):
    """Laws of pull, torque and sinkage by order, and the table that they were fitted to: a row (spacing, cells, pull, torque, sinkage) a run."""
    if len(runs) < FEWEST:
        raise RunError(f"{len(runs)} runs: a fit takes {FEWEST} spacings or more")
    rows = sorted((run.scene["grid"]["spacing"], contact_cells(run), *(QUANTITIES[name].measure(run) for name in ("drawbar_pull", "torque", "sinkage")))
                  for run in runs)
    spacing, cells, pull, torque, sinkage = np.array(rows).T
    if len(set(spacing)) < FEWEST:
        raise RunError(f"{len(set(spacing))} different spacings: a fit takes {FEWEST} or more")
    load = float(np.mean([np.mean(np.abs(window_of(run).force)) for run in runs]))
    answers = {"pull": (pull, load), "torque": (torque, None), "sinkage": (sinkage, None)}
    return {name: {order: fit(cells, values, order, scale) for order in (1, 2)} for name, (values, scale) in answers.items()}, rows


def soil_kind(scene):
    """That of the first terrain."""
    material = next(one for one in scene["material"] if one["name"] == scene["terrain"][0]["material"])
    return "cohesive" if material["friction_angle_deg"] < COHESIVE else "frictional"


def row_of(name, scene, laws):
    """Formats a row of measured_convergence."""
    numbers = ", ".join(f"{{{laws[key][order].factor:.2g}, {order}}}" for key, order in ORDERS.items())
    return f'{{"{name}", SoilKind::{soil_kind(scene)}, {{{numbers}}}}},'


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("runs", type=Path, nargs="+", metavar="RUN")
    parser.add_argument("--name", help="of the row; default: the scene's title")
    options = parser.parse_args()
    try:
        runs = [Run(path) for path in options.runs]
        laws, rows = laws_of(runs)
    except RunError as error:
        sys.exit(f"grid_error: {error}")
    print("spacing m   cells   pull N   torque N m   sinkage m")
    for row in rows:
        print("{:9.4g} {:7.3g} {:8.4g} {:12.4g} {:11.4g}".format(*row))
    for key, law in ((key, law) for key, orders in laws.items() for law in orders.values()):
        print(f"{key}: limit {law.limit:.4g}, order {law.order}, error {law.factor:.3g} / cells^{law.order}, rms about the fit {law.scatter:.2g}")
    print(row_of(options.name or runs[0].scene["title"], runs[0].scene, laws))


if __name__ == "__main__":
    main()
