#!/usr/bin/env python3
"""Void of a settled bed of sand and rocks: 1 - (points + rocks) / box, in a box under its surface."""

import argparse

import h5py
import numpy


def share_below(height, reach, top):
    """Share of a cube of half width `reach` about `height` that lies below `top`."""
    return numpy.clip((top - height + reach) / (2 * reach), 0, 1)


def cap_below(height, radius, top):
    """Share of a sphere's volume that lies below `top`."""
    depth = numpy.clip((top - height + radius) / (2 * radius), 0, 1)
    return depth**2 * (3 - 2 * depth)


def fractions(path, size, top):
    """Volume fractions of sand, rock and void in the box from 0 to size and `top` (m)."""
    with h5py.File(path) as bed:
        points, volume = bed["points/position"][:], bed["points/volume"][:]
        rocks, diameter = bed["rocks/position"][:], bed["rocks/diameter"][:]
    box = size[0] * size[1] * top
    sand = (volume * share_below(points[:, 2], 0.5 * numpy.cbrt(volume), top)).sum() / box
    rock = (numpy.pi / 6 * diameter**3 * cap_below(rocks[:, 2], 0.5 * diameter, top)).sum() / box
    return sand, rock, 1 - sand - rock


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bed", help="bed.h5 of a run with [output] bed_after")
    parser.add_argument("--size", type=float, nargs=2, required=True, metavar=("X", "Y"), help="of the bed in plan, m")
    parser.add_argument("--top", type=float, nargs="+", required=True, help="heights below the surface, m")
    options = parser.parse_args()
    for top in options.top:
        sand, rock, void = fractions(options.bed, options.size, top)
        print(f"below {top:g} m: {100 * sand:.2f} % sand, {100 * rock:.2f} % rock, {100 * void:.2f} % void")


if __name__ == "__main__":
    main()
