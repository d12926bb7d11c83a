"""A rigid sphere against an elastic one of points: what a run of it did, and what Hertz's law says."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class History:
    """History of a run, or of Hertz's law. Energies in J, without those that the law lacks."""

    label: str
    time: np.ndarray  # s
    body_velocity: np.ndarray  # m/s
    points_velocity: np.ndarray  # m/s, of the centre of mass
    force: np.ndarray  # N
    body_kinetic: np.ndarray
    points_kinetic: np.ndarray
    elastic: np.ndarray  # strain and contact

    @property
    def kinetic(self):
        return self.body_kinetic + self.points_kinetic

    @property
    def total(self):
        return self.kinetic + self.elastic


def body_of(scene):
    body = scene["body"][0]
    return body, body["density"] * np.pi / 6 * body["diameter"] ** 3


def history_of(run):
    """Returns the history of a run with one such pair, as in configs/paper/head_on_8.toml."""
    scene, energy = run.scene, run.energy
    body, body_mass = body_of(scene)
    ball = run.wheel(body["name"])
    points_mass = run.summary["terrain"][0]["mass"]
    velocity = np.concatenate((body["velocity"][:1], ball["velocity"][1:, 0]))  # it is not released in the first row
    points = (run.balance["momentum"][:, 0] - body_mass * ball["velocity"][:, 0]) / points_mass
    force = -ball["force"][:, 0]  # a mean over the time since the row before
    return History(f"{scene['terrain'][0]['points_per_cell']} a cell", ball["time"], velocity, points, force,
                   0.5 * body_mass * velocity**2,
                   energy["kinetic_points"] + energy["half_step"], energy["strain"] + energy["contact"])


def hertz(scene, elastic_spheres, time):
    """Two spheres of which one or both are elastic, as points with Hertz's force between them: m* d'' = -k d^1.5."""
    material, body = scene["material"][0], body_of(scene)
    radius, ball = scene["terrain"][0]["region"]["sphere"], body[0]
    mass = body[1], material["density"] * 4 / 3 * np.pi * radius["radius"] ** 3
    reduced = mass[0] * mass[1] / (mass[0] + mass[1])
    young = material["young"] / (1 - material["poisson"] ** 2) / elastic_spheres
    stiffness = 4 / 3 * young * np.sqrt(1 / (2 / ball["diameter"] + 1 / radius["radius"]))
    start = ball["velocity"][0], scene["terrain"][0]["velocity"][0]
    gap = radius["centre"][0] - ball["position"][0] - 0.5 * ball["diameter"] - radius["radius"]
    overlap, speed = approach(reduced, stiffness, gap, start[0] - start[1], time)
    centre = (mass[0] * start[0] + mass[1] * start[1]) / sum(mass)
    velocity = centre + speed * reduced / mass[0], centre - speed * reduced / mass[1]
    label = "Hertz, rigid and elastic" if elastic_spheres == 1 else "Hertz, both elastic"
    return History(label, time, *velocity, stiffness * overlap**1.5, 0.5 * mass[0] * velocity[0] ** 2,
                   0.5 * mass[1] * velocity[1] ** 2, 0.4 * stiffness * overlap**2.5)


def approach(mass, stiffness, gap, closing, time, steps=40000):
    """Overlap (m) and closing speed (m/s) at `time`: velocity Verlet in steps that are small against any contact."""
    dt = time[-1] / steps
    place, speed = -gap, closing
    overlaps, speeds = np.zeros(steps + 1), np.zeros(steps + 1)
    speeds[0] = closing
    force = 0.0
    for step in range(1, steps + 1):
        half = speed - 0.5 * dt * force / mass
        place += dt * half
        force = stiffness * max(place, 0.0) ** 1.5
        speed = half - 0.5 * dt * force / mass
        overlaps[step], speeds[step] = max(place, 0.0), speed
    at = np.linspace(0, time[-1], steps + 1)
    return np.interp(time, at, overlaps), np.interp(time, at, speeds)
