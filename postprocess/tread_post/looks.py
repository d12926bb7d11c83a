"""Colours and units of figures, whatever draws them."""

import numpy as np

# Okabe and Ito's colours, which the colour-blind can tell apart; with markers, so that prints in grey do, too.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#333333")
GRID, GREY = "#cccccc", "#999999"


def with_unit(label, unit):
    return label if unit == "1" else f"{label}  [{unit}]"


def readable(values, unit):
    """Factor and unit with which the larger values have up to three digits before the point."""
    finite = np.abs(values[np.isfinite(values)]) if np.size(values) else np.zeros(0)
    largest = finite.max() if finite.size else 0.0
    if unit == "m" and 0 < largest < 0.5:
        return 1e3, "mm"
    if unit in ("N", "N m", "J", "Pa") and largest >= 5e3:
        return 1e-3, "k" + unit
    return 1.0, unit
