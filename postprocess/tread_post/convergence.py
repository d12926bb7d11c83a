"""Where a sequence of ever finer runs leads, in what order, and how well that is known."""

import math
from dataclasses import dataclass, replace

import numpy as np

# Orders outside of these are not believed: P. J. Roache, J. Fluids Eng. 116, 1994, 405-413; bounds and the larger factor as W. L. Oberkampf and C. J. Roy,
# Verification and Validation in Scientific Computing, 2010, 8.6.3.
LOWEST, HIGHEST = 0.5, 2.0
MEANINGLESS = 2 * HIGHEST  # over this the finest two are close by chance
FACTOR, CAREFUL_FACTOR = 1.25, 3.0
# Differences below this many standard deviations of perturbed repeats, or of the means' noise, tell of no order.
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
    order_range: tuple | None = None  # of the order, over all neighbouring threes and by noise; None where nothing tells


@dataclass(frozen=True)
class Fit:
    """f = value + C h^order."""

    value: float
    order: float


def limit_of(sizes, values, scatter=0.0, noise=None):
    """Limit of values [n] for sizes [n] > 0 that go to zero (spacing, step ...), all different, in any order. `scatter` is the standard deviation that
    repeats of one run have, `noise` [n] the standard error of each value. Three values or more that converge monotonically are fitted by
    f = f0 + C h^p (three: Richardson's extrapolation). The uncertainty is Roache's grid convergence index, or the disagreement of the neighbouring threes
    where that is larger, with the noise. Else the finest value, and the spread of the finest ones: unconverged."""
    errors = np.hypot(scatter, noise if noise is not None else np.zeros(len(sizes)))
    ordered = np.argsort(sizes)
    h, f, e = (np.asarray(column, float)[ordered] for column in (sizes, values, errors))
    if len(h) == 1:
        return Limit(f[0], math.nan, None, "one value")
    spread = float(np.ptp(f[:3]))
    if e[:3].max() > 0 and spread <= NOISE * e[:3].max():
        what = "the spread of repeats" if scatter > 0 else "the noise of the means"
        return Limit(f[0], NOISE * float(e[:3].max()), None, f"unconverged: differences within {what}")
    if len(h) == 2:
        return Limit(f[0], spread, None, "unconverged: difference of two values")
    if f[0] == f[1]:
        return Limit(f[0], spread, None, "unconverged: no change at the fine end")
    kept = _kept(h, f)
    fit = _fit(h[:kept], f[:kept])
    if fit is None:
        return Limit(f[0], spread, None, "unconverged: no monotone convergence, spread of three")
    found = _extrapolated(h[:kept], f[:kept], e[:kept], fit)
    return found if kept == len(h) else replace(found, text=f"{found.text}, without the {len(h) - kept} coarsest")


def _kept(h, f):
    """Number of the finest values that lie on the way to a limit: the coarsest need not yet."""
    kept = len(h)
    while kept > 3 and _fit(h[kept - 3:kept], f[kept - 3:kept]) is None:
        kept -= 1
    return kept


def _extrapolated(h, f, e, fit):
    triples = [_fit(h[start:start + 3], f[start:start + 3]) for start in range(len(h) - 2)]
    noisy = [_fit(h, f + e[index] * (np.arange(len(h)) == index)) for index in np.flatnonzero(e)]
    if None in triples or None in noisy:
        return Limit(f[0], float(np.ptp(f[:3])), None, "unconverged: an order that noise or leaving a value out takes away")
    used = min(max(fit.order, LOWEST), HIGHEST)
    is_believed = math.isclose(used, fit.order, rel_tol=1e-6)
    correction = fit.value - f[0] if is_believed else (f[0] - f[1]) / ((h[1] / h[0]) ** used - 1)
    by_noise = math.hypot(*(one.value - fit.value for one in noisy)) if is_believed else 0.0
    disagreement = max((abs(one.value - fit.value) for one in triples), default=0.0) if len(h) > 3 else 0.0
    index = (FACTOR if is_believed else CAREFUL_FACTOR) * abs(correction)
    uncertainty = math.hypot(max(index, disagreement), by_noise)
    orders = _range(fit, triples if len(h) > 3 else [], noisy)
    text = f"order {fit.order:.2g}" + (f" ({orders[0]:.2g} to {orders[1]:.2g})" if orders else "")
    if fit.order < LOWEST * (1 - 1e-6):
        return Limit(f[0], uncertainty, fit.order, f"unconverged: {text}, under {LOWEST:g}", order_range=orders)
    if fit.order > MEANINGLESS * (1 + 1e-6):
        return Limit(f[0], uncertainty, fit.order, f"unconverged: {text}, over {MEANINGLESS:g}", order_range=orders)
    if max(disagreement, by_noise) > np.ptp(f):
        return Limit(f[0], uncertainty, fit.order, f"unconverged: {text}, extrapolations differ by more than all values", order_range=orders)
    taken = "" if is_believed else f", taken as {used:g}"
    return Limit(float(f[0] + correction), uncertainty, fit.order, f"extrapolated, {text}{taken}", is_limit=True, order_range=orders)


def _range(fit, triples, noisy):
    """Smallest and largest order that the threes have, widened by what the noise changes; None where neither tells."""
    if not triples and not noisy:
        return None
    by_noise = math.hypot(*(one.order - fit.order for one in noisy))
    orders = [fit.order, *(one.order for one in triples)]
    return max(min(orders) - by_noise, 0.0), max(orders) + by_noise


def _fit(h, f):
    """The Fit of values by ascending size; None where the finest three do not converge monotonically. Weights are 1/h, as fine runs tell more of the limit:
    L. Eca and M. Hoekstra, J. Comput. Phys. 262, 2014, 104-130."""
    if f[0] == f[1]:
        return None
    order = observed_order(h[1] / h[0], h[2] / h[1], (f[2] - f[1]) / (f[1] - f[0]))
    if order is None:
        return None
    if len(h) == 3:
        return Fit(float(f[0] + (f[0] - f[1]) / ((h[1] / h[0]) ** order - 1)), order)
    order = _least_squares_order(h / h[0], f)
    return Fit(float(_linear(h / h[0], f, order)[0][0]), order) if order is not None else None


def _linear(x, f, order):
    """(f0, C) and the weighted residuals of the best line in x^order."""
    weights = np.sqrt(1 / x)
    matrix = np.stack((np.ones_like(x), x**order), axis=1)
    best = np.linalg.lstsq(matrix * weights[:, None], f * weights, rcond=None)[0]
    return best, weights * (f - matrix @ best)


def _least_squares_order(x, f):
    """Order of the least weighted squares; None where that lies at an end of what is searched."""
    def squares(order):
        return float(np.sum(_linear(x, f, order)[1] ** 2))

    grid = np.geomspace(SLOWEST, STEEPEST, 120)
    best = int(np.argmin([squares(order) for order in grid]))
    if best in (0, len(grid) - 1):
        return None
    order = grid[best]
    for _ in range(50):  # Gauss and Newton
        (_, slope), residual = _linear(x, f, order)
        weights = np.sqrt(1 / x)
        jacobian = weights[:, None] * np.stack((np.ones_like(x), x**order, slope * x**order * np.log(x)), axis=1)
        step = np.linalg.lstsq(jacobian, residual, rcond=None)[0][2]
        order = float(np.clip(order + step, grid[best - 1], grid[best + 1]))
        if abs(step) < 1e-13:
            break
    return order


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
