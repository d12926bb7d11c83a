"""A run directory: scene, summary, time series and snapshots. Lengths in metres, SI throughout."""

import json
import time
import tomllib
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np


SCHEMA_VERSION = (1, 0)
PATIENCE = 2.0  # s; a run takes milliseconds from one state of its time series to the next


class RunError(Exception):
    """A file of the run is missing or does not hold what it should; the message names it."""


class UnreadableError(RunError):
    """HDF5 cannot read the file: it is damaged, or a run is writing it just now."""


# What reading a run may raise whose files are not what `tread` wrote: a table lacks a column, a text stands where a number should.
DAMAGE = (RunError, ArithmeticError, AttributeError, LookupError, OSError, RuntimeError, TypeError, ValueError)


def words_of(error):
    """Why a run cannot be read, of one of DAMAGE."""
    return str(error) if isinstance(error, RunError) else f"{type(error).__name__}: {error}"


@dataclass(frozen=True)
class Series:
    """A table of timeseries.h5: columns by name, one row a time, and the unit of each."""

    columns: dict[str, np.ndarray]
    units: dict[str, str]

    def __getitem__(self, name):
        return self.columns[name]

    def __contains__(self, name):
        return name in self.columns


@dataclass(frozen=True)
class Phase:
    name: str
    start: float  # s


@dataclass(frozen=True)
class Points:
    """Material points of a snapshot: fields by name, each [n] or [n, components]."""

    time: float
    position: np.ndarray  # [n, 3]
    fields: dict[str, np.ndarray]
    units: dict[str, str]


@dataclass(frozen=True)
class Bodies:
    """Rigid bodies of a snapshot; those of [[body]] tables come first."""

    time: float
    position: np.ndarray  # [n, 3]
    orientation: np.ndarray  # [n, 4], w x y z, body to world
    scale: np.ndarray  # [n]
    shape: np.ndarray  # [n], index into Run.shapes
    fields: dict[str, np.ndarray]  # other columns by name, each [n] or [n, components]


@dataclass(frozen=True)
class Shape:
    """A surface at scale 1 in the body's frame."""

    name: str
    vertices: np.ndarray  # [v, 3]
    triangles: np.ndarray  # [t, 3]


class Run:
    """A run directory. Files are read when they are asked for; RunError says what is wrong with one."""

    def __init__(self, path):
        self.path = Path(path)
        if not (self.path / "scene.toml").is_file():
            raise RunError(f"{self.path}: not a run directory: it has no scene.toml")

    @property
    def scene_text(self):
        return (self.path / "scene.toml").read_text(encoding="utf-8")

    @property
    def scene(self):
        try:
            return tomllib.loads(self.scene_text)
        except (OSError, ValueError) as error:
            raise RunError(f"{self.path / 'scene.toml'}: {error}") from error

    @property
    def title(self):
        return self.scene.get("title", self.path.name)

    @property
    def summary(self):
        """summary.json of a run that has ended; None while it goes on."""
        path = self.path / "summary.json"
        try:
            return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None
        except (OSError, ValueError) as error:
            raise RunError(f"{path}: {error}") from error

    @property
    def wheels(self):
        """Names of the bodies with a history, in the scene's order as far as it names them."""
        names = self._of_series(lambda file: list(file["wheel"]) if "wheel" in file else [])
        order = [body.get("name") for body in self.scene.get("body", [])]
        return sorted(names, key=lambda name: order.index(name) if name in order else len(order))

    def wheel(self, name):
        return self._table(f"/wheel/{name}")

    @property
    def energy(self):
        return self._table("/energy")

    @property
    def balance(self):
        return self._table("/balance")

    @property
    def ranks(self):
        """How the sand fell to the ranks, of a run on several."""
        return self._table("/ranks")

    @property
    def phases(self):
        """Phases that began, by time."""
        names = [phase.get("name", "") for phase in self.scene.get("phase", [])]
        return [Phase(names[index] if index < len(names) else f"phase {index}", start) for index, start in self._of_series(_begun_phases)]

    @property
    def snapshots(self):
        """Numbers of the snapshots, ascending."""
        files = (self.path / "snapshots").glob("*_[0-9]*.h*")
        return sorted({int(file.stem.rpartition("_")[2]) for file in files if file.suffix in (".hdf", ".h5")})

    @property
    def points_times(self):
        """Time (s) by number of the snapshots that have sand."""
        times = {}
        for snapshot in self.snapshots:
            path = self.path / "snapshots" / f"points_{snapshot:04}.hdf"
            if path.is_file():
                with _open(path) as file:
                    times[snapshot] = float(file.attrs["time"])
        return times

    def points(self, snapshot):
        """None if the scene has no sand."""
        path = self.path / "snapshots" / f"points_{snapshot:04}.hdf"
        if not path.is_file():
            return None
        with _open(path) as file:
            data = file["VTKHDF/PointData"]
            return Points(
                float(file.attrs["time"]),
                file["VTKHDF/Points"][:],
                {name: field[:] for name, field in data.items()},
                {name: _unit(field) for name, field in data.items()},
            )

    def bodies(self, snapshot):
        """None if the scene has no bodies."""
        path = self.path / "snapshots" / f"bodies_{snapshot:04}.h5"
        if not path.is_file():
            return None
        with _open(path) as file:
            columns = {name: column[:] for name, column in file.items()}
            own = [columns.pop(name) for name in ("position", "orientation", "scale", "shape")]
            return Bodies(float(file.attrs["time"]), *own, columns)

    @property
    def shapes(self):
        """Shapes by the index that Bodies.shape holds."""
        with _open(self.path / "snapshots" / "shapes.h5") as file:
            return [
                Shape(_text(group.attrs["name"]), group["vertices"][:], group["triangles"][:])
                for group in (file[str(index)] for index in range(len(file)))
            ]

    def _table(self, group):
        return self._of_series(lambda file: _table_of(file, group))

    def _of_series(self, read):
        """What `read` gives of the time series, once that can be read: a run may be writing it."""
        path = self.path / "timeseries.h5"
        give_up = time.monotonic() + PATIENCE
        while True:
            try:
                with _open(path) as file:
                    return read(file)
            except UnreadableError:
                if time.monotonic() > give_up:
                    raise
            time.sleep(0.05)


def _begun_phases(file):
    """[(index, time)]"""
    if "phases" not in file:
        return []
    return [(int(index), float(start)) for index, start in zip(file["phases/index"][:], file["phases/start"][:])]


def _table_of(file, group):
    if group not in file:
        raise RunError(f"{file.filename}: no table {group}")
    table = file[group]
    # A run that goes on may have written a row to some columns only.
    rows = min((column.shape[0] for column in table.values()), default=0)
    return Series(
        {name: column[:rows] for name, column in table.items()},
        {name: _unit(column) for name, column in table.items()},
    )


@contextmanager
def _open(path):
    if not path.is_file():
        raise RunError(f"{path}: no such file")
    try:
        # Without a lock: the run may be writing.
        with h5py.File(path, "r", locking=False) as file:
            version = tuple(int(number) for number in file.attrs.get("schema_version", SCHEMA_VERSION))
            if version[0] != SCHEMA_VERSION[0]:
                raise RunError(f"{path}: schema version {'.'.join(map(str, version))}; read here is {SCHEMA_VERSION[0]}.x")
            yield file
    except (OSError, RuntimeError) as error:
        raise UnreadableError(f"{path}: {error}") from error


def _text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def _unit(dataset):
    return _text(dataset.attrs.get("units", "1"))
