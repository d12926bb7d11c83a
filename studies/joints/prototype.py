#!/usr/bin/python3
"""Formulations of joints between rigid bodies, compared: drift, energy, stability and cost against the substep.

Bodies move as in tread: symplectic Euler for translation, angular momentum and the explicit midpoint for rotation.
Needs Debian's python3-numpy. Prints one table in Markdown for docs/decisions.
"""

import argparse
import time
from dataclasses import dataclass, field

import numpy as np

GRAVITY = np.array([0.0, 0.0, -9.81])


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def rotation(vector):
    angle = np.linalg.norm(vector)
    if angle < 1e-300:
        return np.eye(3)
    k = skew(vector / angle)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


@dataclass
class Body:
    mass: float
    inertia: np.ndarray  # kg m2, principal
    position: np.ndarray
    turn: np.ndarray = field(default_factory=lambda: np.eye(3))
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    spin: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def world_inertia(self, turn):
        return turn @ (self.inertia[:, None] * turn.T)

    def response(self):
        return self.turn @ ((1 / self.inertia)[:, None] * self.turn.T)

    def half_spin(self, torque, dt):
        """Angular velocity at mid-step: that which turns the body in this step."""
        momentum = self.world_inertia(self.turn) @ self.spin + dt * torque
        half = rotation(0.5 * dt * (self.response() @ momentum)) @ self.turn
        return half @ ((half.T @ momentum) / self.inertia)

    def move(self, force, torque, dt):
        momentum = self.world_inertia(self.turn) @ self.spin + dt * torque
        middle = self.half_spin(torque, dt)
        self.velocity = self.velocity + dt * force / self.mass
        self.position = self.position + dt * self.velocity
        self.turn = rotation(dt * middle) @ self.turn
        u, _, v = np.linalg.svd(self.turn)
        self.turn = u @ v
        self.spin = self.response() @ momentum

    def energy(self):
        kinetic = 0.5 * self.mass * self.velocity @ self.velocity + 0.5 * self.spin @ (
            self.world_inertia(self.turn) @ self.spin)
        return kinetic - self.mass * GRAVITY @ self.position


class Joint:
    """Holds `at` of a and b together, and turns or slides other than along `axis`; a = None is the world."""

    def __init__(self, bodies, kind, a, b, at, axis=(0, 1, 0)):
        at, self.kind, self.a, self.b, self.bodies = np.array(at, float), kind, a, b, bodies
        axis = np.array(axis, float) / np.linalg.norm(axis)
        other = np.cross(axis, [1, 0, 0] if abs(axis[0]) < 0.7 else [0, 1, 0])
        other /= np.linalg.norm(other)
        frame = np.column_stack([other, np.cross(axis, other), axis])
        self.sides = [(None if k is None else bodies[k].turn.T @ (at - bodies[k].position), at,
                       frame if k is None else bodies[k].turn.T @ frame) for k in (a, b)]

    def side(self, which):
        k = (self.a, self.b)[which]
        local, at, frame = self.sides[which]
        if k is None:
            return at, np.zeros(3), frame
        body = self.bodies[k]
        lever = body.turn @ local
        return body.position + lever, lever, body.turn @ frame

    def rows(self):
        """Directions of rows and their errors: (row of a, row of b, error), rows as force and torque parts."""
        pa, ra, fa = self.side(0)
        pb, rb, fb = self.side(1)
        gap, out = pb - pa, []
        if self.kind in ("revolute", "spherical", "fixed"):
            out += [(n, np.cross(ra, n), np.cross(rb, n), n @ gap) for n in np.eye(3)]
        if self.kind == "prismatic":
            out += [(n, np.cross(ra + gap, n), np.cross(rb, n), n @ gap) for n in fa.T[:2]]
        if self.kind == "revolute":
            out += [(None, n := np.cross(fb[:, 2], t), n, t @ fb[:, 2]) for t in fa.T[:2]]
        if self.kind in ("prismatic", "fixed"):
            error = 0.5 * sum(np.cross(fa[:, c], fb[:, c]) for c in range(3))
            out += [(None, n, n, n @ error) for n in fa.T]
        return out


class Differential(Joint):
    def __init__(self, bodies, chassis, left, right):
        self.a, self.b, self.third, self.bodies, self.kind = left, right, chassis, bodies, "differential"

    def rows(self):
        return []


def differential_row(joint, count):
    axis, row = joint.bodies[joint.third].turn[:, 1], np.zeros(6 * count)
    for k, factor in ((joint.a, 1), (joint.b, 1), (joint.third, -2)):
        row[6 * k + 3:6 * k + 6] = factor * axis
    pitch = [np.arctan2(-(t := joint.bodies[joint.third].turn.T @ joint.bodies[k].turn)[2, 0], t[0, 0])
             for k in (joint.a, joint.b)]
    return row, sum(pitch)


def assemble(joints, count):
    rows = [(joint, row) for joint in joints for row in joint.rows()]
    tied = [differential_row(joint, count) for joint in joints if joint.kind == "differential"]
    jacobian, error = np.zeros((len(rows) + len(tied), 6 * count)), np.zeros(len(rows) + len(tied))
    for i, (row, phi) in enumerate(tied, len(rows)):
        jacobian[i], error[i] = row, phi
    for i, (joint, (n, ta, tb, phi)) in enumerate(rows):
        error[i] = phi
        for k, sign, torque in ((joint.a, -1, ta), (joint.b, 1, tb)):
            if k is None:
                continue
            if n is not None:
                jacobian[i, 6 * k:6 * k + 3] = sign * n
            jacobian[i, 6 * k + 3:6 * k + 6] = sign * torque
    return jacobian, error


def responses(bodies):
    inverse = np.zeros((6 * len(bodies),) * 2)
    for k, body in enumerate(bodies):
        inverse[6 * k:6 * k + 3, 6 * k:6 * k + 3] = np.eye(3) / body.mass
        inverse[6 * k + 3:6 * k + 6, 6 * k + 3:6 * k + 6] = body.response()
    return inverse


def velocities(bodies):
    return np.concatenate([np.concatenate([b.velocity, b.spin]) for b in bodies])


class Constraint:
    """One dense solve a substep: the velocity after it removes the share beta of the error."""

    def __init__(self, beta):
        self.beta, self.name = beta, f"constraint, beta = {beta:g}"

    def wrenches(self, bodies, joints, outside, dt):
        jacobian, error = assemble(joints, len(bodies))
        inverse = responses(bodies)
        free = np.concatenate([np.concatenate([b.velocity + dt * w[:3] / b.mass, b.half_spin(w[3:], dt)])
                               for b, w in zip(bodies, outside)])
        matrix = jacobian @ inverse @ jacobian.T
        impulse = np.linalg.solve(matrix, -jacobian @ free - self.beta / dt * error)
        return (jacobian.T @ impulse).reshape(-1, 6) / dt


class Bushing:
    """Spring and damper in each row; stiffness as a share of what the substep can integrate."""

    def __init__(self, share, ratio=0.5):
        self.share, self.ratio, self.name, self.stiffness = share, ratio, f"bushings, share {share:g}", None

    def wrenches(self, bodies, joints, outside, dt):
        jacobian, error = assemble(joints, len(bodies))
        if self.stiffness is None:  # Gershgorin's bound of the largest eigenvalue of J W J^T
            bound = np.abs(jacobian @ responses(bodies) @ jacobian.T).sum(axis=1)
            self.stiffness = self.share / (bound * dt**2)
            self.damping = 2 * self.ratio * np.sqrt(self.share) / (bound * dt) * (1 - 0.5 * np.sqrt(self.share))
        rates = jacobian @ velocities(bodies)
        return (jacobian.T @ (-self.stiffness * error - self.damping * rates)).reshape(-1, 6)


def rod(length, mass, centre, tilt=0.0):
    """A slender rod along its own x, tilted about y (down for positive)."""
    thick = 0.05 * length
    return Body(mass, mass / 12 * np.array([2 * thick**2, length**2 + thick**2, length**2 + thick**2]),
                np.array(centre, float), rotation(np.array([0, tilt, 0])))


def double_pendulum():
    bodies = [rod(1, 1, [0.5, 0, 0]), rod(1, 1, [1.5, 0, 0])]
    return bodies, [Joint(bodies, "revolute", None, 0, [0, 0, 0]), Joint(bodies, "revolute", 0, 1, [1, 0, 0])], None


def slider_crank():
    crank, link = 0.2, 0.6
    reach = np.sqrt(link**2 - crank**2)
    bodies = [rod(crank, 1, [0, 0, 0.5 * crank], -np.pi / 2), rod(link, 1, [0.5 * reach, 0, 0.5 * crank],
                                                                 np.arcsin(crank / link)),
              Body(2, np.full(3, 0.01), np.array([reach, 0.0, 0.0]))]
    bodies[0].spin[1] = 10
    bodies[0].velocity[0] = 10 * 0.5 * crank
    bodies[1].velocity[0] = bodies[2].velocity[0] = 10 * crank  # the link only translates here
    return bodies, [Joint(bodies, "revolute", None, 0, [0, 0, 0]), Joint(bodies, "spherical", 0, 1, [0, 0, crank]),
                    Joint(bodies, "spherical", 1, 2, [reach, 0, 0]),
                    Joint(bodies, "prismatic", None, 2, [reach, 0, 0], [1, 0, 0])], None


def four_bar():
    bodies = [rod(0.3, 1, [0, 0, 0.15], -np.pi / 2), rod(0.5, 1, [0.25, 0, 0.3]),
              rod(0.3, 1, [0.5, 0, 0.15], -np.pi / 2)]
    for body in bodies:
        body.velocity[0] = 3 * body.position[2]
    bodies[0].spin[1] = bodies[2].spin[1] = 3
    bodies[1].velocity[0] = 0.9
    return bodies, [Joint(bodies, "revolute", None, 0, [0, 0, 0]), Joint(bodies, "spherical", 0, 1, [0, 0, 0.3]),
                    Joint(bodies, "spherical", 1, 2, [0.5, 0, 0.3]),
                    Joint(bodies, "revolute", None, 2, [0.5, 0, 0])], None


def top():
    """Steady precession: I1 W^2 cos t - I3 w3 W + m g l = 0."""
    mass, lever, i1, i3, tilt, precession = 1.0, 0.1, 2e-3, 1e-3, np.pi / 6, 2.0  # i1 about the centre
    about_pivot = i1 + mass * lever**2
    w3 = (mass * 9.81 * lever + about_pivot * precession**2 * np.cos(tilt)) / (i3 * precession)
    turn = rotation(np.array([0, tilt, 0]))
    axis = turn[:, 2]
    spin = precession * np.array([0, 0, 1.0]) + (w3 - precession * np.cos(tilt)) * axis
    body = Body(mass, np.array([i1, i1, i3]), lever * axis, turn, np.cross(spin, lever * axis), spin)
    bodies = [body]
    return bodies, [Joint(bodies, "spherical", None, 0, [0, 0, 0])], None


def rover():
    """Chassis, two rockers and four braked wheels on a ramp of 20 degrees."""
    slope = np.radians(20)
    bodies = [Body(100, np.array([8.0, 10, 15]), np.array([0.05, 0, 0.6]))]
    for side in (-0.5, 0.5):
        bodies.append(Body(5, np.array([0.05, 0.5, 0.5]), np.array([0.0, side, 0.4])))
    for side in (-0.5, 0.5):
        bodies += [Body(4, np.full(3, 0.05), np.array([x, side, 0.2])) for x in (-0.5, 0.5)]
    joints = [Joint(bodies, "revolute", 0, 1, [0, -0.5, 0.45]), Joint(bodies, "revolute", 0, 2, [0, 0.5, 0.45])]
    joints += [Joint(bodies, "fixed", 1 + w // 2, 3 + w, bodies[3 + w].position) for w in range(4)]
    joints.append(Differential(bodies, 0, 1, 2))
    down = 9.81 * np.array([np.sin(slope), 0, -np.cos(slope)])

    def forces(dt):
        out = []
        for k, body in enumerate(bodies):
            force, torque = body.mass * down, np.zeros(3)
            if k >= 3:
                foot = np.array([0, 0, -0.2])
                start = np.array([(-0.5, 0.5)[(k - 3) % 2], (-0.5, 0.5)[(k - 3) // 2], 0.0])
                speed = body.velocity + np.cross(body.spin, foot)
                push = -2e5 * (body.position + foot - start) - 2e3 * speed
                force, torque = force + push, torque + np.cross(foot, push)
                body.load = push
            out.append(np.concatenate([force, torque]))
        return out

    return bodies, joints, forces


@dataclass
class Result:
    gap: float
    energy: float
    seconds: float
    measure: str


def run(make, solver, dt, duration):
    bodies, joints, forces = make()
    steps, largest = int(round(duration / dt)), 0.0
    energies, taken = [], 0.0
    for step in range(steps):
        outside = forces(dt) if forces else [np.concatenate([b.mass * GRAVITY, np.zeros(3)]) for b in bodies]
        begun = time.perf_counter()
        inside = solver.wrenches(bodies, joints, outside, dt)
        taken += time.perf_counter() - begun
        # the energy of the leapfrog: positions belong to the middle between two velocities
        if step % max(1, steps // 400) == 0:
            largest = max(largest, np.abs(assemble(joints, len(bodies))[1]).max())
            energies.append(middle_energy(bodies, outside, inside, dt))
        for body, w in zip(bodies, np.array(outside) + inside):
            body.move(w[:3], w[3:], dt)
        if not all(np.isfinite(body.position).all() and np.abs(body.position).max() < 1e3 for body in bodies):
            return Result(np.inf, np.inf, taken / (step + 1), "blew up")
    return Result(largest, max(abs(np.array(energies) - energies[0])), taken / steps, measure(make, bodies, duration))


def middle_energy(bodies, outside, inside, dt):
    total = 0
    for body, w in zip(bodies, np.array(outside) + inside):
        mid = body.velocity + 0.5 * dt * w[:3] / body.mass
        spin = body.spin + 0.5 * dt * body.response() @ w[3:]
        total += 0.5 * body.mass * mid @ mid + 0.5 * spin @ (body.world_inertia(body.turn) @ spin)
        total -= body.mass * GRAVITY @ body.position
    return total


def measure(make, bodies, duration):
    if make is top:
        angle = np.unwrap([0, np.arctan2(bodies[0].position[1], bodies[0].position[0])])[1]
        turned = angle + 2 * np.pi * round((2 * duration - angle) / (2 * np.pi))
        return f"precession {turned / duration:.6f} (2)"
    if make is rover:
        loads = [bodies[k].load for k in range(3, 7)]
        return f"rear {loads[0][2] + loads[2][2]:.3f}, front {loads[1][2] + loads[3][2]:.3f} N"
    return ""


def rover_by_hand():
    """Normal loads of both rear and both front wheels: moments about the rear feet."""
    slope, g = np.radians(20), 9.81
    parts = [(100, 0.05, 0.6), (10, 0.0, 0.4), (8, -0.5, 0.2), (8, 0.5, 0.2)]
    weight = sum(m for m, _, _ in parts) * g
    front = sum(m * g * (np.cos(slope) * (x + 0.5) + np.sin(slope) * z) for m, x, z in parts) / 1.0
    return weight * np.cos(slope) - front, front


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--dt", type=float, nargs="+", default=[1e-2, 1e-3, 1e-4])
    parser.add_argument("--duration", type=float, default=2.0)
    parser.add_argument("--cases", nargs="+", default=["double_pendulum", "slider_crank", "four_bar", "top", "rover"])
    options = parser.parse_args()
    print("rover by hand: rear %.3f, front %.3f N" % rover_by_hand())
    print("| case | formulation | substep, s | largest error, m or rad | change of energy, J | us a solve | |")
    print("|---" * 7 + "|")
    for name in options.cases:
        for make_solver in (lambda: Bushing(0.1), lambda: Bushing(0.5), lambda: Constraint(0), lambda: Constraint(0.2),
                            lambda: Constraint(1)):
            for dt in options.dt:
                solver = make_solver()
                with np.errstate(all="ignore"):
                    try:
                        r = run(globals()[name], solver, dt, options.duration)
                    except np.linalg.LinAlgError:
                        r = Result(np.inf, np.inf, 0, "blew up")
                print(f"| {name} | {solver.name} | {dt:g} | {r.gap:.1e} | {r.energy:.1e} | {1e6 * r.seconds:.0f} | "
                      f"{r.measure} |", flush=True)


if __name__ == "__main__":
    main()
