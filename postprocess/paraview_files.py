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


def triangle_count(text):
    number = float(text)
    if not 1e3 <= number <= 1e9:
        raise argparse.ArgumentTypeError(f"{text}: accepted: 1000 to 1e9")
    return int(number)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="output directory of a run with snapshots")
    parser.add_argument("--output", type=Path, metavar="DIR", help="default: RUN/paraview")
    parser.add_argument("--triangles", type=triangle_count, default=2_000_000, metavar="N",
                        help="of all rocks in a snapshot, at most; rocks with more get coarser surfaces of the same volume; default: 2e6")
    parser.add_argument("--overwrite", action="store_true", help="replace the files of these names")
    return parser.parse_args()


class Parts:
    """The bodies of a run in two parts, "bodies" of [[body]] tables and "rocks"; rocks have at most `most` triangles together."""

    def __init__(self, run, most):
        self.most = {"bodies": np.inf, "rocks": most}
        self.levels = [levels_of(shape) for shape in run.shapes]
        self.triangles = np.array([len(levels[0].surface.triangles) for levels in self.levels])
        self.names = [body.get("name", f"body {row}") for row, body in enumerate(run.scene.get("body", []))]
        self.histories = {row: run.wheel(name) for row, name in enumerate(self.names) if name in run.wheels}

    def rows(self, bodies):
        """Rows of the bodies by the name of their part; a part without bodies is left out."""
        named = min(len(self.names), len(bodies.shape))
        parts = {"bodies": np.arange(named), "rocks": np.arange(named, len(bodies.shape))}
        return {part: rows for part, rows in parts.items() if len(rows)}

    def write(self, part, rows, bodies, path):
        """Writes a part as it is in `bodies`. Returns what to say of its triangles: nothing if they are those of the true surfaces."""
        mesh = mesh_of(bodies, rows, self.levels, choose_levels(self.levels, bodies, rows, self.most[part]))
        fields = {"id": np.arange(len(bodies.shape)), "shape": bodies.shape, "scale": bodies.scale} | bodies.fields
        if part == "bodies":
            fields |= self._wrenches(bodies.time)
        of_triangles = {name: _single(values)[mesh.body] for name, values in fields.items()}
        write_triangles(path, bodies.time, mesh.vertices, mesh.triangles, of_triangles, self.names if part == "bodies" else ())
        true = self.triangles[bodies.shape[rows]].sum()
        return f", {len(mesh.triangles)} triangles of {true}: coarser, of the same volumes" if len(mesh.triangles) < true else ""

    def _wrenches(self, time):
        """Contact force (N) and torque (N m) on the [[body]] tables, means over the row of the time series that holds `time`."""
        found = {name: np.full((len(self.names), 3), np.nan) for name in ("force", "torque")}
        for row, history in self.histories.items():
            at = min(int(np.searchsorted(history["time"], time)), len(history["time"]) - 1)
            if at >= 0:
                for name, values in found.items():
                    values[row] = history[name][at]
        return found


def _single(values):
    return values.astype(np.int32 if values.dtype.kind in "iu" else np.float32)


def require_free(paths):
    taken = [path for path in paths if path.exists()]
    if taken:
        raise RunError(f"{taken[0]}: exists; --overwrite replaces it, --output DIR writes elsewhere")


def write_series(run, folder, most, overwrite):
    """Writes all snapshots with bodies into `folder`. Returns what to say of each part."""
    numbers = [number for number in run.snapshots if run.bodies(number) is not None]
    if not numbers:
        raise RunError(f"{run.path / 'snapshots'}: no snapshot has bodies")
    parts = Parts(run, most)
    files = {part: [] for part in parts.rows(run.bodies(numbers[0]))}
    if not overwrite:
        require_free([folder / f"{part}{ending}" for part in files for ending in (".pvd", *(f"_{number:04}.vtp" for number in numbers))])
    folder.mkdir(parents=True, exist_ok=True)
    said = {}
    for number in numbers:
        bodies = run.bodies(number)
        for part, rows in parts.rows(bodies).items():
            name = f"{part}_{number:04}.vtp"
            coarser = parts.write(part, rows, bodies, folder / name)
            files[part].append((bodies.time, name))
            said[part] = f"{folder / part}.pvd: {len(rows)} {part}, {len(files[part])} snapshots{coarser}"
    for part, listed in files.items():
        write_collection(folder / f"{part}.pvd", listed)
    return said.values()


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
