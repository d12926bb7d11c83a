"""The order of convergence that a study sees for each quantity, and the value that it leads to, in sentences."""

import math

from tread_post.convergence import limit_of
from tread_post.references import BEST_WORDS, size_of
from tread_post.study_table import short_name


def order_sentences(study):
    """A line for each quantity that is a number and each key that refines and has two values or more, of the variants that are finest in all else."""
    lines = []
    for name in study.quantities:
        rows = [row for row in study.of(name) if row.is_candidate and math.isfinite(row.measured)]
        for key in study.keys:
            sized = _arm(rows, key, study.keys)
            if len(sized) > 1:
                lines.append(_sentence(sized, key, short_name(key, study.keys), _scatter(rows)))
    return lines


def _arm(rows, key, keys):
    """Row by size of the largest group that differs in `key` alone; of several that are as large, the finest in all else."""
    groups = {}
    for row in rows:
        size = size_of(key, _number(row.settings[key]))
        if size is not None:
            groups.setdefault(tuple(row.settings[other] for other in keys if other != key), {})[size] = row
    others = [other for other in keys if other != key]
    return min(groups.values(), key=lambda group: (-len(group), _coarseness(next(iter(group.values())), others)), default={})


def _coarseness(row, keys):
    parts = []
    for key in keys:
        size, best = size_of(key, _number(row.settings[key])), BEST_WORDS.get(key.rpartition(".")[2])
        parts.append(size if size is not None else 0.0 if row.settings[key] == best else 1.0)
    return parts


def _scatter(rows):
    """Scatter of perturbed repeats in the quantity's unit; the table has it as a share of the scale of errors."""
    scale = next((abs(row.measured - row.right) / row.error for row in rows if row.error > 0), math.nan)
    return scale * rows[0].scatter if math.isfinite(scale * rows[0].scatter) else 0.0


def _number(text):
    try:
        return float(text)
    except ValueError:
        return text


def _sentence(sized, full_key, key, scatter):
    finest = sized[min(sized)]
    noises = [0.0 if math.isnan(row.noise) else row.noise for row in sized.values()]
    limit = limit_of(list(sized), [row.measured for row in sized.values()], scatter, noises)
    here = f"{quantity_text(finest.measured, finest.noise, finest.unit)} at {key} {finest.settings[full_key]}"
    verdict = f"; the finest run calls itself {finest.verdict}" if finest.verdict not in ("", "resolved") else ""
    if not limit.is_limit:
        doubt = "" if math.isnan(limit.uncertainty) else f", in doubt by {limit.uncertainty:.2g}"
        return f"{finest.quantity} in {key}: {limit.text}; {here}{doubt}{verdict}"
    return (f"{finest.quantity} in {key}: {limit.text.removeprefix('extrapolated, ')}, of {len(sized)} values; "
            f"extrapolated {quantity_text(limit.value, limit.uncertainty, finest.unit)}; {here}{verdict}")


def quantity_text(value, spread, unit):
    """Value and spread to the place of the spread's second digit."""
    unit = "" if unit == "1" else f" {unit}"
    if not spread > 0:
        return f"{value:.4g}{unit}"
    places = max(0, 1 - math.floor(math.log10(spread)))
    return f"{value:.{places}f} +- {spread:.{places}f}{unit}"
