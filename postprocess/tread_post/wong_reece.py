"""A driven rigid wheel on level soil by the formulas of Wong and Reece: J. Y. Wong and A. R. Reece, "Prediction of rigid wheel performance based on
the analysis of soil-wheel stresses, part I", J. Terramech. 4(1), 1967. Stresses as functions of the angle from the lowest point, theta_2 = 0."""

from dataclasses import dataclass, replace

import numpy as np

STEPS = 400  # of the integrals over the contact angle


@dataclass(frozen=True)
class Soil:
    """Strength c + sigma tan(phi), mobilised over the shear length K; normal stress stiffness (z/b)^n."""

    name: str
    cohesion: float  # Pa
    friction_angle: float  # degrees
    stiffness: float  # Pa, at a sinkage of the wheel's width
    exponent: float
    shear_length: float  # m
    c1: float = 0.4  # where along the contact the stress is largest: (c1 + c2 s) theta_1
    c2: float = 0.3

    def at_width(self, width):
        """The soil for a wheel of this width; here it does not depend on it."""
        return self


@dataclass(frozen=True)
class BekkerSoil(Soil):
    """The same by Bekker's constants, (k_c/b + k_phi) z^n."""

    k_c: float = 0.0  # N/m^(n+1)
    k_phi: float = 0.0  # N/m^(n+2)

    def at_width(self, width):
        return replace(self, stiffness=(self.k_c / width + self.k_phi) * width**self.exponent)


# Published constants. Mojave Mars simulant: github.com/melanz/wheel-soil, k = 2.54e5 Pa, n = 1.387.
# Dry sand: J. Y. Wong, Theory of Ground Vehicles, 4th ed., Wiley 2008, table 2.3; shear length and c1, c2 as Wong and Reece give for loose sand.
PUBLISHED = (
    Soil("Mojave Mars simulant", 139.28, 34.74, 2.54e5, 1.387, 0.515e-3, 0.43, 0.32),
    BekkerSoil("dry sand (Wong)", 1040.0, 28.0, 0.0, 1.1, 0.025, 0.18, 0.32, k_c=990.0, k_phi=1528430.0),
)


@dataclass(frozen=True)
class Wheel:
    radius: float  # m
    width: float  # m
    weight: float  # N


@dataclass(frozen=True)
class Prediction:
    sinkage: float  # m
    drawbar_pull: float  # N
    torque: float  # N m


def predict(wheel, soil, slip):
    """Prediction at a slip in [0, 1); None where the soil does not carry the wheel."""
    soil = soil.at_width(wheel.width)
    low, high = 1e-3, 0.5 * np.pi
    if forces(wheel, soil, slip, high)[0] < wheel.weight:
        return None
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if forces(wheel, soil, slip, middle)[0] < wheel.weight else (low, middle)
    lift, pull, torque = forces(wheel, soil, slip, high)
    return Prediction(wheel.radius * (1 - np.cos(high)), pull, torque)


def forces(wheel, soil, slip, entry):
    """Lift (N), drawbar pull (N) and torque (N m) with soil from the entry angle (rad) to the lowest point."""
    angle = np.linspace(0.0, entry, STEPS + 1)
    peak = np.clip((soil.c1 + soil.c2 * slip) * entry, 1e-6, 0.999 * entry)
    # Behind the peak the stress is that of the mirrored angle in front of it (Wong and Reece, Eq. 5).
    mirrored = np.where(angle >= peak, angle, entry - angle / peak * (entry - peak))
    depth = wheel.radius * np.clip(np.cos(mirrored) - np.cos(entry), 0.0, None)
    normal = soil.stiffness * (depth / wheel.width) ** soil.exponent
    shear_way = wheel.radius * ((entry - angle) - (1 - slip) * (np.sin(entry) - np.sin(angle)))
    strength = soil.cohesion + normal * np.tan(np.radians(soil.friction_angle))
    shear = strength * -np.expm1(-shear_way / soil.shear_length)
    area = wheel.radius * wheel.width
    lift = area * np.trapz(normal * np.cos(angle) + shear * np.sin(angle), angle)
    pull = area * np.trapz(shear * np.cos(angle) - normal * np.sin(angle), angle)
    return lift, pull, wheel.radius * area * np.trapz(shear, angle)


def soils_like(scene, width):
    """The published soils with the strength of the scene's first granular material: nothing in a scene tells stiffness, exponent and shear length
    of these formulas, so that they span a band. Empty for a scene without such a material."""
    granular = [material for material in scene.get("material", []) if "friction_angle_deg" in material]
    if not granular:
        return []
    sand = granular[0]
    return [replace(soil, cohesion=sand.get("cohesion", 0.0), friction_angle=sand["friction_angle_deg"]).at_width(width) for soil in PUBLISHED]


def wheel_of(scene, weight):
    """The driven wheel of a scene by its generator's or its preset's radius and width; None where neither says, or where it has no weight."""
    if not weight > 0:
        return None
    presets = {"perseverance": (0.26, 0.33), "curiosity": (0.25, 0.4), "spirit": (0.13, 0.16), "viper": (0.25, 0.2)}
    driven = [phase["drive"]["body"] for phase in scene.get("phase", []) if "drive" in phase]
    body = next((body for body in scene.get("body", []) if driven and body["name"] == driven[-1]), None)
    if body is None:
        return None
    shape = next((shape for shape in scene.get("shape", []) if shape["name"] == body["shape"]), {})
    generate = shape.get("generate", {})
    if generate.get("kind") == "wheel":
        return Wheel(generate.get("radius", 0.26), generate.get("width", 0.33), weight)
    if body["shape"] in presets:
        return Wheel(*presets[body["shape"]], weight)
    return None
