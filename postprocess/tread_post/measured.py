"""Measured data as small CSV files: comments behind #, a header of `name [unit]`, cells that are numbers or empty."""

import csv
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tread_post.run import RunError

# Quantities have one unit in all files; other columns may have any.
UNITS = {"time": "s", "force": "N", "drawbar_pull": "N", "torque": "N m", "sinkage": "m", "slip": "1", "slope": "deg", "load": "N", "speed": "m/s",
         "rim_speed": "m/s"}


@dataclass(frozen=True)
class Measured:
    """Columns of a data file, NaN where a cell is empty."""

    path: Path
    columns: dict  # arrays [n] by name, in SI units and degrees

    def column(self, name):
        """Values [n]; all NaN where the file has no such column."""
        return self.columns.get(name, np.full(len(self), np.nan))

    def __len__(self):
        return len(next(iter(self.columns.values())))


def read_measured(path):
    """Measured: lines that begin with # are comments, headers are `name [unit]`, cells are numbers or empty. RunError names file, line and column."""
    try:
        numbered = [(number, line) for number, line in enumerate(Path(path).read_text(encoding="utf-8").splitlines(), 1)
                    if line.strip() and not line.startswith("#")]
    except (OSError, UnicodeDecodeError) as error:
        raise RunError(f"{path}: {error}") from error
    if len(numbered) < 2:
        raise RunError(f"{path}: a header and at least one row of numbers")
    headers = [_header(cell, path) for cell in next(csv.reader([numbered[0][1]]))]
    rows = [_numbers(line, headers, f"{path}, line {number}") for number, line in numbered[1:]]
    return Measured(Path(path), {name: np.array(column) for name, column in zip(headers, zip(*rows))})


def _header(cell, path):
    found = re.fullmatch(r"\s*([A-Za-z_][A-Za-z0-9_]*) \[([^\]]+)\]\s*", cell)
    if not found:
        raise RunError(f"{path}: column '{cell}': accepted: name [unit], such as sinkage [m]")
    name, unit = found.groups()
    wanted = UNITS.get(name.removesuffix("_spread"))
    if wanted and unit != wanted:
        raise RunError(f"{path}: column '{cell}': {name} is given in {wanted}")
    return name


def _numbers(line, headers, where):
    cells = next(csv.reader([line]))
    if len(cells) != len(headers):
        raise RunError(f"{where}: {len(cells)} cells; the header has {len(headers)}")
    values = []
    for cell, name in zip(cells, headers):
        try:
            values.append(float(cell) if cell.strip() else np.nan)
        except ValueError as error:
            raise RunError(f"{where}, column {name}: '{cell}': accepted: a number, or nothing") from error
    return values
