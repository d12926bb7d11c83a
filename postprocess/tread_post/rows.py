"""Tables as rows of one kind."""

import csv
import gzip

from tread_post.run import RunError


def open_text(path):
    """Opens a text file for reading, packed by gzip where its name ends in .gz."""
    if str(path).endswith(".gz"):
        return gzip.open(path, "rt", newline="", encoding="utf-8")
    return open(path, newline="", encoding="utf-8")


def read_rows(path, kind, program):
    """The rows of a CSV that `program` wrote, as objects of a dataclass whose fields are columns. RunError if it is none of these, or empty."""
    types = kind.__annotations__
    try:
        with open_text(path) as file:
            rows = [kind(**{name: of_type(row[name]) for name, of_type in types.items()}) for row in csv.DictReader(file)]
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RunError(f"{path}: no table of {program} ({error!r})") from error
    if not rows:
        raise RunError(f"{path}: no rows")
    return rows


def write_rows(path, rows):
    """A CSV of dictionaries that have the same keys."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
