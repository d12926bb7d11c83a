"""A run that this script makes up: a wheel is held, falls onto sand and drives with slip 0.3.

    /usr/bin/python3 tests/jobs/made_up_run.py DIR     # leaves it there
"""

import json
import sys
from pathlib import Path

import h5py
import numpy as np

SCENE = """
title = "Wheel at slip 0.3 on sand with rocks"
[domain]
size = [1.0, 0.5, 0.6]
gravity = [0.0, 0.0, -3.72]
[grid]
spacing = 0.02
[[material]]
name = "sand"
friction_angle_deg = 29.0
[[shape]]
name = "drum"
generate = { kind = "wheel", radius = 0.2, width = 0.2 }
[[terrain]]
material = "sand"
points_per_cell = 8
[[rocks]]
shape = "clast"
[[body]]
name = "front wheel"
shape = "drum"
[[phase]]
name = "settle"
[[phase]]
name = "drop"
[[phase]]
name = "drive"
drive = { body = "front wheel", angular_velocity = 0.7, ramp = 0.2, slip = 0.3 }
"""
RADIUS, SURFACE = 0.2, 0.15
STARTS = (0.0, 0.4, 0.9)
RESOLUTION = {"verdict": "under-resolved", "figures": {"contact_cells": {
    "value": 2.0, "resolved": 20.0, "marginal": 6.0, "verdict": "under-resolved"}}}

# The made-up wheel turns at 0.7 rad/s on 0.2 m with slip 0.3, which is 0.098 m/s, for 1.9 s of a ramp of 0.2 s.
SPEED, DRIVEN = 0.098, 2.1
# What the made-up scene lacks for weights and friction; its radius stands in it.
MORE = 'load = 635.0\n[[contact]]\nbetween = ["wheel", "sand"]\nfriction = 0.3\n'


def write_columns(group, columns):
    for name, (values, unit) in columns.items():
        group[name] = values
        group[name].attrs["units"] = unit


def wheel_history(rows):
    """A wheel that is held, falls onto the sand, and drives with slip 0.3."""
    time = np.linspace(0, 3, rows)
    driving = np.clip((time - STARTS[2]) / 0.2, 0, 1)
    fallen = np.where(time < STARTS[1], 0, 1 - np.exp(-np.clip(time - STARTS[1], 0, None) / 0.05))
    zero = np.zeros_like(time)
    spin = 0.7 * driving
    speed = 0.7 * spin * RADIUS
    x = 0.3 + np.concatenate(([0], np.cumsum(speed[1:] * np.diff(time))))
    sinkage = -0.015 + 0.035 * fallen + 0.01 * driving
    z = SURFACE + RADIUS - sinkage
    noise = np.random.default_rng(1).normal(0, 6, (rows, 3))
    with np.errstate(invalid="ignore"):
        slip = np.where(spin > 0, 1 - speed / np.where(spin > 0, spin * RADIUS, 1), np.nan)
    pull = 40 * driving
    return {
        "time": (time, "s"),
        "position": (np.stack((x, zero + 0.25, z), axis=1), "m"),
        "velocity": (np.stack((speed, zero, np.gradient(z, time)), axis=1), "m/s"),
        "angular_velocity": (np.stack((zero, spin, zero), axis=1), "rad/s"),
        "force": (np.stack((pull, zero, 635 * fallen), axis=1) + noise * fallen[:, None], "N"),
        "torque": (np.stack((zero, -45 * driving, zero), axis=1) + noise / 10, "N m"),
        "sinkage": (sinkage, "m"),
        "slip": (slip, "1"),
        "drawbar_pull": (pull, "N"),
        "power": (45 * driving * spin, "W"),
    }


def rank_history(rows):
    """Sand that moves away from a rank, twice repartitioned."""
    time = np.linspace(0, 3, rows)
    return {
        "time": (time, "s"),
        "imbalance": (1.02 + 0.2 * (time % 1.2), "1"),
        "repartitions": (np.floor(time / 1.2), "1"),
        "points_moved": (1000 * time + 20000 * np.floor(time / 1.2), "1"),
    }


def energy_history(rows):
    """Returns work that comes in and is lost to plastic flow, except for a thousandth that is unaccounted."""
    time = np.linspace(0, 3, rows)
    work = 30 * np.clip(time - STARTS[2], 0, None)
    columns = {name: np.zeros(rows) for name in ("kinetic_points", "kinetic_bodies", "contact", "friction", "restitution", "damping",
                                                 "transfer", "coupling", "half_step")}
    columns |= {"time": time, "gravity": 5 - time, "strain": time, "plastic": work, "work_in": work, "total": 5 - 1e-3 * work}
    return {name: (values, "s" if name == "time" else "J") for name, values in columns.items()}


def drum():
    """A cylinder about y with closed ends."""
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    rim = np.stack((RADIUS * np.cos(angle), np.zeros(48), RADIUS * np.sin(angle)), axis=1)
    vertices = np.concatenate((rim - (0, 0.1, 0), rim + (0, 0.1, 0), [(0, -0.1, 0), (0, 0.1, 0)]))
    here, after = np.arange(48), (np.arange(48) + 1) % 48
    left, right = np.full(48, 96), np.full(48, 97)
    triangles = ((here, here + 48, after), (after, here + 48, after + 48), (left, here, after),
                 (right, after + 48, here + 48))
    return vertices, np.concatenate([np.stack(corners, axis=1) for corners in triangles])


def octahedron():
    vertices = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 0.6), (0, 0, -0.6)], float)
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return vertices, np.array(triangles)


def write_points(path, time):
    """A bed with a rut behind the wheel."""
    axes = [np.arange(0.005, size, 0.01) for size in (1.0, 0.5, SURFACE)]
    start = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    behind = np.clip((0.62 - start[:, 0]) / 0.05, 0, 1) * np.clip((start[:, 0] - 0.25) / 0.05, 0, 1)
    under = behind * np.clip((0.13 - np.abs(start[:, 1] - 0.25)) / 0.03, 0, 1) * (start[:, 2] / SURFACE) ** 2
    displacement = under[:, None] * np.array((0.01, 0, -0.03))
    position, count = start + displacement, len(start)
    with h5py.File(path, "w") as file:
        file.attrs["time"] = time
        group = file.create_group("VTKHDF")
        group.attrs["Version"] = [1, 0]
        group.attrs.create("Type", b"UnstructuredGrid", dtype="S16")
        for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"):
            group[name] = np.array([count])
        group["Points"] = position
        group["Offsets"] = np.arange(count + 1)
        group["Connectivity"] = np.arange(count)
        group["Types"] = np.ones(count, np.uint8)
        write_columns(
            group.create_group("PointData"),
            {
                "displacement": (displacement.astype(np.float32), "m"),
                "velocity": (np.zeros((count, 3), np.float32), "m/s"),
                "stress": (np.zeros((count, 6), np.float32), "Pa"),
                "plastic_shear": (under.astype(np.float32), "1"),
                "plastic_rate": ((0.5 * under).astype(np.float32), "1/s"),
                "rank": ((start[:, 0] > 0.5).astype(np.int32), "1"),
            },
        )


def write_bodies(path, time):
    random = np.random.default_rng(2)
    rocks = np.stack((random.uniform(0.03, 0.97, 60), random.uniform(0.03, 0.47, 60), np.full(60, SURFACE)), axis=1)
    turns = random.normal(size=(60, 4))
    turns /= np.linalg.norm(turns, axis=1)[:, None]
    with h5py.File(path, "w") as file:
        file.attrs["time"] = time
        write_columns(
            file,
            {
                "position": (np.concatenate(([(0.62, 0.25, SURFACE + RADIUS - 0.03)], rocks)), "m"),
                "orientation": (np.concatenate(([(1, 0, 0, 0)], turns)), "1"),
                "scale": (np.concatenate(([1.0], random.uniform(0.01, 0.02, 60))), "1"),
                "shape": (np.concatenate(([0], np.ones(60, int))), "1"),
                "velocity": (random.normal(size=(61, 3)), "m/s"),
                "angular_velocity": (random.normal(size=(61, 3)), "rad/s"),
                "material": (np.concatenate(([1], np.full(60, 2, np.int32))).astype(np.int32), "1"),
            },
        )


def make_run(path):
    (path / "snapshots").mkdir(parents=True)
    (path / "scene.toml").write_text(SCENE, encoding="utf-8")
    (path / "summary.json").write_text(json.dumps({"status": "finished", "resolution": RESOLUTION}), encoding="utf-8")
    with h5py.File(path / "timeseries.h5", "w") as file:
        write_columns(file.create_group("wheel/front wheel"), wheel_history(151))
        write_columns(file.create_group("energy"), energy_history(151))
        write_columns(file.create_group("ranks"), rank_history(60))
        write_columns(file.create_group("phases"), {"index": (np.arange(3.0), "1"), "start": (np.array(STARTS), "s")})
    for number, time in ((0, 0.0), (7, 3.0)):
        write_points(path / "snapshots" / f"points_{number:04}.hdf", time)
        write_bodies(path / "snapshots" / f"bodies_{number:04}.h5", time)
    with h5py.File(path / "snapshots" / "shapes.h5", "w") as file:
        for index, (name, (vertices, triangles)) in enumerate((("drum", drum()), ("clast", octahedron()))):
            group = file.create_group(str(index))
            group.attrs["name"] = name
            write_columns(group, {"vertices": (vertices, "m"), "triangles": (triangles, "1")})


def colours_of(path):
    from matplotlib.image import imread

    red, green, blue = np.moveaxis((imread(path)[:, :, :3] * 15).astype(int), 2, 0)
    return np.count_nonzero(np.bincount((256 * red + 16 * green + blue).ravel()))


if __name__ == "__main__":
    make_run(Path(sys.argv[1]))
