#!/usr/bin/python3
"""Static sinkage of wheels that were put on sand, beside that from bearing capacity.

One line for each run: the load that the sand carries, how deep the wheel is under the surface when the phase ends, and how deep it would be where the
bearing capacity of its contact patch equals its load. Needs Debian's python3-h5py and python3-numpy.
"""

import argparse
import math
import sys
from pathlib import Path

import numpy as np

from tread_post import Run, RunError


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("runs", type=Path, nargs="+", metavar="RUN", help="output directories")
    parser.add_argument("--phase", default="lower", metavar="NAME", help="at whose end the depth is read; default: lower")
    parser.add_argument("--wheel", type=float, nargs=2, required=True, metavar=("RADIUS", "WIDTH"), help="of the wheels, m; the radius over the grousers")
    return parser.parse_args()


def bearing_capacity(depth, radius, width, unit_weight, friction):
    """N, of a patch of the wheel's width and 2 sqrt(2 R z - z^2) of its length, by Meyerhof (1963): N_q and N_gamma of strips with his factors for the shape of
    a rectangle. The patch is a circle's segment: its mean depth, two thirds of z, is what its sides weigh down."""
    length = 2 * math.sqrt(2 * radius * depth - depth ** 2)
    short, long = sorted((length, width))
    passive = math.tan(math.pi / 4 + friction / 2) ** 2
    n_q = math.exp(math.pi * math.tan(friction)) * passive
    n_gamma = (n_q - 1) * math.tan(1.4 * friction)
    shape = 1 + 0.1 * passive * short / long
    return shape * unit_weight * (0.5 * short * n_gamma + 2 / 3 * depth * n_q) * length * width


def depth_for(load, radius, *sand):
    """m, where the capacity equals the load: the capacity grows with depth."""
    low, high = 0.0, radius
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if bearing_capacity(middle, radius, *sand) < load else (low, middle)
    return high


def row_of(run, phase, radius, width):
    scene, name = run.scene, run.wheels[0]
    starts = {begun.name: begun.start for begun in run.phases}
    if phase not in starts:
        raise RunError(f"{run.path}: no phase '{phase}' has begun")
    wheel = run.wheel(name)
    after = min((start for start in starts.values() if start > starts[phase]), default=np.inf)
    rows = np.flatnonzero((wheel["time"] > starts[phase]) & (wheel["time"] <= after + 1e-9))
    gravity = math.sqrt(sum(part ** 2 for part in scene["domain"]["gravity"]))
    body, = (table for table in scene["body"] if table["name"] == name)
    load = body["load"] if "load" in body else body["mass"] * gravity
    sand = next(material for material in scene["material"] if material["name"] == scene["terrain"][0]["material"])
    expected = depth_for(load, radius, width, sand["density"] * gravity, math.radians(sand["friction_angle_deg"]))
    return load, wheel["force"][rows[-1], 2], wheel["sinkage"][rows[-1]], expected


def main():
    options = arguments()
    print(f"{'run':<32} {'load, N':>9} {'force, N':>9} {'sinkage, mm':>12} {'by bearing capacity, mm':>24} {'ratio':>6}")
    for path in options.runs:
        load, force, depth, expected = row_of(Run(path), options.phase, *options.wheel)
        print(f"{path.name:<32} {load:9.1f} {force:9.1f} {1e3 * depth:12.1f} {1e3 * expected:24.1f} {depth / expected:6.2f}")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"error: {error}")
