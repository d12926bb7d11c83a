"""Axes of a campaign: which keys change, and through which values."""

import math
import random
from dataclasses import dataclass

from tread_jobs.errors import CampaignError

# The key that stands for the scene file itself.
SCENE = "scene"
KEYS_OF_AXIS = ("key", "keys", "name", "unit", "labels", "values", "range", "random")


@dataclass(frozen=True)
class Axis:
    """Keys that change together, and their values: points[i][k] is what point i gives to keys[k]."""

    name: str
    unit: str
    keys: tuple[str, ...]
    points: tuple[tuple, ...]
    labels: tuple[str, ...]  # one a point


def read_axis(table, where):
    """An [[axis]] or [[arm]] of a campaign file, which `where` names. CampaignError says what is wrong."""
    unknown = sorted(set(table) - set(KEYS_OF_AXIS))
    if unknown:
        raise CampaignError(f"{where}: unknown key '{unknown[0]}'; known are {', '.join(KEYS_OF_AXIS)}")
    keys = _keys(table, where)
    where = f"{where} ({', '.join(keys)})"
    kinds = [kind for kind in ("values", "range", "random") if kind in table]
    if len(kinds) != 1:
        raise CampaignError(f"{where}: exactly one of values, range, random")
    points = {"values": _values, "range": _range, "random": _random}[kinds[0]](table[kinds[0]], keys, where)
    if not points:
        raise CampaignError(f"{where}: no values")
    if len({repr(point) for point in points}) < len(points):
        raise CampaignError(f"{where}: a value stands there twice, and would give the same case twice")
    labels = table.get("labels", [", ".join(map(label_of, point)) for point in points])
    if not _strings(labels) or len(labels) != len(points) or len(set(labels)) != len(labels):
        raise CampaignError(f"{where}: labels: one text for each of the {len(points)} values, all different")
    name, unit = table.get("name", keys[0].rpartition(".")[2]), table.get("unit", "1")
    if not _strings([name, unit]) or not name:
        raise CampaignError(f"{where}: name and unit are texts")
    return Axis(name, unit, keys, tuple(map(tuple, points)), tuple(labels))


def label_of(value):
    return f"{value:g}" if isinstance(value, float) else str(value)


def _keys(table, where):
    if ("key" in table) == ("keys" in table):
        raise CampaignError(f"{where}: exactly one of key, keys")
    keys = [table["key"]] if "key" in table else table["keys"]
    if not _strings(keys) or not keys:
        raise CampaignError(f"{where}: keys are texts")
    return tuple(keys)


def _strings(items):
    return isinstance(items, list) and all(isinstance(item, str) for item in items)


def _values(values, keys, where):
    if not isinstance(values, list):
        raise CampaignError(f"{where}: values is a list")
    if len(keys) == 1:
        return [(value,) for value in values]
    if not all(isinstance(value, list) and len(value) == len(keys) for value in values):
        raise CampaignError(f"{where}: each of values is a list of {len(keys)}, one for each key")
    return values


def _range(table, keys, where):
    low, high, count, scale = _fields(table, {"from": None, "to": None, "count": None, "scale": "linear"}, f"{where}: range")
    if len(keys) != 1:
        raise CampaignError(f"{where}: range has one key; several that change together take values")
    _check_interval(low, high, count, scale, f"{where}: range")
    shares = [index / (count - 1) if count > 1 else 0.0 for index in range(count)]
    values = [_between(low, high, share, scale) for share in shares]
    whole = isinstance(low, int) and isinstance(high, int) and all(value == int(value) for value in values)
    return [(int(value) if whole else value,) for value in values]


def _random(table, keys, where):
    names = {"low": None, "high": None, "count": None, "seed": None, "scale": "linear"}
    low, high, count, seed, scale = _fields(table, names, f"{where}: random")
    if len(keys) == 1:
        low, high = [low], [high]
    if not (isinstance(low, list) and isinstance(high, list) and len(low) == len(high) == len(keys)):
        raise CampaignError(f"{where}: random: low and high are lists of {len(keys)}, one for each key")
    if not isinstance(seed, int):
        raise CampaignError(f"{where}: random: seed is an integer")
    for one, other in zip(low, high):
        _check_interval(one, other, count, scale, f"{where}: random")
    # random() is the one stream that Python promises to keep from version to version.
    stream = random.Random(seed)
    return [tuple(_between(one, other, stream.random(), scale) for one, other in zip(low, high)) for _ in range(count)]


def _fields(table, defaults, where):
    if not isinstance(table, dict) or set(table) - set(defaults):
        raise CampaignError(f"{where}: a table of {', '.join(defaults)}")
    missing = [name for name, default in defaults.items() if default is None and name not in table]
    if missing:
        raise CampaignError(f"{where}: {missing[0]} is missing")
    return [table.get(name, default) for name, default in defaults.items()]


def _check_interval(low, high, count, scale, where):
    numbers = all(isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value) for value in (low, high))
    if not numbers or scale not in ("linear", "log") or (scale == "log" and min(low, high) <= 0):
        raise CampaignError(f"{where}: two finite numbers, and scale \"linear\" or, of numbers over 0, \"log\"")
    if not isinstance(count, int) or count < 1:
        raise CampaignError(f"{where}: count is an integer of at least 1")


def _between(low, high, share, scale):
    """Rounded to twelve digits: 0.3, not 0.30000000000000004."""
    value = low + (high - low) * share if scale == "linear" else low * (high / low) ** share
    return float(f"{value:.12g}")
