"""A wheel on dry sand by granular resistive force theory in three dimensions: S. Agarwal, D. I. Goldman and K. Kamrin, PNAS 120(4), e2214017120
(2023). The traction on a surface element is proportional to its depth and depends on its normal and its direction of motion; a sand has one
coefficient, which follows from its density, gravity and internal friction. The theory in the plane, from which its idea comes, is that of C. Li,
T. Zhang and D. I. Goldman, Science 339, 1408 (2013). World axes: x forwards, y along the axle, z up; the sand's surface is z = 0."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

# Coefficients of the terms below in the traction along the normal, the velocity and gravity; PNAS 2023, supporting information.
_NORMAL = np.array([0.00212, -0.02320, -0.20890, -0.43083, -0.00259, 0.48872, -0.00415, 0.07204, -0.02750, -0.08772,
                    0.01992, -0.45961, 0.40799, -0.10107, -0.06576, 0.05664, -0.09269, 0.01892, 0.01033, 0.15120])
_VELOCITY = np.array([-0.06796, -0.10941, 0.04725, -0.06914, -0.05835, -0.65880, -0.11985, -0.25739, -0.26834, 0.02692,
                      -0.00736, 0.63758, 0.08997, 0.21069, 0.04748, 0.20406, 0.18589, 0.04934, 0.13527, -0.33207])
_GRAVITY = np.array([-0.02634, -0.03436, 0.45256, 0.00835, 0.02553, -1.31290, -0.05532, 0.06790, -0.16404, 0.02287,
                     0.02927, 0.95406, -0.00131, -0.11028, 0.01487, -0.02730, 0.10911, -0.04097, 0.07881, -0.27519])
_DOWN = np.array([0.0, 0.0, -1.0])
# Fourier coefficients of the generic stress per depth of the theory in the plane; Science 2013, supplement, table S3.
_A00, _A10, _B11, _B01, _B_11 = 0.206, 0.169, 0.212, 0.358, 0.055
_C11, _C01, _C_11, _D10 = -0.124, 0.253, 0.007, 0.088

ANGLES, HALVINGS = 720, 50  # elements around the rim; steps of the search for the sinkage
PHASES = 8  # positions of the grousers over one pitch, of which the mean is taken


@dataclass(frozen=True)
class Sand:
    density: float  # kg/m3, in bulk
    friction: float  # tangent of the internal friction angle
    surface_friction: float  # Coulomb's coefficient of sand and rim
    gravity: float = 9.81  # m/s2

    @property
    def coefficient(self):
        """xi_n, N/m3: a fit of the authors to continuum computations with internal frictions of 0.2 to 0.9."""
        mu = self.friction
        return self.density * self.gravity * (894 * mu**3 - 386 * mu**2 + 89 * mu)


@dataclass(frozen=True)
class RimWheel:
    """A drum with straight grousers. Its side faces are left out: they slide along the sand, and the theory gives such faces no traction."""

    radius: float  # m, of the drum
    width: float  # m
    weight: float  # N
    grousers: int = 0
    grouser_height: float = 0.0  # m, above the drum
    grouser_width: float = 0.0  # m, along the circumference

    @property
    def outer_radius(self):
        return self.radius + (self.grouser_height if self.grousers else 0.0)


@dataclass(frozen=True)
class Driven:
    sinkage: float  # m, of the lowest point
    drawbar_pull: float  # N
    torque: float  # N m, that drives the wheel


def generic_traction(normal, direction):
    """Traction over coefficient and depth, before the limit of surface friction, [n, 3]: on elements whose unit normals [n, 3] and unit directions of
    motion [n, 3] are given. The fit is one of thin plates: which of its two sides a normal points to makes no difference."""
    normal = np.where((normal @ _DOWN < 0)[:, None], -normal, normal)
    down_motion, down_normal = direction @ _DOWN, normal @ _DOWN
    advance = np.einsum("ij,ij->i", normal, direction)
    x, y, z = down_motion, down_normal, advance
    terms = np.stack((np.ones_like(x), x, y, z, x * x, y * y, z * z, x * y, y * z, z * x, x**3, y**3, z**3,
                      x * y * y, y * x * x, y * z * z, z * y * y, z * x * x, x * z * z, x * y * z), axis=1)
    along_normal, along_velocity, along_gravity = terms @ _NORMAL, terms @ _VELOCITY, terms @ _GRAVITY
    return along_normal[:, None] * normal + along_velocity[:, None] * direction + along_gravity[:, None] * _DOWN


def planar_traction(attack, intrusion):
    """(alpha_x, alpha_z), N/cm3, of the theory in the plane: generic stress per depth on a plate at angle `attack` to the horizontal that moves at
    angle `intrusion` below it, both in rad."""
    double = 2 * attack
    vertical = (_A00 + _A10 * np.cos(double) + _B11 * np.sin(double + intrusion) + _B01 * np.sin(intrusion) + _B_11 * np.sin(intrusion - double))
    horizontal = _C11 * np.cos(double + intrusion) + _C01 * np.cos(intrusion) + _C_11 * np.cos(intrusion - double) + _D10 * np.sin(double)
    return horizontal, vertical


def stress_on(sand, position, normal, velocity):
    """Traction of the sand, Pa, [n, 3], on surface elements at `position` with outward unit normals and velocities, each [n, 3]. Elements above the
    surface, at rest, or that move away from the sand have none. What is tangential is at most the surface friction times what is normal."""
    speed = np.linalg.norm(velocity, axis=1)
    depth = np.clip(-position[:, 2], 0.0, None)
    loaded = (depth > 0) & (speed > 0) & (np.einsum("ij,ij->i", normal, velocity) > 0)
    stress = np.zeros_like(position)
    if not loaded.any():
        return stress
    facing = normal[loaded]
    traction = generic_traction(facing, velocity[loaded] / speed[loaded, None])
    pressure = np.einsum("ij,ij->i", traction, facing)
    tangential = traction - pressure[:, None] * facing
    size = np.linalg.norm(tangential, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(size > 0, np.minimum(sand.surface_friction * np.abs(pressure) / size, 1.0), 0.0)
    limited = pressure[:, None] * facing + share[:, None] * tangential
    stress[loaded] = sand.coefficient * depth[loaded, None] * limited
    return stress


def wheel_elements(wheel, phase=0.0):
    """(positions from the axle, outward unit normals, areas) of the rim and of each grouser's two faces and tip; `phase` is the angle of a grouser
    from the lowest point, rad."""
    step = 2 * np.pi / ANGLES
    angle = (np.arange(ANGLES) + 0.5) * step
    covered = np.zeros(ANGLES, bool)
    parts = []
    if wheel.grousers and wheel.grouser_height > 0:
        middle = phase + 2 * np.pi * np.arange(wheel.grousers) / wheel.grousers
        half = 0.5 * wheel.grouser_width / wheel.radius
        distance = np.abs((angle[:, None] - middle + np.pi) % (2 * np.pi) - np.pi)
        covered = (distance <= half).any(axis=1)
        parts += _grouser_faces(wheel, middle, half)
    rim = _outward(angle[~covered])
    parts.append((wheel.radius * rim, rim, np.full(len(rim), wheel.radius * step * wheel.width)))
    return tuple(np.concatenate(arrays) for arrays in zip(*parts))


def _outward(angle):
    """Unit vectors at angles from the lowest point towards +x."""
    return np.stack((np.sin(angle), np.zeros_like(angle), -np.cos(angle)), axis=-1)


def _grouser_faces(wheel, middle, half):
    layers = 6
    height = (np.arange(layers) + 0.5) / layers * wheel.grouser_height
    area = np.full(len(middle) * layers, wheel.grouser_height / layers * wheel.width)
    outward = _outward(middle)
    forwards = np.stack((np.cos(middle), np.zeros_like(middle), np.sin(middle)), axis=-1)
    parts = []
    for side in (1.0, -1.0):
        place = ((wheel.radius + height)[None, :, None] * outward[:, None, :] + side * 0.5 * wheel.grouser_width * forwards[:, None, :])
        parts.append((place.reshape(-1, 3), np.repeat(side * forwards, layers, axis=0), area))
    parts.append((wheel.outer_radius * outward, outward, np.full(len(middle), wheel.grouser_width * wheel.width)))
    return parts


@lru_cache(maxsize=16)
def _mean_elements(wheel):
    """The elements at all positions of the grousers in one pitch, each with its share of the area: what is linear in them is a mean over the pitch."""
    phases = np.arange(PHASES) / PHASES * 2 * np.pi / wheel.grousers if wheel.grousers else (0.0,)
    arm, normal, area = (np.concatenate(arrays) for arrays in zip(*(wheel_elements(wheel, phase) for phase in phases)))
    lower = arm[:, 2] < 0  # the sand reaches up to the axle at most
    return arm[lower], normal[lower], area[lower] / len(phases)


def forces(wheel, sand, sinkage, speed, spin):
    """(lift N, pull N, driving torque N m): means over one pitch of the grousers, of a wheel that moves at `speed` m/s and turns at `spin` rad/s.
    The sinkage is at most the outer radius."""
    arm, normal, area = _mean_elements(replace(wheel, weight=0.0))
    position = arm + np.array([0.0, 0.0, wheel.outer_radius - sinkage])
    velocity = np.stack((speed + spin * arm[:, 2], np.zeros(len(arm)), -spin * arm[:, 0]), axis=1)
    force = area[:, None] * stress_on(sand, position, normal, velocity)
    torque = arm[:, 2] * force[:, 0] - arm[:, 0] * force[:, 2]
    return np.array([force[:, 2].sum(), force[:, 0].sum(), -torque.sum()])


def predict(wheel, sand, rim_speed, speed):
    """Driven at the sinkage that carries the wheel's weight; None where the sand does not carry it down to the axle. Only the ratio of the outer
    rim's speed and the wheel's matters; a rim at rest is a locked wheel."""
    spin = rim_speed / wheel.outer_radius
    low, high = 0.0, wheel.outer_radius
    if forces(wheel, sand, high, speed, spin)[0] < wheel.weight:
        return None
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if forces(wheel, sand, middle, speed, spin)[0] < wheel.weight else (low, middle)
        if high - low < 1e-7 * wheel.outer_radius:
            break
    _, pull, torque = forces(wheel, sand, high, speed, spin)
    return Driven(high, pull, torque)


def slip_for_pull(pull_at, wanted, most=0.99):
    """The least slip in [0, most] at which `pull_at(slip)`, N, reaches `wanted`; NaN where it never does, or where the wheel is not carried."""
    slips = np.linspace(0.0, most, 23)
    low = None
    for slip in slips:
        pull = pull_at(slip)
        if pull is None:
            return np.nan
        if pull >= wanted:
            break
        low = slip
    else:
        return np.nan
    if low is None:
        return 0.0
    high = slip
    for _ in range(14):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if pull_at(middle) < wanted else (low, middle)
    return high
