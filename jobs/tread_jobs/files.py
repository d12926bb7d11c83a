"""Files that others may have damaged, and files that others may read while they are written."""

import json
import math
import os


def write_text(path, text):
    """Replaces the file in one step: a reader, or a machine that stops, finds the old text or the new one."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with open(temporary, "w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def read_text(path):
    """Reads a file that others wrote; U+FFFD stands for bytes that are no UTF-8."""
    return path.read_text(encoding="utf-8", errors="replace")


def read_object(path):
    """The JSON object in a file; None where there is none that can be read."""
    try:
        found = json.loads(read_text(path))
    except (OSError, ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def number_of(value):
    """A number of JSON as a float; NaN of its null. TypeError of anything else."""
    if value is not None and not isinstance(value, (int, float)):
        raise TypeError(f"{value!r} is no number")
    return math.nan if value is None else float(value)


def printable(value):
    """The text of a value, without what a terminal would obey and what HDF5 or UTF-8 cannot hold; line ends and tabs stay."""
    return "".join(letter if letter.isprintable() or letter in "\n\t" else "\ufffd" for letter in str(value))
