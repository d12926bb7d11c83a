"""Curves as pieces of SVG, which need neither scripts nor styles."""

from dataclasses import dataclass

import numpy as np

from tread_post.looks import COLOURS, GREY, GRID, readable, with_unit
from tread_post.page import escape

WIDTH, HEIGHT = 560, 240
LEFT, RIGHT, TOP, BOTTOM = 64, 548, 40, 200  # of the frame
MOST_BINS = 600  # about one for each dot of a screen
DIGITS = 1e150  # beyond which squares and spans leave the range of numbers


@dataclass(frozen=True)
class Curve:
    name: str
    x: np.ndarray  # [n]
    y: np.ndarray  # [n]; rows that are not finite are left out


@dataclass(frozen=True)
class Band:
    """A phase: its name and where it is on the axis of x."""

    name: str
    start: float
    end: float


def plot(title, unit, curves, along, bands=()):
    """One frame with curves over an axis of x, whose name is `along`; an empty text where there is nothing to draw."""
    curves = [curve for curve in map(_finite, curves) if len(curve.x) > 1]
    if not curves:
        return ""
    factor, unit = readable(np.concatenate([curve.y for curve in curves]), unit)
    across = _Scale(np.concatenate([curve.x for curve in curves]), LEFT, RIGHT, 0.0)
    up = _Scale(factor * np.concatenate([curve.y for curve in curves]), BOTTOM, TOP, 0.06)
    parts = [*_bands(bands, across), *_grid(across, up), _text((LEFT + RIGHT) / 2, HEIGHT - 6, along, "middle")]
    for number, curve in enumerate(curves):
        parts.append(_line(across.at(curve.x), up.at(factor * curve.y), COLOURS[number % len(COLOURS)]))
    label = with_unit(title, unit)
    return (f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(label)}">{_text(LEFT, 14, label, "start", "#222222")}'
            f'{"".join(parts)}</svg>')


def legend(names):
    """Names of curves in their colours."""
    entries = [f'<svg viewBox="0 0 20 10" width="20" height="10"><path d="M0 5H20" stroke="{COLOURS[number % len(COLOURS)]}" stroke-width="3"/></svg>'
               f" {escape(name)}" for number, name in enumerate(names)]
    return f'<p class="legend">{" &emsp; ".join(entries)}</p>'


class _Scale:
    """Places on the screen of the values of an axis."""

    def __init__(self, values, first, last, margin):
        low, high = float(values.min()), float(values.max())
        room = margin * (high - low) or (0.0 if high > low else max(1e-3, 0.1 * abs(high)))
        self.low, self.high, self.first, self.last = low - room, high + room, first, last

    def at(self, values):
        return self.first + (self.last - self.first) * (np.asarray(values) - self.low) / (self.high - self.low)

    @property
    def ticks(self):
        """About five round numbers."""
        size = 10.0 ** np.floor(np.log10((self.high - self.low) / 4))
        step = size * next(factor for factor in (1, 2, 5, 10) if (self.high - self.low) / (factor * size) <= 6)
        return step * np.arange(np.ceil(self.low / step), np.floor(self.high / step) + 1)


def _finite(curve):
    """The rows of a curve that are finite; of more than a screen has dots, the least and the greatest of each bin."""
    known = np.isfinite(curve.x) & (np.abs(curve.x) < DIGITS) & np.isfinite(curve.y) & (np.abs(curve.y) < DIGITS)
    x, y = curve.x[known], curve.y[known]
    if len(x) > 2 * MOST_BINS:
        parts = np.array_split(np.arange(len(x)), MOST_BINS)
        kept = np.unique([part[choose(y[part])] for part in parts for choose in (np.argmin, np.argmax)] + [0, len(x) - 1])
        x, y = x[kept], y[kept]
    return Curve(curve.name, x, y)


def _line(x, y, colour):
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
    return f'<polyline fill="none" stroke="{colour}" stroke-width="1.5" stroke-linejoin="round" points="{points}"/>'


def _bands(bands, across):
    for number, band in enumerate(bands):
        start, end = np.clip(across.at([band.start, band.end]), LEFT, RIGHT)
        if number % 2 == 1:
            yield f'<rect x="{start:.1f}" y="{TOP}" width="{end - start:.1f}" height="{BOTTOM - TOP}" fill="#ececec"/>'
        if end - start > 7 * len(band.name):  # a name wider than its phase would run into its neighbour's
            yield _text(0.5 * (start + end), TOP - 5, band.name, "middle")


def _grid(across, up):
    for value, x in zip(across.ticks, across.at(across.ticks)):
        yield f'<path d="M{x:.1f} {TOP}V{BOTTOM}" stroke="{GRID}"/>' + _text(x, BOTTOM + 16, _short(value), "middle")
    for value, y in zip(up.ticks, up.at(up.ticks)):
        dark = GREY if abs(value) < 1e-9 * (up.high - up.low) else GRID
        yield f'<path d="M{LEFT} {y:.1f}H{RIGHT}" stroke="{dark}"/>' + _text(LEFT - 6, y + 4, _short(value), "end")


def _short(value):
    return f"{value + 0.0:.4g}"


def _text(x, y, text, anchor, colour="#555555"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="12" fill="{colour}">{escape(text)}</text>'
