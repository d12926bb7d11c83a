"""Bearing capacity of shallow footings on soil with friction angle and cohesion. Angles in radians, SI units, pressures in Pa."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Ground:
    """Soil under a level surface."""

    friction: float  # rad
    dilation: float  # rad
    cohesion: float  # Pa
    weight: float  # N/m3


def n_q(friction):
    """Factor of the surcharge: H. Reissner (1924), exact for a strip on weightless soil."""
    return math.exp(math.pi * math.tan(friction)) * flow_value(friction)


def n_c(friction):
    """Factor of the cohesion: L. Prandtl (1920)."""
    return (n_q(friction) - 1) / math.tan(friction) if friction > 0 else 2 + math.pi


def n_gamma(friction):
    """Factor of the own weight under a rough strip: M. Hjiaj, A. V. Lyamin and S. W. Sloan, Int. J. Solids Struct. 42, 2005, 1681-1704, a fit of
    their bounds."""
    tan = math.tan(friction)
    return math.exp((math.pi + 3 * math.pi**2 * tan) / 6) * tan ** (0.4 * math.pi)


def flow_value(angle):
    """tan^2(45 degrees + angle/2): the ratio of principal stresses at failure of cohesionless soil."""
    return math.tan(math.pi / 4 + angle / 2) ** 2


def reduced_tan(friction, dilation):
    """Shear over normal stress on a plane without strain along it, of flow with that dilation: E. H. Davis (1968), in Soil Mechanics - Selected
    Topics. tan(friction) where the two angles are equal, sin(friction) without dilation."""
    sin = math.sin(friction)
    return sin * math.cos(dilation) / (1 - sin * math.sin(dilation))


def strip_bounds(ground, width, depth):
    """(lower, upper) mean pressure under a strip pushed to `depth`. The lower one has Davis's angle and lets the soil beside the strip carry nothing; the
    upper one has the friction angle, the soil above the base as a surcharge, and J. Brinch Hansen's factor of the depth (1970)."""
    tan = reduced_tan(ground.friction, ground.dilation)
    lower = _capacity(math.atan(tan), ground.cohesion * tan / math.tan(ground.friction), 0.0, ground.weight, width)
    return lower, _capacity(ground.friction, ground.cohesion, ground.weight * depth * _depth_factor(ground, width, depth), ground.weight, width)


def round_bounds(ground, diameter, depth):
    """The same under a disc or a cone's base: the lower one with K. Terzaghi's 0.6 of the own weight's part (1943), the upper one with G. G. Meyerhof's
    1 + 0.1 K_p (1963) for the weight and Brinch Hansen's 1 + sin(friction) for surcharge and cohesion."""
    tan = reduced_tan(ground.friction, ground.dilation)
    lower = _capacity(math.atan(tan), ground.cohesion * tan / math.tan(ground.friction), 0.0, 0.6 * ground.weight, diameter)
    surcharge = ground.weight * depth * _depth_factor(ground, diameter, depth)
    shape = 1 + math.sin(ground.friction)
    weight = (1 + 0.1 * flow_value(ground.friction)) * ground.weight
    return lower, _capacity(ground.friction, shape * ground.cohesion, shape * surcharge, weight, diameter)


def _depth_factor(ground, width, depth):
    ratio = depth / width
    return 1 + 2 * math.tan(ground.friction) * (1 - math.sin(ground.friction)) ** 2 * (ratio if ratio <= 1 else math.atan(ratio))


def _capacity(friction, cohesion, surcharge, weight, width):
    return cohesion * n_c(friction) + surcharge * n_q(friction) + 0.5 * weight * width * n_gamma(friction)
