"""Small copies of runs: run directories with fewer rows, and of each snapshot only what a section and a view from above show.

All that reads a run reads such a copy too.
"""

import shutil

import h5py
import numpy as np

from tread_post.geometry import point_spacing
from tread_post.run import RunError

# Columns that are means over the time since the row before: rows that are put together have their mean.
MEANS = ("force", "torque", "drawbar_pull", "power")
POINT_FIELDS = ("displacement", "plastic_rate", "plastic_shear")
# Readable by HDF5 1.10, and smaller than what 1.8 reads.
LIBRARIES = ("v108", "v110")
# Cells of the view from above, across the domain.
COLUMNS = 100


def thin(run, folder, rows, start=0.0, snapshots=()):
    """Writes a copy of `run` into `folder`, which is made: of each table at most about `rows` rows from `start` (s) on, and those `snapshots`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("scene.toml", "summary.json"):
        if (run.path / name).is_file():
            shutil.copyfile(run.path / name, folder / name)
    with h5py.File(run.path / "timeseries.h5", "r", locking=False) as source, h5py.File(folder / "timeseries.h5", "w", libver=LIBRARIES) as target:
        target.attrs.update(source.attrs)
        source.visititems(lambda name, item: _thin_table(name, item, target, rows, start) if isinstance(item, h5py.Group) else None)
    if snapshots:
        _thin_snapshots(run, folder / "snapshots", snapshots)


def _thin_table(name, group, target, rows, start):
    columns = {key: item for key, item in group.items() if isinstance(item, h5py.Dataset)}
    if not columns:
        return
    values = {key: item[: min(len(column) for column in columns.values())] for key, item in columns.items()}
    if "time" in values:
        values = put_together(values, rows, start)
    for key, value in values.items():
        # Times need their digits; what is measured has six.
        kept = value if key in ("time", "start") or value.dtype.kind != "f" else value.astype(np.float32)
        item = target.create_dataset(f"{name}/{key}", data=kept, compression="gzip", compression_opts=9, shuffle=True)
        item.attrs.update(columns[key].attrs)


def put_together(columns, rows, start):
    """Columns [n, ...] with at most about `rows` rows from `start` (s) on: the last of each bunch, and of MEANS the mean over its time."""
    time = columns["time"]
    first = int(np.searchsorted(time, start - 1e-9))
    size = max(1, -(-(len(time) - first) // rows))
    ends = np.arange(len(time) - 1, first - 1, -size)[::-1]
    starts = np.concatenate((ends[:1], ends[:-1] + 1))  # the first row stays as it is
    spans = np.diff(time, prepend=time[:1])
    put = {}
    for name, values in columns.items():
        if name in MEANS and size > 1:
            put[name] = np.stack([_mean(values[a:b + 1], spans[a:b + 1]) for a, b in zip(starts, ends)])
        else:
            put[name] = values[ends]
    return put


def _mean(values, spans):
    return np.average(values, axis=0, weights=spans) if spans.sum() > 0 else values[-1]


def _thin_snapshots(run, folder, snapshots):
    folder.mkdir(exist_ok=True)
    shutil.copyfile(run.path / "snapshots" / "shapes.h5", folder / "shapes.h5")
    before = _bodies_at_last_phase(run)
    for number in snapshots:
        points, bodies = run.points(number), run.bodies(number)
        if points is None and bodies is None:
            raise RunError(f"{run.path / 'snapshots'}: no snapshot {number}; this run has {run.snapshots}")
        middle = bodies.position[0, 1] if bodies is not None else 0.5 * run.scene["domain"]["size"][1]
        if points is not None:
            _write_points(folder / f"points_{number:04}.hdf", run, points, middle)
        if bodies is not None:
            _write_bodies(folder / f"bodies_{number:04}.h5", run, bodies, middle, before)


def _bodies_at_last_phase(run):
    """Bodies of the snapshot nearest to the start of the last phase, from which displacements of rocks count. None without bodies, and where none is
    as near as snapshots are apart: a run that went on elsewhere, from a checkpoint, has none from before it."""
    begun = run.phases[-1].start if run.phases else 0.0
    there = [bodies for bodies in map(run.bodies, run.snapshots) if bodies is not None]
    nearest = min(there, key=lambda bodies: abs(bodies.time - begun), default=None)
    if nearest is None or abs(nearest.time - begun) > run.scene.get("output", {}).get("snapshots_every", np.inf):
        return None
    return nearest


def _seen(run, position, near, column):
    """Rows of what is near the section, or highest in its column of side `column` (m) seen from above."""
    size = run.scene["domain"]["size"]
    across = int(np.ceil(size[1] / column))
    place = np.clip((position[:, :2] / column).astype(int), 0, (int(np.ceil(size[0] / column)), across - 1))
    cell = place[:, 0] * across + place[:, 1]
    order = np.lexsort((position[:, 2], cell))
    top = np.flatnonzero(np.diff(cell[order], append=-1) != 0)
    return np.union1d(np.flatnonzero(near), order[top])


def _write_points(path, run, points, middle):
    spacing = point_spacing(run.scene, points)
    near = np.abs(points.position[:, 1] - middle) <= 0.75 * spacing
    rows = _seen(run, points.position, near, max(2 * spacing, run.scene["domain"]["size"][1] / COLUMNS))
    with h5py.File(path, "w", libver=LIBRARIES) as file:
        file.attrs["time"] = points.time
        _write(file, "VTKHDF/Points", points.position[rows], "m")
        for name in POINT_FIELDS:
            _write(file, f"VTKHDF/PointData/{name}", points.fields[name][rows], points.units[name])


def _write_bodies(path, run, bodies, middle, before):
    sizes = [np.linalg.norm(shape.vertices, axis=1).max() for shape in run.shapes]
    radius = bodies.scale * np.array(sizes)[bodies.shape]
    near = np.abs(bodies.position[:, 1] - middle) <= radius
    near[: len(run.scene.get("body", []))] = True
    rows = _seen(run, bodies.position, near, max(3 * np.median(radius), run.scene["domain"]["size"][1] / COLUMNS))
    with h5py.File(path, "w", libver=LIBRARIES) as file:
        file.attrs["time"] = bodies.time
        for name, unit in (("position", "m"), ("orientation", "1"), ("scale", "1"), ("shape", "1")):
            _write(file, name, getattr(bodies, name)[rows], unit)
        if before is not None:
            file.attrs["displacement_since"] = before.time
            _write(file, "displacement", (bodies.position - before.position)[rows], "m")


def _write(file, name, values, unit):
    kept = values.astype(np.float32) if values.dtype.kind == "f" else values
    file.create_dataset(name, data=kept, compression="gzip", compression_opts=9, shuffle=True).attrs["units"] = unit
