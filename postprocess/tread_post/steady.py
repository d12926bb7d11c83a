"""Where a fluctuating series has become steady, and its mean from there on."""

from dataclasses import dataclass

import numpy as np

# The series is judged in this many batches at most; fewer values than twice as many batches as needed say nothing.
BATCHES, FEWEST = 100, 20
# Of the series, that has to be left after the transient.
SHORTEST_SHARE = 0.4
# A trend over the steady part that is this many times its own uncertainty, and this share of the mean or of the spread, is one.
SIGNIFICANT, NOTABLE = 3.0, 0.05
# Batches of the steady part whose means are taken to be independent.
INDEPENDENT = 8


@dataclass(frozen=True)
class Steady:
    """Means are over the rows from `start` on. Where `is_steady` is false they are over the last half, and say only what it was like."""

    start: float  # of the series' own time
    mean: float
    spread: float  # standard deviation of the rows
    error: float  # standard error of the mean, from means of eight parts
    is_steady: bool


def steady_part(time, values):
    """Steady of a series [n]. The transient is cut where the standard error of what remains is least (MSER: K. P. White, Simulation 69, 1997),
    SHORTEST_SHARE of the series remaining at least; what remains must be without trend. None for a series too short to judge."""
    known = np.isfinite(values)
    time, values = time[known], values[known]
    if len(values) < FEWEST:
        return None
    size = max(1, len(values) // BATCHES)
    means = values[: len(values) // size * size].reshape(-1, size).mean(axis=1)
    cuts = np.arange(int((1 - SHORTEST_SHARE) * len(means)) + 1)
    errors = [np.var(means[cut:]) / (len(means) - cut) for cut in cuts]
    first = int(np.argmin(errors)) * size
    if _has_trend(time[first:], values[first:]):
        return _over(time, values, len(values) // 2, False)
    return _over(time, values, first, True)


def _over(time, values, first, is_steady):
    part = values[first:]
    return Steady(float(time[first]), float(part.mean()), float(part.std()), error_of_mean(part), is_steady)


def error_of_mean(values):
    """Standard error, from the means of INDEPENDENT parts."""
    parts = np.array([part.mean() for part in np.array_split(values, INDEPENDENT)])
    return float(parts.std(ddof=1) / np.sqrt(INDEPENDENT))


def _has_trend(time, values):
    """Whether a line through the means of eight parts rises or falls by more than it may by chance, and by an amount that matters."""
    times = np.array([part.mean() for part in np.array_split(time, INDEPENDENT)])
    means = np.array([part.mean() for part in np.array_split(values, INDEPENDENT)])
    slope, height = np.polyfit(times, means, 1)
    scatter = np.sqrt(np.sum((means - slope * times - height) ** 2) / (INDEPENDENT - 2))
    uncertainty = scatter / np.sqrt(np.sum((times - times.mean()) ** 2))
    rise = abs(slope) * (time[-1] - time[0])
    return abs(slope) > SIGNIFICANT * uncertainty and rise > NOTABLE * max(abs(values.mean()), values.std())
