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
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "postprocess"))

from tread_post import RunError
from work_precision_runs import Case, bar_energy, run_one

SCHEMES = (("flip", 0.0), ("flip", 0.04), ("flip", 0.2), ("apic", None), ("aflip", 0.0), ("aflip", 0.04), ("aflip", 0.2))
COURANT = (0.4, 0.1, 0.01)


def bar_left(run):
    return f"{bar_energy(run)[0]:.3f}"


def wheel_sinkage(run):
    return f"{1e3 * run.wheel('wheel')['sinkage'][-1]:.1f} mm"


CASES = (Case("bar.toml", (0.05,), {"bar": bar_left}), Case("spinning_wheel.toml", (0.04,), {"wheel": wheel_sinkage}))
WAVE_SPEED = {"bar.toml": 100.0, "spinning_wheel.toml": math.sqrt(1.0e6 * 0.7 / (1.3 * 0.4) / 1600.0)}  # m/s


def measured(options, case, scheme, courant):
    transfer, rate = scheme
    spacing = case.spacings[0]
    settings = {"numerics.transfer": f'"{transfer}"', "numerics.precision": '"double"', "grid.spacing": spacing,
                "time.dt": courant * spacing / WAVE_SPEED[case.scene]}
    if rate is not None:
        settings["numerics.pic_rate"] = rate
    with tempfile.TemporaryDirectory() as folder:
        run = run_one(options, case, settings, Path(folder) / "run")
        return [measure(run) for measure in case.measures.values()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tread", default="tread", help="the program; default: tread")
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    columns = list(itertools.product(CASES, COURANT))
    print("| transfer | pic_rate |", *(f"{name} {courant} |" for case, courant in columns for name in case.measures))
    print("|" + "---|" * (2 + len(columns)))
    for scheme in SCHEMES:
        values = itertools.chain.from_iterable(measured(options, case, scheme, courant) for case, courant in columns)
        print(f"| {scheme[0]} | {'' if scheme[1] is None else scheme[1]} |", *(f"{value} |" for value in values), flush=True)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"transfers: {error}")
