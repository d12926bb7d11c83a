#!/usr/bin/python3
"""Makes the table of docs/transfers.md: what a swinging bar keeps of its energy, and how deep a spinning wheel digs itself
into sand, by transfer, filter and Courant number c_p dt/h. Some minutes.

Needs Debian's python3-h5py and python3-numpy, and a built tread.
"""

import argparse
import itertools
import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

from tread_post import RunError
from tread_post.closed_forms import FORMS
from tread_post.study import run_scene

SCHEMES = (("flip", 0.0), ("flip", 0.04), ("flip", 0.2), ("apic", None), ("aflip", 0.0), ("aflip", 0.04), ("aflip", 0.2))
COURANT = (0.4, 0.1, 0.01)


@dataclass(frozen=True)
class Case:
    name: str
    scene: str
    spacing: float  # m
    wave_speed: float  # m/s
    measure: Callable  # of a run: text


def bar_left(run):
    return f"{FORMS['fixed-free-bar'].quantities['energy_kept'].measure(run):.3f}"


def wheel_sinkage(run):
    return f"{1e3 * run.wheel('wheel')['sinkage'][-1]:.1f} mm"


CASES = (Case("bar", "bar.toml", 0.05, 100.0, bar_left),
         Case("wheel", "spinning_wheel.toml", 0.04, math.sqrt(1.0e6 * 0.7 / (1.3 * 0.4) / 1600.0), wheel_sinkage))


def measured(options, case, scheme, courant):
    transfer, rate = scheme
    settings = {"numerics.transfer": transfer, "numerics.precision": "double", "grid.spacing": case.spacing,
                "time.dt": courant * case.spacing / case.wave_speed}
    if rate is not None:
        settings["numerics.pic_rate"] = rate
    with tempfile.TemporaryDirectory() as folder:
        _, run = run_scene(options, ROOT / "configs" / "studies" / case.scene, [f"{key}={value}" for key, value in settings.items()], Path(folder) / "run")
        return case.measure(run)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tread", default="tread", help="the program; default: tread")
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    columns = list(itertools.product(CASES, COURANT))
    print("| transfer | pic_rate |", *(f"{case.name} {courant} |" for case, courant in columns))
    print("|" + "---|" * (2 + len(columns)))
    for scheme in SCHEMES:
        values = (measured(options, case, scheme, courant) for case, courant in columns)
        print(f"| {scheme[0]} | {'' if scheme[1] is None else scheme[1]} |", *(f"{value} |" for value in values), flush=True)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"transfers: {error}")
