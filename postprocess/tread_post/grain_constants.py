"""Constants of `model = "bolton"` and of the rim's friction, from grains in plane-strain compression, under a sliding plate and in a bed."""

import math
from dataclasses import dataclass

import numpy as np

from tread_post.grains import grains_of, overlaps, void_ratio
from tread_post.run import RunError
from tread_post.soil_curves import curves_of, sample_of

POISSON = 0.2  # assumed, as configs/grains/continuum.toml does
# Bolton (1986) with Q = 10 under 150 kPa, plane strain: I_R = DENSITY_FACTOR I_D - 1, phi = phi_crit + DEGREES I_R,
# -d eps_v / d eps_1 = RATE I_R.
DENSITY_FACTOR, DEGREES, RATE, LARGEST_INDEX = 10 - math.log(150), 5.0, 0.3, 4.0
# Walls, plates and free surfaces order and loosen grains within some diameters; a quarter of a slab on each side at most.
LAYER = 3.0
# Share of axial strain on either side of the peak over which the rate of dilation is taken.
NEAR_PEAK = 0.01


@dataclass(frozen=True)
class Compression:
    """What a run of plane-strain compression gives."""

    confining: float  # Pa, mean at the end
    peak_angle: float  # degrees
    end_angle: float  # degrees, mean of the last quarter
    dilation_rate: float  # -d eps_v / d eps_1 at the peak
    end_rate: float  # the same over the last quarter: 0 in the critical state
    modulus: float  # Pa, Young's, secant to half of the peak's deviator
    pressure: float  # Pa, mean stress there
    void_ratio: float  # when the compression begins
    end_void_ratio: float
    overlap: float  # mean over diameters, at the end


@dataclass(frozen=True)
class Bed:
    void_ratio: float
    density: float  # kg/m3, with the layers at the slab's walls
    overlap: float


def _angle(ratio):
    return math.degrees(math.asin((ratio - 1) / (ratio + 1)))


def _rate(curve, rows):
    return -float(np.polyfit(curve["axial_strain"][rows], curve["volume_strain"][rows], 1)[0])


def _inner(grains, low, high, axes=(0, 1, 2)):
    """The box less layers on both sides of each of the axes."""
    inset = np.zeros(3)
    inset[list(axes)] = np.minimum(LAYER * grains.diameter, 0.25 * (high - low))[list(axes)]
    return low + inset, high - inset


def compression_of(run):
    """Compression of a run whose [reference] form is "triaxial"."""
    curve, (low, high) = curves_of(run)[0], sample_of(run)
    modulus, pressure = _secant(run, curve)
    begin, end = (grains_of(run, number) for number in _snapshots_of_last_phase(run))
    shrunk = high - (high - low) * np.array([curve["volume_strain"][-1] - curve["axial_strain"][-1], 0.0, curve["axial_strain"][-1]])
    return Compression(
        curve.plateau("confining_stress"), _angle(curve.peak("stress_ratio")), _angle(curve.plateau("stress_ratio")), _rate(curve, _near_peak(run, curve)),
        _rate(curve, slice(3 * len(curve["axial_strain"]) // 4, None)), modulus, pressure, void_ratio(begin, *_inner(begin, low, high)),
        void_ratio(end, *_inner(end, low, shrunk)), float(overlaps(end).mean()))


def _near_peak(run, curve):
    """Rows around the largest mean of a twentieth of the rows."""
    size = max(1, len(curve["stress_ratio"]) // 20)
    top = int(np.argmax(np.convolve(curve["stress_ratio"], np.ones(size) / size, "valid"))) + size // 2
    rows = np.flatnonzero(np.abs(curve["axial_strain"] - curve["axial_strain"][top]) <= NEAR_PEAK)
    if len(rows) < 4:
        raise RunError(f"{run.path}: {len(rows)} rows around the peak; 4 at least: lower [output] every")
    return rows


def _secant(run, curve):
    """(Young's modulus to half of the peak's deviator, mean stress there), Pa: in plane strain eps_1 = (1 - nu^2) (s_1 - s_3) / E under constant s_3."""
    deviator, strain = curve["deviator"], curve["axial_strain"]
    half = int(np.argmax(deviator >= 0.5 * curve.peak("deviator")))
    if half == 0:
        raise RunError(f"{run.path}: no rows before half of the peak; lower [output] every")
    modulus = (1 - POISSON**2) * (deviator[half] - deviator[0]) / (strain[half] - strain[0])
    return float(modulus), float((1 + POISSON) / 3 * (2 * curve["confining_stress"][half] + deviator[half]))


def _snapshots_of_last_phase(run):
    """(number of the one nearest to the phase's start, the last)."""
    times = {number: run.bodies(number).time for number in run.snapshots}
    if len(times) < 2:
        raise RunError(f"{run.path}: two snapshots at least are needed; set [output] snapshots_every")
    return min(times, key=lambda number: abs(times[number] - run.phases[-1].start)), max(times)


def plate_friction(run):
    """Friction of grains against the first body, which slides along x: mean of the last half of the last phase."""
    name = run.scene["body"][0]["name"]
    series, start = run.wheel(name), run.phases[-1].start
    force = series["force"][series["time"] > 0.5 * (start + series["time"][-1])]
    if not len(force) or force[:, 2].mean() <= 0:
        raise RunError(f"{run.path}: '{name}' carries nothing at the end")
    return float(abs(force[:, 0].mean()) / force[:, 2].mean())


def bed_of(run):
    """Bed of grains at the last snapshot."""
    if not run.snapshots:
        raise RunError(f"{run.path}: a snapshot of the bed is needed")
    grains, size = grains_of(run, max(run.snapshots)), np.array(run.scene["domain"]["size"], float)
    # The surface: what 99 of 100 grains lie below.
    size[2] = np.quantile(grains.centre[:, 2] + grains.radius, 0.99)
    whole = void_ratio(grains, *_inner(grains, np.zeros(3), size, (0, 2)))
    solid = next(material["density"] for material in run.scene["material"] if material["name"] == run.scene["rocks"][0]["material"])
    return Bed(void_ratio(grains, *_inner(grains, np.zeros(3), size)), solid / (1 + whole), float(overlaps(grains).mean()))


def settings_of(dense, loose, friction, bed):
    """({key: value} of configs/grains/continuum.toml, -d eps_v / d eps_1 that the law then has at the peak) from Compressions. Dense grains give the peak
    and its void ratio; loose ones, which shear without bands, angle and void ratio of the critical state; extreme void ratios are those with which the
    law has both. The modulus is that under the highest pressure, below which it falls with the root. RunError where dense grains are no denser or no
    stronger than loose ones."""
    peak, before = (float(np.mean([getattr(one, name) for one in dense])) for name in ("peak_angle", "void_ratio"))
    critical, after = (float(np.mean([getattr(one, name) for one in loose])) for name in ("end_angle", "end_void_ratio"))
    index = min((peak - critical) / DEGREES, LARGEST_INDEX)
    if index <= 0 or after <= before:
        raise RunError(f"dense grains of void ratio {before:.3f} have {peak:.1f} degrees, loose ones end with {after:.3f} and {critical:.1f}: "
                       "the law with density wants dense grains that are stronger")
    extent = (after - before) * DENSITY_FACTOR / index
    loosest = after + extent / DENSITY_FACTOR
    stiffest = max(dense, key=lambda one: one.pressure)
    relative = min(max((loosest - bed.void_ratio) / extent, 0.0), 1.0)
    settings = {"material.sand.density": bed.density, "material.sand.young": stiffest.modulus, "material.sand.young_pressure": stiffest.pressure,
                "material.sand.friction_angle_deg": critical, "material.sand.relative_density": relative,
                "material.sand.void_ratio_min": loosest - extent, "material.sand.void_ratio_max": loosest, "contact[0].friction": friction}
    return settings, RATE * index
