"""Where a sequence of ever finer runs leads, and how well that is known."""

import math
from dataclasses import dataclass

# Orders outside of these are not believed: P. J. Roache, Verification and Validation in Computational Science and Engineering, 1998; bounds and the larger
# factor as W. L. Oberkampf and C. J. Roy, Verification and Validation in Scientific Computing, 2010, 8.6.3.
LOWEST, HIGHEST = 0.5, 2.0
FACTOR, CAREFUL_FACTOR = 1.25, 3.0
# Differences below this many standard deviations of perturbed repeats tell of no order.
NOISE = 2.0
STEEPEST = 20.0
SLOWEST = 0.1  # what nears a limit more slowly than this order does not near one


@dataclass(frozen=True)
class Limit:
    value: float
    uncertainty: float  # in the values' unit; NaN where nothing tells
    order: float | None  # observed; None where the sequence does not converge monotonically
    text: str  # how it was found
    is_limit: bool = False  # what the sequence goes to, not only its finest value


def limit_of(sizes, values, scatter=0.0):
    """Limit of values [n] for sizes [n] > 0 that go to zero (spacing, step ...), all different, in any order. `scatter` is the standard deviation
    that repeats of one run have. With three values that converge monotonically: Richardson's extrapolation by the observed order, and as
    uncertainty Roache's grid convergence index; else the finest value, and the spread of the finest ones."""
    pairs = sorted(zip(sizes, values))
    if len(pairs) == 1:
        return Limit(pairs[0][1], math.nan, None, "one value")
    finest = pairs[0][1]
    last = [value for _, value in pairs[:3]]
    spread = max(last) - min(last)
    if scatter > 0 and spread <= NOISE * scatter:
        return Limit(finest, NOISE * scatter, None, "differences within the spread of repeats")
    if len(pairs) == 2:
        return Limit(finest, spread, None, "difference of two values")
    (h1, f1), (h2, f2), (h3, f3) = pairs[:3]
    if f1 == f2:
        return Limit(finest, spread, None, "no change at the fine end")
    order = observed_order(h2 / h1, h3 / h2, (f3 - f2) / (f2 - f1))
    if order is None:
        return Limit(finest, spread, None, "no monotone convergence: spread of three")
    used = min(max(order, LOWEST), HIGHEST)
    correction = (f1 - f2) / ((h2 / h1) ** used - 1)
    factor = FACTOR if math.isclose(used, order, rel_tol=1e-6) else CAREFUL_FACTOR
    return Limit(f1 + correction, max(factor * abs(correction), scatter), order, f"extrapolated, order {order:.2g}",
                 is_limit=True)


def observed_order(fine_ratio, coarse_ratio, differences):
    """p of f = f* + C h^p, from the ratios h2/h1 and h3/h2 (> 1) and (f3 - f2)/(f2 - f1); None below SLOWEST."""
    def ratio(p):
        return fine_ratio**p * (coarse_ratio**p - 1) / (fine_ratio**p - 1)

    if differences <= ratio(SLOWEST):
        return None
    low, high = SLOWEST, STEEPEST
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if ratio(middle) < differences else (low, middle)
    return high
