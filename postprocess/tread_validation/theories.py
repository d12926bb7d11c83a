"""What theories say at the measured points of a curve: resistive force theory, and the formulas of Wong and Reece."""

import math
from dataclasses import dataclass

import numpy as np

from tread_post.resistive_force import Sand, predict as rft_predict, slip_for_pull
from tread_post.wong_reece import BekkerSoil, Wheel, predict as wong_reece_predict
from tread_validation.sets import QUANTITIES

GRAVITY = 9.81  # m/s2; all sets were measured on Earth


@dataclass(frozen=True)
class Prediction:
    """One quantity at the measured points, each [n]: the first soil's value, and the least and largest of all soils. NaN where a theory has none."""

    value: np.ndarray
    low: np.ndarray
    high: np.ndarray


def predictions(measured_set, curve):
    """{theory: {quantity: Prediction}} of the theories that the set has constants for."""
    found = {"resistive force theory": _bands([_rft(measured_set, curve, soil) for soil in measured_set.theory])}
    if measured_set.bekker:
        found["Wong and Reece"] = _bands([_wong_reece(measured_set, curve, soil) for soil in measured_set.bekker])
    return found


def all_predictions(sets):
    """{(set, curve): predictions} of all curves, by names."""
    return {(measured_set.name, curve.name): predictions(measured_set, curve) for measured_set in sets.values() for curve in measured_set.curves}


def _bands(soils):
    bands = {}
    for name in QUANTITIES:
        values = np.array([soil[name] for soil in soils])
        known = np.isfinite(values).any(axis=0)
        low, high = np.full(values.shape[1], np.nan), np.full(values.shape[1], np.nan)
        low[known], high[known] = np.nanmin(values[:, known], axis=0), np.nanmax(values[:, known], axis=0)
        bands[name] = Prediction(values[0], low, high)
    return bands


def motions(curve, slips):
    """(rim speed, speed) at the measured points: as measured, or by the slip with a rim speed of 1 m/s."""
    rim, speed = curve.measured.column("rim_speed"), curve.measured.column("speed")
    return np.where(np.isfinite(rim), rim, 1.0), np.where(np.isfinite(speed), speed, 1.0 - slips)


def _columns(drives):
    """Quantities of drives at prescribed slips; NaN of None."""
    return {name: np.array([getattr(drive, name) if drive else np.nan for drive in drives]) for name in ("drawbar_pull", "torque", "sinkage")}


def _rft(measured_set, curve, soil):
    sand = Sand(soil["density"], math.tan(math.radians(soil["friction_angle_deg"])), soil["rim_friction"], GRAVITY)
    places = curve.measured.column(measured_set.against)
    if measured_set.against == "slope":
        return _at_slopes(places, lambda load, slip: rft_predict(curve.wheel_under(load), sand, 1.0, 1.0 - slip), curve)
    drives = [rft_predict(curve.wheel_under(load), sand, rim, speed) for load, rim, speed in zip(curve.loads, *motions(curve, places))]
    return _columns(drives) | {"slip": places}


def _wong_reece(measured_set, curve, constants):
    soil = BekkerSoil("", constants["cohesion"], constants["friction_angle_deg"], 0.0, constants["exponent"], constants["shear_length"],
                      k_c=constants["k_c"], k_phi=constants["k_phi"])
    radius = curve.wheel_under(1.0).outer_radius

    def drive(load, slip):
        return wong_reece_predict(Wheel(radius, curve.wheel["width"], load), soil, slip) if 0 <= slip < 1 else None

    places = curve.measured.column(measured_set.against)
    if measured_set.against == "slope":
        return _at_slopes(places, drive, curve)
    return _columns([drive(load, slip) for load, slip in zip(curve.loads, places)]) | {"slip": places}


def _at_slopes(slopes, drive, curve):
    """Slips at which the pull carries the wheel up each slope: the sand's surface is level, and gravity leans."""
    slips = []
    for slope, weight in zip(np.radians(slopes), curve.loads):
        def pull_at(slip, load=weight * math.cos(slope)):
            found = drive(load, slip)
            return None if found is None else found.drawbar_pull

        slips.append(slip_for_pull(pull_at, weight * math.sin(slope)))
    return {name: np.full(len(slopes), np.nan) for name in QUANTITIES} | {"slip": np.array(slips)}
