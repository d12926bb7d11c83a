#!/usr/bin/python3
"""Drops a wheel on rocks and sand with 1 to 200 substeps a step, and writes the force, its error and the time of each run as a CSV for
substeps.py: the paper's Fig. 11.

The paper does not say which of the two steps it kept: `fixed step` keeps the step of the sand, `fixed substep` that of the bodies.

Needs Debian's python3-h5py and python3-numpy, and a built tread.
"""

import argparse
import sys
import tempfile
import tomllib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post import RunError
from tread_post.study import STOPPED, processor_time, run_scene, write_table

SCENE = Path(__file__).resolve().parents[1] / "configs" / "paper" / "reduced" / "wheel_drop_substeps.toml"
FIELDS = ("reading", "substeps", "dt_s", "substep_s", "young_Pa", "status", "peak_N", "rest_over_weight", "deepest_mm",
          "energy_error", "steps", "cpu_s", "reason")
EVERY = 1e-3  # s, of the time series: forces are means over so long
REST = 0.2  # s, the end of the run over which the force at rest is a mean


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tread", default="tread", help="the program; default: tread")
    parser.add_argument("--scene", type=Path, default=SCENE, help="default: the small twin of the paper's scene")
    parser.add_argument("--step", type=float, default=4e-4, help="s, that `fixed step` keeps; default 4e-4 (the full scene's: 4e-5)")
    parser.add_argument("--substep", type=float, default=4e-6, help="s, that `fixed substep` keeps; default 4e-6 (the full scene's: 4e-7)")
    parser.add_argument("--substeps", type=int, nargs="+", default=(1, 2, 5, 10, 20, 50, 100, 200))
    parser.add_argument("--young", type=float, nargs="+", default=(1e7, 1e9), help="Pa, of the rocks; `fixed substep` takes the first alone")
    parser.add_argument("--output", type=Path, default=Path("substeps.csv"), metavar="FILE.csv")
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--threads", type=int, default=1)
    return parser.parse_args()


def cases(options):
    """Reading, substeps, step (s), Young's modulus of the rocks (Pa)."""
    for young in options.young:
        for substeps in ("auto", *options.substeps):
            yield "fixed step", substeps, options.step, young
    for substeps in sorted(options.substeps, reverse=True):
        yield "fixed substep", substeps, substeps * options.substep, options.young[0]


def measures(run):
    """Largest vertical force on the wheel once it is let go (N), the mean at the end over its weight, the lowest place of its centre below
    the first (mm), and the error of the energy's balance."""
    scene, wheel = run.scene, run.wheel("wheel")
    time, force, height = wheel["time"], wheel["force"][:, 2], wheel["position"][:, 2]
    falls = time > run.phases[-1].start
    weight = scene["body"][0]["mass"] * -scene["domain"]["gravity"][2]
    rest = force[time > time[-1] - REST].mean() / weight
    return force[falls].max(), rest, 1e3 * (height[0] - height[falls].min()), run.summary["errors"]["energy"]


def rock_of(scene):
    """Index of the rocks' material."""
    with open(scene, "rb") as file:
        return [material["name"] for material in tomllib.load(file)["material"]].index("rock")


def row_of(options, reading, substeps, step, young, folder):
    value = f'"{substeps}"' if substeps == "auto" else substeps
    settings = (f"time.dt={step}", f"time.substeps={value}", f"output.every={EVERY}", f"material[{rock_of(options.scene)}].young={young}")
    before = processor_time()
    code, run = run_scene(options, options.scene, settings, folder, ends=(0, STOPPED))
    row = dict.fromkeys(FIELDS, "")
    row.update(reading=reading, substeps=substeps, dt_s=f"{step:g}", young_Pa=f"{young:g}", cpu_s=f"{processor_time() - before:.2f}")
    summary = run.summary
    row.update(status=summary["status"], steps=summary["steps"])
    if summary["steps"] > 0:
        row.update(substep_s=f"{summary['time'] / summary['substeps']:.3g}")
    if code == STOPPED:
        row.update(reason=summary["reason"])
        return row
    peak, rest, deepest, energy = measures(run)
    row.update(peak_N=f"{peak:.6g}", rest_over_weight=f"{rest:.4f}", deepest_mm=f"{deepest:.3f}", energy_error=f"{energy:.2e}")
    return row


def main():
    options = arguments()
    rows = []
    for case in cases(options):
        with tempfile.TemporaryDirectory() as folder:
            rows.append(row_of(options, *case, Path(folder) / "run"))
        print(*rows[-1].values(), sep=", ", flush=True)
    write_table(options.output, FIELDS, rows)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"substep_runs: {error}")
