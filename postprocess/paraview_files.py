#!/usr/bin/python3
"""Wheels, tools and rocks of a run as files for ParaView, with time and what moves them, beside the sand that it opens as it is.

Writes bodies.pvd (the [[body]] tables) and rocks.pvd, and beside them a .vtp a snapshot: docs/looking.md defines what they hold.
Needs Debian's python3-h5py and python3-numpy.

    tread post paraview_files runs/quickstart
    paraview runs/quickstart/paraview/bodies.pvd
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from tread_post import Run, RunError
from tread_post.detail import choose_levels, levels_of
from tread_post.surfaces import mesh_of
from tread_post.vtp import write_collection, write_triangles


def whole_number(text):
    number = int(float(text))
    if number < 1000:
        raise argparse.ArgumentTypeError(f"{text}: at least 1000")
    return number


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run with snapshots")
    parser.add_argument("--output", type=Path, metavar="DIR", help="default: RUN/paraview")
    parser.add_argument("--triangles", type=whole_number, default=2_000_000, metavar="N",
                        help="of all rocks in a snapshot, at most; rocks with more get coarser surfaces of the same volume; default: 2e6")
    parser.add_argument("--overwrite", action="store_true", help="replace the files of these names")
    return parser.parse_args()


class Parts:
    """The bodies of a run in two parts: those of [[body]] tables, and rocks."""

    def __init__(self, run, most):
        self.run, self.most = run, most
        self.levels = [levels_of(shape) for shape in run.shapes]
        self.names = [body.get("name", f"body {row}") for row, body in enumerate(run.scene.get("body", []))]
        self.histories = {row: run.wheel(name) for row, name in enumerate(self.names) if name in run.wheels}

    def rows(self, bodies):
        """Rows of the bodies by the name of their part; a part without bodies is left out."""
        named = min(len(self.names), len(bodies.shape))
        parts = {"bodies": np.arange(named), "rocks": np.arange(named, len(bodies.shape))}
        return {name: rows for name, rows in parts.items() if len(rows)}

    def write(self, part, rows, bodies, path):
        """Writes a part at the time of `bodies`. Returns the triangles that its true surfaces have, and those that it was written with."""
        chosen = choose_levels(self.levels, bodies, rows, self.most) if part == "rocks" else np.zeros(len(rows), int)
        mesh = mesh_of(bodies, rows, self.levels, chosen)
        fields = {"id": np.arange(len(bodies.shape), dtype=np.int32), "shape": bodies.shape.astype(np.int32),
                  "scale": bodies.scale.astype(np.float32)}
        fields |= {name: values.astype(np.int32 if values.dtype.kind in "iu" else np.float32) for name, values in bodies.fields.items()}
        if part == "bodies":
            fields |= self._wrenches(bodies.time)
        write_triangles(path, bodies.time, mesh.vertices, mesh.triangles, {name: values[mesh.body] for name, values in fields.items()},
                        self.names if part == "bodies" else ())
        true = np.array([len(levels[0].surface.triangles) for levels in self.levels])
        return int(true[bodies.shape[rows]].sum()), len(mesh.triangles)

    def _wrenches(self, time):
        """Contact force (N) and torque (N m) of the [[body]] tables, means over the row of the time series that holds `time`."""
        found = {name: np.full((len(self.names), 3), np.nan, np.float32) for name in ("force", "torque")}
        for row, history in self.histories.items():
            at = min(int(np.searchsorted(history["time"], time)), len(history["time"]) - 1)
            if at >= 0:
                for name, values in found.items():
                    values[row] = history[name][at]
        return found


def require_free(paths):
    taken = [path for path in paths if path.exists()]
    if taken:
        raise RunError(f"{taken[0]}: exists; --overwrite replaces it, --output DIR writes elsewhere")


def write_series(run, folder, most, overwrite):
    """Writes all snapshots with bodies into `folder`. Yields what to say about it."""
    snapshots = {number: bodies for number in run.snapshots if (bodies := run.bodies(number)) is not None}
    if not snapshots:
        raise RunError(f"{run.path / 'snapshots'}: no snapshot has bodies")
    parts = Parts(run, most)
    names = parts.rows(next(iter(snapshots.values())))
    files = {part: [(bodies.time, f"{part}_{number:04}.vtp") for number, bodies in snapshots.items()] for part in names}
    if not overwrite:
        require_free([folder / name for part, listed in files.items() for name in (f"{part}.pvd", *(name for _, name in listed))])
    folder.mkdir(parents=True, exist_ok=True)
    for part, listed in files.items():
        for (_, name), bodies in zip(listed, snapshots.values()):
            true, written = parts.write(part, parts.rows(bodies)[part], bodies, folder / name)
        write_collection(folder / f"{part}.pvd", listed)
        coarser = f", {written} triangles of {true}: coarser, of the same volumes" if written < true else ""
        yield f"{folder / part}.pvd: {len(names[part])} {part}, {len(listed)} snapshots{coarser}"


def main():
    options = arguments()
    run = Run(options.run)
    for line in write_series(run, options.output or options.run / "paraview", options.triangles, options.overwrite):
        print(line)
    if run.points_times:
        print(f"{options.run / 'snapshots' / 'points.hdf.series'}: the sand, which ParaView opens as it is")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"paraview_files: {error}")
