#!/usr/bin/env python3
"""Measures the sand at the rim of a drum in snapshots of runs of configs/ladder, and draws it: docs/ladder.md.

    studies/rim_profiles.py measure --radius 0.24 --last 12 OUTPUT.csv CELLS=RUN CELLS=RUN ...
    /usr/bin/python3 studies/rim_profiles.py draw OUTPUT.csv PICTURE.png

CELLS is the count of cells across the radius. Means over the last snapshots and over sectors of ten degrees; angles are taken from straight below the axle, positive ahead. Depth is the distance from the rim, into the sand.
"""

import argparse
import csv
import pathlib

import numpy

SECTOR = numpy.radians(5.0)  # half of it
SECTORS = (-20, 0, 20, 40)  # degrees
FIELDS = ("cells", "angle [deg]", "depth [mm]", "speed over the rim's", "shear rate [1/s]", "pressure [kPa]", "shear [kPa]")


def snapshots(run: pathlib.Path, last: int):
    """Yields points, their fields and the body's state of each of the last snapshots."""
    import h5py

    for path in sorted((run / "snapshots").glob("points_*.hdf"))[-last:]:
        with h5py.File(path) as points, h5py.File(path.with_name(path.name.replace("points", "bodies")).with_suffix(".h5")) as bodies:
            fields = points["VTKHDF/PointData"]
            yield (
                points["VTKHDF/Points"][:],
                {name: fields[name][:] for name in ("velocity", "plastic_rate", "stress")},
                {name: bodies[name][:] for name in ("position", "velocity", "angular_velocity")},
            )


def around(points, fields, axle, velocity, spin, radius):
    """Returns angle, depth, speed along the rim over the rim's own, shear rate, and traction of each point."""
    offset = points - axle
    distance = numpy.hypot(offset[:, 0], offset[:, 2])
    out = numpy.stack([offset[:, 0], offset[:, 2]]) / distance
    along = numpy.stack([out[1], -out[0]]) * numpy.sign(spin)  # way of the rim
    relative = numpy.stack([fields["velocity"][:, 0] - velocity[0], fields["velocity"][:, 2] - velocity[2]])
    stress = fields["stress"]  # xx, yy, zz, yz, xz, xy
    traction = numpy.stack([stress[:, 0] * out[0] + stress[:, 4] * out[1], stress[:, 4] * out[0] + stress[:, 2] * out[1]])
    return {
        "angle": numpy.arctan2(offset[:, 0], -offset[:, 2]),
        "depth": distance - radius,
        "speed": (relative * along).sum(axis=0) / (abs(spin) * distance),
        "rate": fields["plastic_rate"],
        "pressure": -(traction * out).sum(axis=0),
        "shear": (traction * along).sum(axis=0),
    }


def profile(samples, cells: int, radius: float):
    """Yields a row for each half cell of depth in each sector that has sand."""
    half = 0.5 * radius / cells
    for angle in SECTORS:
        near = abs(samples["angle"] - numpy.radians(angle)) < SECTOR
        layer = numpy.floor(samples["depth"] / half).astype(int)
        for depth in range(int(0.6 * radius / half)):
            those = near & (layer == depth)
            if those.sum() < 3:
                continue
            mean = {name: values[those].mean() for name, values in samples.items()}
            yield (cells, angle, 1e3 * mean["depth"], mean["speed"], mean["rate"], 1e-3 * mean["pressure"], 1e-3 * mean["shear"])


def measure(arguments) -> None:
    rows = []
    for run in arguments.runs:
        cells, path = run.split("=", 1)
        parts = []
        for points, fields, body in snapshots(pathlib.Path(path), arguments.last):
            state = {name: values[arguments.body] for name, values in body.items()}
            parts.append(around(points, fields, state["position"], state["velocity"], state["angular_velocity"][1], arguments.radius))
        samples = {name: numpy.concatenate([part[name] for part in parts]) for name in parts[0]}
        rows += profile(samples, int(cells), arguments.radius)
    with open(arguments.table, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(FIELDS)
        writer.writerows([cells, angle, *(f"{value:.5g}" for value in values)] for cells, angle, *values in rows)
    print_bands(rows, arguments.radius)


def print_bands(rows, radius: float) -> None:
    """Prints the breadth of the band: the integral of the shear rate over depth by its largest value."""
    for cells in sorted({row[0] for row in rows}):
        spacing = 1e3 * radius / cells
        for angle in SECTORS:
            own = numpy.array([row[2:] for row in rows if row[0] == cells and row[1] == angle])
            if len(own) < 4:
                continue
            depth, rate = own[:, 0], own[:, 2]
            breadth = (0.5 * (rate[1:] + rate[:-1]) * numpy.diff(depth)).sum() / rate.max()
            print(
                f"n = {cells}, {angle:4d} deg: band {breadth:6.1f} mm, {breadth / spacing:5.2f} cells; greatest rate {rate.max():7.2f}/s at "
                f"{depth[rate.argmax()]:6.1f} mm; first layer: {own[0, 1]:.3f} of the rim's speed, pressure {own[0, 3]:.2f}, shear {own[0, 4]:.2f} kPa"
            )


def draw(arguments) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    with open(arguments.table, newline="") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    figure, axes = plt.subplots(2, len(SECTORS), figsize=(11, 5.5), layout="constrained", sharey=True)
    for column, angle in zip(axes.T, SECTORS):
        for cells in sorted({row["cells"] for row in rows}):
            own = [row for row in rows if row["cells"] == cells and row["angle [deg]"] == angle]
            for axis, quantity in zip(column, FIELDS[3:5]):
                axis.plot([row[quantity] for row in own], [row["depth [mm]"] for row in own], label=f"R/h = {cells:.0f}")
                axis.set_xlabel(quantity)
        column[0].set_title(f"{angle} degrees")
    for axis in axes[:, 0]:
        axis.set_ylabel("depth [mm]")
    axes[0, 0].invert_yaxis()
    axes[0, 0].legend()
    figure.savefig(arguments.picture, dpi=80)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    one = commands.add_parser("measure")
    one.add_argument("table")
    one.add_argument("runs", nargs="+", metavar="CELLS=RUN")
    one.add_argument("--radius", type=float, required=True, help="of the rim, m")
    one.add_argument("--body", type=int, default=0, help="index of the drum")
    one.add_argument("--last", type=int, required=True, help="count of snapshots")
    one.set_defaults(act=measure)
    two = commands.add_parser("draw")
    two.add_argument("table")
    two.add_argument("picture")
    two.set_defaults(act=draw)
    arguments = parser.parse_args()
    arguments.act(arguments)


if __name__ == "__main__":
    main()
