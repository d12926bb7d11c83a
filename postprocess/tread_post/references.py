"""What the variants of a study are compared with: a known answer, else the limit that they lead to; and how far off each is."""

import csv
import math
from dataclasses import dataclass

import numpy as np

from tread_post.convergence import Limit, limit_of
from tread_post.quantities import window_of
from tread_post.run import RunError

# How fine a value is, by the last part of its key: what goes to zero.
SIZES = {
    "spacing": lambda value: value, "dt": lambda value: value, "node_spacing": lambda value: value, "contact_share": lambda value: value,
    "substeps": lambda value: 1 / value, "sdf_cells": lambda value: 1 / value, "points_per_cell": lambda value: value ** (-1 / 3),
    "nodes": lambda value: value**-0.5,
}
# Words of which the last is the right one, however much it costs.
BEST_WORDS = {"precision": "double"}


@dataclass(frozen=True)
class Variant:
    """A finished run of a study."""

    name: str
    settings: dict  # value by key, of what varies
    run: object  # Run
    is_own: bool  # the scene as it is
    is_perturbed: bool  # a repeat of that


@dataclass(frozen=True)
class Reference:
    value: float  # NaN of a curve
    uncertainty: float  # in the unit of the quantity; of a curve, as errors are
    text: str
    hub: str = ""  # the variant that is compared with itself, if any
    curve: np.ndarray | None = None
    order: float | None = None


@dataclass(frozen=True)
class Judged:
    """One quantity over all variants."""

    measured: dict  # by variant: a number, or a curve
    errors: dict  # by variant, share of the scale; NaN of what is compared with itself
    reference: Reference
    scale: float  # NaN of a curve
    scatter: float  # standard deviation of perturbed repeats; NaN without
    noise: dict  # standard error by variant, of means over time; 0 of others


def size_of(key, value):
    """None where the value is no number, or the key does not refine."""
    size = SIZES.get(key.rpartition(".")[2])
    return size(value) if size and isinstance(value, (int, float)) and not isinstance(value, bool) else None


def judge(variants, quantity, known, design):
    """`known`: Reference of a right answer, or None, for the limit of the variants. `design`: "grid" or "star"."""
    measured = {variant.name: quantity.measure(variant.run) for variant in variants}
    noises = {variant.name: quantity.noise(variant.run) if quantity.noise else 0.0 for variant in variants}
    hub = hub_of([variant for variant in variants if not variant.is_perturbed], design)
    own = [measured[variant.name] for variant in variants if variant.is_own or variant.is_perturbed]
    if np.ndim(measured[hub.name]):
        reference = known or _limit_of_curves(hub, variants, measured)
        spread = float(np.ptp(reference.curve)) or 1.0
        scatter = float(np.std(own, axis=0, ddof=1).mean() / spread) if len(own) > 1 else math.nan
        errors = {name: _rms(curve - reference.curve) / spread for name, curve in measured.items()}
        scale = math.nan
    else:
        scatter = float(np.std(own, ddof=1)) if len(own) > 1 else math.nan
        reference = known or _limit(hub, variants, measured, (scatter, noises), design)
        scale = quantity.scale(hub.run) if quantity.scale else abs(reference.value)
        errors = {name: abs(value - reference.value) / scale if scale > 0 else math.nan for name, value in measured.items()}
    if reference.hub:
        errors[reference.hub] = math.nan
    return Judged(measured, errors, reference, scale, scatter, noises)


def known_value(value, share, text):
    """Makes the reference of an answer that is right to `share` of itself."""
    return Reference(value, share * abs(value), text)


def from_file(path, name, quantity, run):
    """The same mean over the same span of time, of a CSV of `time` (s) and a column of the quantity's name."""
    if quantity.of_history is None:
        return None
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        if not rows or name not in rows[0]:
            return None
        time, values = (np.array([float(row[column]) for row in rows]) for column in ("time", name))
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RunError(f"{path}: no CSV of time and values ({error!r})") from error
    span = window_of(run).time
    if time[0] > span[0] or time[-1] < span[-1]:
        raise RunError(f"{path}: {time[0]:g} to {time[-1]:g} s; means are taken over {span[0]:g} to {span[-1]:g} s")
    return Reference(float(quantity.of_history(np.interp(span, time, values))), 0.0, path.name)


def hub_of(variants, design):
    """The variant that limits are taken around: of a star the scene as it is, of a grid the finest."""
    if design == "star":
        own = [variant for variant in variants if variant.is_own]
        if not own:
            raise RunError("the scene as it is did not finish: a star has no middle")
        return own[0]
    return min(variants, key=lambda variant: (sum(_rank(key, value, variants) for key, value in variant.settings.items()), not variant.is_own))


def _rank(key, value, variants):
    """0 of the finest value, up to 1 of the coarsest; of words, 0 of the best one."""
    best = BEST_WORDS.get(key.rpartition(".")[2])
    if best is not None:
        return 0.0 if value == best else 1.0
    sizes = sorted({size for variant in variants if (size := size_of(key, variant.settings[key])) is not None})
    size = size_of(key, value)
    # "auto" beside numbers: it is one of the candidates, not the measure of them.
    return (sizes.index(size) / len(sizes) if size is not None else 1.0) if sizes else 0.0


def _arm(hub, variants, key):
    """Variants that differ from the hub in this key alone, the hub among them."""
    return [variant for variant in variants if not variant.is_perturbed
            and all(variant.settings[other] == hub.settings[other] for other in hub.settings if other != key)]


def _limit(hub, variants, measured, spreads, design):
    """The errors of several keys add up: what each key converges to, less the hub's value, is a correction. `spreads`: (scatter of repeats, noise by
    variant)."""
    scatter, noises = spreads
    noise = 0.0 if math.isnan(scatter) else scatter
    own = [variant.name for variant in variants if variant.is_own or variant.is_perturbed]
    is_mean = design == "star" and len(own) > 1
    middle = float(np.mean([measured[name] for name in own])) if is_mean else measured[hub.name]
    value, squares, texts, orders = middle, (noise**2 / len(own) if is_mean else noise**2), [], []
    for key in hub.settings:
        limit = _limit_along(key, hub, variants, {**measured, hub.name: middle}, (noise, noises))
        if limit is None:
            continue
        # What does not converge corrects nothing, but may be as far off as it is.
        correction = limit.value - middle
        value += correction if limit.is_limit else 0.0
        squares += (limit.uncertainty if limit.is_limit else max(limit.uncertainty, abs(correction))) ** 2
        texts.append(f"{key}: {limit.text}")
        orders.append(limit.order)
    text = "; ".join(texts) or "nothing that refines was varied: compared with this variant"
    if is_mean:
        text += f"; mean of {len(own)} perturbed repeats"
    return Reference(value, math.sqrt(squares), f"variant {hub.name}; {text}", hub.name if value == middle else "",
                     order=orders[0] if len(orders) == 1 else None)


def _limit_along(key, hub, variants, measured, spreads):
    scatter, noises = spreads
    arm = _arm(hub, variants, key)
    best = BEST_WORDS.get(key.rpartition(".")[2])
    if best is not None:
        found = [variant for variant in arm if variant.settings[key] == best]
        return Limit(measured[found[0].name], 0.0, None, best, is_limit=True) if found and len(arm) > 1 else None
    sized = {size: variant.name for variant in arm if (size := size_of(key, variant.settings[key])) is not None}
    return limit_of(list(sized), [measured[name] for name in sized.values()], scatter, [noises[name] for name in sized.values()]) if len(sized) > 1 else None


def _limit_of_curves(hub, variants, measured):
    """The hub's own curve; what it may be off by is how far it is, along each key, from the finest variant, or where it is that itself, from the
    next coarser one."""
    curve = measured[hub.name]
    spread, squares = float(np.ptp(curve)) or 1.0, 0.0
    for key in hub.settings:
        arm = sorted((size, variant.name) for variant in _arm(hub, variants, key) if (size := size_of(key, variant.settings[key])) is not None)
        others = [name for size, name in arm if size != size_of(key, hub.settings[key])]
        if others:
            squares += (_rms(measured[others[0]] - curve) / spread) ** 2
    return Reference(math.nan, math.sqrt(squares), f"variant {hub.name} itself; the finest others differ by the uncertainty", hub.name, curve)


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values))))
