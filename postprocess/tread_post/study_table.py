"""The CSV of a study: one row a variant and quantity, in lines of comments above what it is of."""

import csv
import io
import math
from dataclasses import dataclass

from tread_post.rows import open_text
from tread_post.run import RunError

# Between the settings and these stands nothing; what is before them is a setting.
TEXTS = ("repeat", "state", "verdict", "quantity", "unit", "reference")
NUMBERS = ("points", "bodies", "steps", "substeps", "wall_s", "memory_bytes", "measured", "noise", "right", "uncertainty", "scatter", "error")
COLUMNS = ("repeat", "state", "verdict", "points", "bodies", "steps", "substeps", "wall_s", "memory_bytes", "quantity", "unit", "measured", "noise",
           "right", "uncertainty", "scatter", "error", "reference")


@dataclass(frozen=True)
class Row:
    variant: str
    settings: dict  # text by key
    repeat: str  # what was perturbed; empty of a variant proper
    state: str
    verdict: str  # of the run on its own resolution; empty where it gives none
    points: float
    bodies: float
    steps: float
    substeps: float
    wall_s: float
    memory_bytes: float
    quantity: str
    unit: str
    measured: float  # NaN of a curve, and of a run that did not finish
    right: float
    uncertainty: float  # of what is right; share, as errors are
    scatter: float  # of perturbed repeats, share
    error: float  # share
    reference: str
    noise: float = math.nan  # standard error of a mean over time; 0 of others, NaN in tables that are older than this column

    @property
    def is_candidate(self):
        return not self.repeat and self.state == "done"

    @property
    def setting_text(self):
        """spacing 0.015, substeps 12, precision single"""
        return ", ".join(f"{short_name(key, self.settings)} {value}" for key, value in self.settings.items())


@dataclass(frozen=True)
class Study:
    comments: list  # lines
    keys: list
    rows: list

    @property
    def quantities(self):
        return list(dict.fromkeys(row.quantity for row in self.rows))

    def of(self, quantity):
        return [row for row in self.rows if row.quantity == quantity]


def short_name(key, keys):
    """The last part of a key, or all of it where another ends alike."""
    last = key.rpartition(".")[2]
    return last if sum(other.rpartition(".")[2] == last for other in keys) == 1 else key


def study_text(comments, keys, rows):
    """The whole of study.csv."""
    text = io.StringIO()
    text.writelines(f"# {line}\n" for line in comments)
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["variant", *keys, *COLUMNS])
    for row in rows:
        writer.writerow([row.variant, *(row.settings[key] for key in keys), *(_cell(getattr(row, name)) for name in COLUMNS)])
    return text.getvalue()


def read_study(path):
    """RunError where the file is no table of a study."""
    try:
        with open_text(path) as file:
            lines = file.read().splitlines()
        comments = [line[2:] for line in lines if line.startswith("#")]
        reader = csv.DictReader(line for line in lines if not line.startswith("#"))
        keys = [name for name in reader.fieldnames or () if name != "variant" and name not in COLUMNS]
        rows = [Row(cells["variant"], {key: cells[key] for key in keys}, **{name: cells[name] for name in TEXTS},
                    **{name: float((cells.get(name, "") if name == "noise" else cells[name]) or math.nan) for name in NUMBERS}) for cells in reader]
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RunError(f"{path}: no table of a study ({error!r})") from error
    if not rows:
        raise RunError(f"{path}: no rows")
    return Study(comments, keys, rows)


def _cell(value):
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.7g}"
    return value
