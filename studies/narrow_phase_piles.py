#!/usr/bin/python3
"""Lets 1,000 rocks come to rest (configs/studies/rock_pile.toml) by each narrow phase, and writes how high they lie and what each run took
as a CSV for narrow_phases.py. A run that is stopped has no row; its reason is printed.

Needs Debian's python3-h5py and python3-numpy, and a built tread.
"""

import argparse
import itertools
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post import RunError
from tread_post.study import STOPPED, run_scene, write_table

SCENE = Path(__file__).resolve().parents[1] / "configs" / "studies" / "rock_pile.toml"
FIELDS = ("narrow_phase", "nodes", "sdf_cells", "seed", "height_m", "speed_m_s", "energy_error", "steps", "wall_s")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tread", default="tread", help="the program; default: tread")
    parser.add_argument("--output", type=Path, default=Path("narrow_phase_piles.csv"), metavar="FILE.csv")
    parser.add_argument("--nodes", type=int, nargs="+", default=(42, 162, 642, 2562))
    parser.add_argument("--cells", type=int, nargs="+", default=(32, 64, 128), help="of distance fields")
    parser.add_argument("--ray-cells", type=int, default=64, help="of the distance field that lists the nodes for rays; default 64")
    parser.add_argument("--seeds", type=int, nargs="+", default=(1, 2, 3), help="of the places where the rocks start")
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", dest="more", help="of the scene, to try the script out")
    return parser.parse_args()


def variants(options):
    for nodes in options.nodes:
        for cells in options.cells:
            yield "sdf", nodes, cells
        yield "rays", nodes, options.ray_cells


def measure(run):
    """Mean height of the rocks' centres by their energy in gravity, their speed (rms) at the end, and the error of the energy's balance."""
    scene, energy = run.scene, run.energy
    rocks, material = scene["rocks"][0], scene["material"][0]
    mass = rocks["count"] * material["density"] * np.pi / 6 * rocks["diameter"] ** 3
    height = energy["gravity"][-1] / (mass * -scene["domain"]["gravity"][2])
    speed = np.sqrt(2 * energy["kinetic_bodies"][-1] / mass)
    total = energy["total"]
    return float(height), float(speed), float((total[-1] - total[0]) / total[0])


def main():
    options = arguments()
    rows = []
    for (phase, nodes, cells), seed in itertools.product(variants(options), options.seeds):
        with tempfile.TemporaryDirectory() as folder:
            settings = (f"numerics.narrow_phase={phase}", f"shape[0].generate.nodes={nodes}", f"shape[0].sdf_cells={cells}",
                        f"rocks[0].seed={seed}", *options.more)
            code, run = run_scene(options, SCENE, settings, Path(folder) / "run", ends=(0, STOPPED))
            if code == STOPPED:
                print(phase, nodes, cells, seed, run.summary["reason"], sep=", ", flush=True)
                continue
            height, speed, error = measure(run)
            rows.append(dict(zip(FIELDS, (phase, nodes, cells, seed, f"{height:.6g}", f"{speed:.2e}", f"{error:.2e}", run.summary["steps"],
                                          f"{run.summary['wall_s']:.2f}"))))
        print(*rows[-1].values(), sep=", ", flush=True)
    write_table(options.output, FIELDS, rows)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"narrow_phase_piles: {error}")
