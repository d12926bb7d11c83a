"""Least squares with few, dear evaluations: rounds of runs around the best point so far, a quadratic of each measured value in the parameters, and
scipy.optimize.least_squares on that quadratic. Needs numpy and scipy.

Parameters are unknowns in [0, 1]: a parameter's place between its bounds, on a linear or a logarithmic scale."""

import math
from dataclasses import dataclass
from typing import Callable

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import qmc, t as student

HALF_WIDTH, LEAST_HALF_WIDTH = 0.5, 0.03  # of the region around the best point: of the first round, and below which rounds end
SHRINK = 0.5  # of the half width, where the best point lies well inside
INSIDE = 0.8  # of the half width: what counts as well inside
SETTLED = 0.2  # standard errors that the best point may still move in the last round
SURPLUS = 1.5  # runs of a round over the coefficients of a quadratic
DIGITS = 9  # of unknowns: rounds that are made again have the same runs to the bit
BURN_IN, THINNING = 1000, 20  # steps of the random walk that samples the posterior


@dataclass(frozen=True)
class Parameter:
    key: str  # of the scene
    low: float
    high: float
    scale: str = "linear"  # or "log"

    def value(self, unknown):
        """The parameter at a place between its bounds; works on arrays."""
        if self.scale == "log":
            return self.low * (self.high / self.low) ** unknown
        return self.low + (self.high - self.low) * unknown


@dataclass(frozen=True)
class Problem:
    parameters: tuple
    measured: np.ndarray  # [m]
    deviation: np.ndarray  # [m], standard deviations of the measured values; NaN throughout where none are known
    evaluate: Callable  # (round, unknowns [n, p]) -> values [n, m]; NaN in rows that failed

    @property
    def weights(self):
        """One over the deviations; without them one over the range of the measured values, which makes residuals comparable."""
        if np.isfinite(self.deviation).all():
            return 1.0 / self.deviation
        return np.full(len(self.measured), 1.0 / max(np.ptp(self.measured), abs(self.measured).max(), 1e-300))


class FitError(Exception):
    """The runs do not determine the parameters; the message says why."""


@dataclass(frozen=True)
class Fit:
    unknowns: np.ndarray  # [p], the best point
    covariance: np.ndarray  # [p, p], of the unknowns
    residuals: np.ndarray  # [m], model less measured at the best point, in units of the measured values
    scatter: float  # standard deviation of weighted residuals; 1 means that they are as large as the measured scatter
    degrees: int  # of freedom
    rounds: int
    settled: bool  # whether the best point came to rest
    at_bound: tuple  # of bool, one a parameter
    model: Callable  # unknowns [p] -> values [m], in the last region
    weights: np.ndarray  # [m]

    @property
    def errors(self):
        """Standard errors of the unknowns."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def correlation(self):
        errors = np.where(self.errors > 0, self.errors, np.inf)
        return self.covariance / np.outer(errors, errors)

    def interval(self, level=0.95):
        """(low, high) of the unknowns, [p] each, cut at the bounds; by Student's distribution where the scatter was estimated."""
        half = student.ppf(0.5 + 0.5 * level, self.degrees) * self.errors
        return np.clip(self.unknowns - half, 0, 1), np.clip(self.unknowns + half, 0, 1)


def fitted(problem, most_rounds=6):
    """The Fit of a problem. FitError where there are not enough values or runs."""
    count = len(problem.parameters)
    if len(problem.measured) <= count:
        raise FitError(f"{len(problem.measured)} measured values for {count} parameters; at least {count + 1}")
    centre, half = np.full(count, 0.5), HALF_WIDTH
    pool_at, pool_values = np.zeros((0, count)), np.zeros((0, len(problem.measured)))
    settled = False
    for number in range(most_rounds):
        places = round_places(centre, half, number)
        values = problem.evaluate(number, places)
        known = np.isfinite(values).all(axis=1)
        pool_at, pool_values = np.concatenate((pool_at, places[known])), np.concatenate((pool_values, values[known]))
        surrogate = Quadratic(pool_at, pool_values, centre, half)
        best = _best(problem, surrogate, centre, half)
        step = np.abs(best - centre)
        solution = _solution(problem, surrogate, best, number + 1)
        # The first round knows nothing of the neighbourhood of its best point but the coarse quadratic.
        settled = number > 0 and bool((step <= SETTLED * np.maximum(solution.errors, 1e-9)).all() or half <= LEAST_HALF_WIDTH and (step < INSIDE * half).all())
        if settled:
            break
        half = max(LEAST_HALF_WIDTH, SHRINK * half) if (step < INSIDE * half).all() or number == 0 else half
        centre = np.round(best, DIGITS)
    return Fit(**{**vars(solution), "settled": settled})


def round_places(centre, half, number):
    """Unknowns of the runs of a round, [n, p]: the centre, both ends of each direction, and a Latin hypercube, inside the bounds."""
    count = len(centre)
    coefficients = (count + 1) * (count + 2) // 2
    star = [centre + sign * half * axis for axis in np.eye(count) for sign in (1, -1)]
    rest = max(0, math.ceil(SURPLUS * coefficients) - 1 - len(star))
    cube = qmc.LatinHypercube(count, seed=number).random(rest) if rest else np.zeros((0, count))
    low, high = np.clip(centre - half, 0, 1), np.clip(centre + half, 0, 1)
    places = np.clip(np.concatenate((centre[None], star, low + (high - low) * cube)), 0, 1)
    return np.unique(np.round(places, DIGITS), axis=0)


class Quadratic:
    """Polynomial of second degree for values [n, m] in unknowns [n, p] around a centre, fitted to the runs within the region around it."""

    def __init__(self, places, values, centre, half):
        self.centre, self.half = centre, half
        near = (np.abs(places - centre) <= half * (1 + 1e-6)).all(axis=1)
        terms = self._terms(places[near])
        if near.sum() < terms.shape[1]:
            raise FitError(f"{int(near.sum())} runs with answers around the best point; a quadratic in {len(centre)} parameters wants {terms.shape[1]}")
        self.coefficients, *_ = np.linalg.lstsq(terms, values[near], rcond=None)

    def _terms(self, places):
        x = (places - self.centre) / self.half
        pairs = [x[:, i] * x[:, j] for i in range(x.shape[1]) for j in range(i, x.shape[1])]
        return np.stack([np.ones(len(x)), *x.T, *pairs], axis=1)

    def __call__(self, unknowns):
        return self._terms(np.asarray(unknowns)[None])[0] @ self.coefficients


def _best(problem, surrogate, centre, half):
    low, high = np.clip(centre - half, 0, 1), np.clip(centre + half, 0, 1)
    weights = problem.weights
    found = least_squares(lambda unknowns: weights * (surrogate(unknowns) - problem.measured), np.clip(centre, low + 1e-12, high - 1e-12),
                          bounds=(low, high), xtol=1e-12, ftol=1e-12, gtol=1e-12)
    return found.x


def _solution(problem, surrogate, best, rounds):
    weights, step = problem.weights, 1e-4
    jacobian = np.stack([weights * (surrogate(best + step * axis) - surrogate(best - step * axis)) / (2 * step) for axis in np.eye(len(best))], axis=1)
    residuals = surrogate(best) - problem.measured
    degrees = len(residuals) - len(best)
    scatter = float(np.sqrt(np.sum((weights * residuals) ** 2) / degrees))
    normal = jacobian.T @ jacobian
    if np.linalg.cond(normal) > 1e14:
        raise FitError("the measured values do not tell the parameters apart: some combination of them changes nothing. Fit fewer, or measure more")
    at_bound = tuple(bool(unknown < 1e-3 or unknown > 1 - 1e-3) for unknown in best)
    return Fit(best, scatter**2 * np.linalg.inv(normal), residuals, scatter, degrees, rounds, False, at_bound, surrogate, weights)


def posterior(problem, fit, count, seed=1):
    """Unknowns [count, p] of a random walk (Metropolis) over the likelihood of normal residuals with the fit's scatter; the prior is flat between the
    bounds, on each parameter's scale."""
    stream = np.random.default_rng(seed)
    steps = np.linalg.cholesky(fit.covariance + 1e-18 * np.eye(len(fit.unknowns))) * 2.38 / math.sqrt(len(fit.unknowns))

    scale = fit.scatter or 1.0  # a curve without noise leaves no scatter

    def misfit(unknowns):
        return 0.5 * float(np.sum((fit.weights * (fit.model(unknowns) - problem.measured) / scale) ** 2))

    here, cost, samples = fit.unknowns, misfit(fit.unknowns), []
    for number in range(BURN_IN + THINNING * count):
        there = here + steps @ stream.standard_normal(len(here))
        if ((there >= 0) & (there <= 1)).all() and (new := misfit(there)) - cost < stream.exponential():
            here, cost = there, new
        if number >= BURN_IN and (number - BURN_IN) % THINNING == 0:
            samples.append(here)
    return np.array(samples)
