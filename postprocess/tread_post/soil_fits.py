"""Constants of soil from the curves of soil tests, with 95 % intervals."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Constant:
    """A fitted value and its interval, Student's, from the curvature of the least squares and the scatter of the residuals."""

    value: float
    low: float
    high: float
    unit: str


class FitError(Exception):
    """The curves do not tell the constants; the message says why."""


def bekker(widths, sinkages, pressures):
    """{k_c, k_phi, n} of p = (k_c/b + k_phi) z^n, the least squares of the pressure over all plates. `widths` are b in m, radius of a disc or shorter edge, one
    a plate; `sinkages` in m and `pressures` in Pa are arrays, one a plate. FitError with fewer than two widths: see one_plate."""
    if len({round(width, 9) for width in widths}) < 2:
        raise FitError("k_c and k_phi need plates of two widths or more")
    width = np.concatenate([np.full(len(sinkage), b) for b, sinkage in zip(widths, sinkages)])
    sinkage, pressure = np.concatenate(sinkages), np.concatenate(pressures)
    known = _loaded(sinkage, pressure)
    width, sinkage, pressure = width[known], sinkage[known], pressure[known]
    top, load, middle = sinkage.max(), pressure.max(), np.exp(np.mean(np.log(widths)))

    def scaled(parameters):
        cohesive, frictional, exponent = parameters
        return ((cohesive * middle / width + frictional) * (sinkage / top) ** exponent) - pressure / load

    values, covariance, freedom = _solve(scaled, [0.0, 1.0, 1.0])
    exponent = values[2]
    # In units of load/top^n, which depends on n: the derivative of top^-n carries n's uncertainty over.
    to_units = np.array([[load * middle * top**-exponent, 0, -values[0] * load * middle * top**-exponent * np.log(top)],
                         [0, load * top**-exponent, -values[1] * load * top**-exponent * np.log(top)], [0, 0, 1]])
    fitted = [values[0] * to_units[0, 0], values[1] * to_units[1, 1], exponent]
    return _constants(("k_c", "k_phi", "n"), fitted, to_units @ covariance @ to_units.T, freedom, ("N/m^(n+1)", "N/m^(n+2)", "1"))


def one_plate(sinkage, pressure):
    """{k, n} of p = k z^n of one plate; k = k_c/b + k_phi."""
    known = _loaded(sinkage, pressure)
    sinkage, pressure = sinkage[known], pressure[known]
    top, load = sinkage.max(), pressure.max()
    values, covariance, freedom = _solve(lambda p: p[0] * (sinkage / top) ** p[1] - pressure / load, [1.0, 1.0])
    factor = load * top ** -values[1]
    to_units = np.array([[factor, -values[0] * factor * np.log(top)], [0, 1]])
    return _constants(("k", "n"), [values[0] * factor, values[1]], to_units @ covariance @ to_units.T, freedom, ("N/m^(n+2)", "1"))


def janosi(displacements, normals, shears):
    """{c, tan_phi, phi, K} of tau = (c + sigma tan phi)(1 - exp(-j/K)); arrays, one a test: j in m, sigma and tau in Pa. Tests under one mean normal stress
    do not tell c from tan phi: then c is taken to be 0 and left out."""
    displacement, normal, shear = (np.concatenate(parts) for parts in (displacements, normals, shears))
    known = np.isfinite(displacement) & np.isfinite(normal) & np.isfinite(shear) & (displacement >= 0)
    displacement, normal, shear = displacement[known], normal[known], shear[known]
    if len(shear) < 8:
        raise FitError(f"{len(shear)} rows of shear; 8 at least")
    means = [np.mean(part) for part in normals]
    with_cohesion = bool(max(means) > 1.1 * min(means))
    load, length = np.abs(normal).max(), displacement.max()
    # K starts where half of the largest shear is reached, whatever the curve does later.
    half = displacement[np.argmax(shear >= 0.5 * shear.max())] / length / np.log(2)

    def scaled(parameters):
        cohesion = parameters[2] if with_cohesion else 0.0
        # An exponential of K's logarithm keeps K positive.
        risen = -np.expm1(-displacement / length * np.exp(-parameters[1]))
        return (cohesion + parameters[0] * normal / load) * risen - shear / load

    start = [max(0.05, float(np.median(shear / normal))), np.log(max(half, 1e-3))] + [0.0] * with_cohesion
    values, covariance, freedom = _solve(scaled, start)
    shear_length = length * np.exp(values[1])
    scale = np.diag([1.0, shear_length] + [load] * with_cohesion)
    fitted = [values[0], shear_length, *(load * values[2:])]
    names, units = ("tan_phi", "K") + ("c",) * with_cohesion, ("1", "m") + ("Pa",) * with_cohesion
    constants = _constants(names, fitted, scale @ covariance @ scale, freedom, units)
    angle = constants["tan_phi"]
    constants["phi"] = Constant(*(float(np.degrees(np.arctan(bound))) for bound in (angle.value, angle.low, angle.high)), "deg")
    return constants


def line(x, y, units):
    """{slope, intercept} of a straight line; `units` of both."""
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known], y[known]
    if len(x) < 3 or np.ptp(x) == 0:
        raise FitError(f"{len(x)} different places; 3 at least")
    across, up = float(np.abs(x).max()), float(np.abs(y).max()) or 1.0
    values, covariance, freedom = _solve(lambda p: p[0] * x / across + p[1] - y / up, [1.0, 0.0])
    scale = np.diag([up / across, up])
    return _constants(("slope", "intercept"), scale @ values, scale @ covariance @ scale, freedom, units)


def _loaded(sinkage, pressure):
    """Rows [n] of a plate that is below the surface and carries something."""
    known = np.isfinite(sinkage) & np.isfinite(pressure) & (sinkage > 0) & (pressure > 0)
    if known.sum() < 8:
        raise FitError(f"{known.sum()} rows with sinkage and pressure over 0; 8 at least")
    return known


def _solve(residuals, start):
    """(values, covariance, degrees of freedom) of the least squares."""
    found = least_squares(residuals, start, x_scale="jac", ftol=1e-12, xtol=1e-12, gtol=1e-12)
    freedom = len(found.fun) - len(start)
    normal = found.jac.T @ found.jac
    if not found.success or freedom < 1 or np.linalg.cond(normal) > 1e14:
        raise FitError("the rows do not tell the constants apart")
    return found.x, np.linalg.inv(normal) * (found.fun @ found.fun) / freedom, freedom


def _constants(names, values, covariance, freedom, units):
    reach = student.ppf(0.5 + 0.5 * CONFIDENCE, freedom) * np.sqrt(np.diag(covariance))
    return {name: Constant(float(value), float(value - half), float(value + half), unit)
            for name, value, half, unit in zip(names, values, reach, units)}
