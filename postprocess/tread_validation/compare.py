"""tread and theories beside what was measured, at the measured points of a curve."""

from dataclasses import dataclass

import numpy as np

NEAR = {"slip": 0.006, "slope": 0.06}  # up to which a run was made at a measured point


@dataclass(frozen=True)
class Answers:
    """tread's answers at the measured points of a curve, each [n]; NaN where no run was made."""

    value: np.ndarray  # with what the set's scene assumes, in the finest cells that were run
    grid: np.ndarray  # estimated error of the grid
    low: np.ndarray  # least and largest over all that was assumed, in those cells
    high: np.ndarray
    spacing: np.ndarray  # m
    verdict: list  # of texts


def tread_answers(measured_set, curve, quantity, rows):
    """Answers of the rows of a set."""
    places = curve.measured.column(measured_set.against)
    found = [_at(place, quantity, [row for row in rows if row.set == measured_set.name and row.curve == curve.name
                                   and abs(row.at - place) <= NEAR[measured_set.against]]) for place in places]
    columns = list(zip(*found))
    return Answers(*(np.array(column, float) for column in columns[:5]), list(columns[5]))


def _at(place, quantity, rows):
    rows = [row for row in rows if np.isfinite(getattr(row, quantity))]
    own = sorted((row for row in rows if not row.assumed), key=lambda row: row.spacing)
    if not own:
        return (np.nan,) * 5 + ("",)
    chosen = own[0]
    # Spacings differ by rounding alone where they are one.
    alike = [getattr(row, quantity) for row in rows if abs(row.spacing / chosen.spacing - 1) < 1e-6]
    return getattr(chosen, quantity), getattr(chosen, f"{quantity}_grid"), min(alike), max(alike), chosen.spacing, chosen.verdict


def sensitivity(measured_set, curve, rows):
    """{what is assumed: (points, {quantity: mean change})} against the set's own scene in cells of the same size, over the points that have both."""
    changes = {}
    own = [row for row in rows if row.set == measured_set.name and row.curve == curve.name]
    for row in own:
        base = next((other for other in own if not other.assumed and abs(row.spacing / other.spacing - 1) < 1e-6
                     and abs(row.at - other.at) <= NEAR[measured_set.against]), None)
        if row.assumed and base:
            changes.setdefault(row.assumed, []).append([getattr(row, name) - getattr(base, name) for name in measured_set.quantities])
    return {what: (len(found), dict(zip(measured_set.quantities, np.mean(found, axis=0)))) for what, found in changes.items()}


@dataclass(frozen=True)
class Deviation:
    """Deviation of values from measured ones, over the points where both are known."""

    points: int
    bias: float  # mean of value less measured
    mean: float  # mean size
    largest: float  # with its sign
    at: float  # where that is


def deviation(places, values, measured):
    """Deviation; None where no point has both."""
    known = np.isfinite(values) & np.isfinite(measured)
    if not known.any():
        return None
    off, where = (values - measured)[known], places[known]
    worst = int(np.argmax(np.abs(off)))
    return Deviation(int(known.sum()), float(off.mean()), float(np.abs(off).mean()), float(off[worst]), float(where[worst]))
