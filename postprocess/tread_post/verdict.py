"""A run's verdict on its own resolution (docs/verdict.md): read from summary.json, counted over many runs, and drawn as a marker."""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

RESOLVED, MARGINAL, UNDER_RESOLVED, FAILED, UNKNOWN = "resolved", "marginal", "under-resolved", "failed", ""
VERDICTS = (RESOLVED, MARGINAL, UNDER_RESOLVED)
# Estimated errors of the answers, figures of `resolution` that a run may have.
ESTIMATED_ERRORS = ("pull_error", "torque_error", "sinkage_error")
# Marker and whether it is filled. What failed is not drawn.
LOOKS = {RESOLVED: ("o", True), MARGINAL: ("o", False), UNDER_RESOLVED: ("x", True), UNKNOWN: ("+", True)}
RING = 13.0  # points, around what is not steady


@dataclass(frozen=True)
class Resolution:
    """What a run says of itself. `verdict` is empty while it has not ended, and of runs older than verdicts."""

    verdict: str
    worst_figure: str = ""  # with its value and bounds
    errors: dict = field(default_factory=dict)  # value by the names of ESTIMATED_ERRORS
    warnings: tuple = ()


def resolution_of(summary):
    """Returns the verdict in a summary.json (a dictionary, or None). A run that failed is `failed` whatever its figures say.
    Raises one of DAMAGE where it is not what a run writes."""
    if not summary:
        return Resolution(UNKNOWN)
    resolution = summary.get("resolution") or {}
    figures = {name: figure for name, figure in (resolution.get("figures") or {}).items() if isinstance(figure, dict)}
    verdict = FAILED if summary.get("status") == FAILED else resolution.get("verdict") or UNKNOWN
    if not isinstance(verdict, str):
        raise TypeError(f"the verdict is {verdict!r}")
    errors = {name: figures[name]["value"] for name in ESTIMATED_ERRORS if isinstance(figures.get(name, {}).get("value"), (int, float))}
    return Resolution(verdict, _worst(figures), errors, tuple(map(str, summary.get("warnings") or ())))


def _worst(figures):
    """The figure that decides the verdict: of those with the worst one, the farthest beyond its bound. Empty where all are resolved."""
    judged = {name: figure for name, figure in figures.items() if figure.get("verdict") in VERDICTS[1:]}
    if not judged:
        return ""
    name = max(judged, key=lambda name: (VERDICTS.index(judged[name]["verdict"]), _excess(judged[name])))
    figure = judged[name]
    word = "from" if figure["resolved"] > figure["marginal"] else "to"
    value = "no number" if figure["value"] is None else f"{figure['value']:.3g}"
    return f"{name} {value} (resolved {word} {figure['resolved']:.3g}, marginal {word} {figure['marginal']:.3g})"


def _excess(figure):
    """Ratio of a figure to its bound for `resolved`, over 1."""
    value, bound = figure["value"], figure["resolved"]
    if value is None or not np.isfinite(value):
        return np.inf
    above, below = (bound, value) if bound > figure["marginal"] else (value, bound)
    return above / below if below > 0 else np.inf


def text_of(verdict):
    return verdict or "no verdict"


def headline(verdicts, things="cases"):
    """2 of 4 cases are under-resolved, 1 is marginal, 1 failed. Names every verdict that is not `resolved`."""
    counts, parts = Counter(verdicts), []
    for verdict in (UNDER_RESOLVED, MARGINAL, FAILED, UNKNOWN):
        if counts[verdict]:
            of = f" of {len(verdicts)} {things}" if not parts else ""
            verb = {FAILED: "failed", UNKNOWN: "has no verdict" if counts[verdict] == 1 else "have no verdict"}.get(
                verdict, f"{'is' if counts[verdict] == 1 else 'are'} {verdict}")
            parts.append(f"{counts[verdict]}{of} {verb}")
    if not parts:
        return f"All {len(verdicts)} {things} are resolved."
    return f"{', '.join(parts)}; {counts[RESOLVED] or 'none'} resolved."


def plot_verdicts(axis, places, values, verdicts, colour, not_steady=None, size=7.0, alpha=1.0):
    """A marker a value, by its verdict, with a ring around what is not steady. What failed is left out; headline and legend count it."""
    places, values, verdicts = np.atleast_1d(places), np.atleast_1d(values), np.atleast_1d(verdicts)
    for verdict, (marker, filled) in LOOKS.items():
        chosen = verdicts == verdict
        axis.plot(places[chosen], values[chosen], marker, color=colour, markerfacecolor=colour if filled else "white", markersize=size,
                  markeredgewidth=(0.26 if marker in "x+" else 0.17) * size, linestyle="none", alpha=alpha, zorder=3)
    if not_steady is not None:
        ring = np.atleast_1d(not_steady) & (verdicts != FAILED)
        axis.plot(places[ring], values[ring], "o", color="#999999", markerfacecolor="none", markersize=RING, linestyle="none", zorder=2)


def verdict_handles(verdicts, with_steadiness=True):
    """Entries of a legend: every verdict's marker with the number of runs that have it."""
    import matplotlib.pyplot as plt

    counts = Counter(verdicts)
    handles = [plt.Line2D([], [], linestyle="none", marker=marker, color="#333333", markerfacecolor="#333333" if filled else "white",
                          label=f"{text_of(verdict)}: {counts[verdict]}")
               for verdict, (marker, filled) in LOOKS.items() if verdict or counts[verdict]]
    handles.append(plt.Line2D([], [], linestyle="none", label=f"failed, not drawn: {counts[FAILED]}"))
    if with_steadiness:
        handles.append(plt.Line2D([], [], linestyle="none", marker="o", color="#999999", markerfacecolor="none", markersize=11,
                                  label="ring: not steady, or not done"))
    return handles
