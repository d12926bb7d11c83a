"""The table that `jobs/campaign.py collect` leaves: axes and answers of all cases."""

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from tread_post.run import Run, RunError
from tread_post.verdict import FAILED, UNKNOWN

SCHEMA = "tread-campaign"
VERSION = (1, 1)


@dataclass(frozen=True)
class CampaignAxis:
    name: str
    unit: str
    keys: list[str]
    labels: list[str]  # of its values, in their order


class CampaignTable:
    """A campaign's directory with its campaign.h5. Columns have one row a case."""

    def __init__(self, path):
        self.path = Path(path)
        file_path = self.path / "campaign.h5"
        if not file_path.is_file():
            raise RunError(f"{self.path}: no campaign.h5; `jobs/campaign.py collect` writes it")
        try:
            with h5py.File(file_path, "r") as file:
                self._read(file)
        except (OSError, KeyError) as error:
            raise RunError(f"{file_path}: {error}") from error

    def _read(self, file):
        schema, version = file.attrs.get("schema"), tuple(file.attrs.get("schema_version", (0, 0)))
        if schema != SCHEMA or version[0] != VERSION[0]:
            raise RunError(f"{file.filename}: schema {schema} {version}; read here is {SCHEMA} {VERSION}")
        self.title, self.text, self.collected = (file.attrs[name] for name in ("title", "campaign", "collected"))
        self.cost = json.loads(file.attrs["cost"])
        self.axes = [CampaignAxis(**axis) for axis in json.loads(file.attrs["axes"])]
        self.columns, self.units = {}, {}
        for group in ("case", "labels", "axes", "answers", "summary", "provenance"):
            for name, column in file[group].items():
                values = column[:]
                text = h5py.check_string_dtype(column.dtype) is not None
                key = f"{group}/{name}" if group in ("labels", "axes", "provenance") else name
                self.columns[key] = np.array([value.decode() for value in values]) if text else values
                self.units[key] = column.attrs["units"]

    def __len__(self):
        return len(self.columns["number"])

    def __getitem__(self, name):
        return self.columns[name]

    @property
    def verdicts(self):
        """Verdict of each case on its own resolution, [n]; UNKNOWN for all in tables that hold no verdicts."""
        told = self.columns.get("verdict", np.full(len(self), UNKNOWN))
        return np.where(self["state"] == "failed", FAILED, told).astype(object)

    @property
    def slip_axes(self):
        """Names of the axes that set slip: what curves are drawn against."""
        return [axis.name for axis in self.axes if any(key.endswith("drive.slip") for key in axis.keys)]

    @property
    def label_columns(self):
        """Names of the columns of labels, in the order of the axes; repeats last."""
        known = [f"labels/{axis.name}" for axis in self.axes]
        return known + [key for key in self.columns if key.startswith("labels/") and key not in known]

    def scene(self, row):
        path = self.path / "cases" / f"{int(self['number'][row]):04}" / "scene.toml"
        try:
            return tomllib.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise RunError(f"{path}: {error}") from error

    def run(self, row):
        return Run(self.path / "cases" / f"{int(self['number'][row]):04}" / "run")


def write_campaign_table(path, attributes, groups):
    """campaign.h5: `groups` is {group: {column: (values, unit)}}, each with one value a case; written whole, then renamed."""
    fresh = path.with_suffix(".h5.new")
    with h5py.File(fresh, "w") as file:
        file.attrs["schema"], file.attrs["schema_version"] = SCHEMA, VERSION
        for name, value in attributes.items():
            file.attrs[name] = value
        for group, columns in groups.items():
            target = file.create_group(group)
            for name, (values, unit) in columns.items():
                text = any(isinstance(value, str) for value in values)
                # No compound or object types: any HDF5 reader knows strings and doubles.
                kind = h5py.string_dtype() if text else np.int64 if name == "number" else np.float64
                target.create_dataset(name, data=list(values), dtype=kind)
                target[name].attrs["units"] = unit
    fresh.rename(path)
