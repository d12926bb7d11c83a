#!/usr/bin/python3
"""Stands in for tread where a test needs many runs: `check` prints a plan, `run` leaves a plate that goes down with force = K (z / 10 mm)^n, or, where
the scene drives a wheel, answers that are linear in slip. K is young / 1000, n the friction angle over 30 degrees.

    stand_in.py check SCENE.toml; stand_in.py run SCENE.toml --output DIR ...
"""

import json
import os
import sys
import tomllib
from pathlib import Path

import h5py
import numpy as np

ROWS = 201
WORK = ("sand_steps", "searches", "substeps", "joint_substeps", "rows", "points", "yielding_points", "pages", "bodies", "body_substeps", "near_substeps")


def plate_force(young, friction_angle, sinkage):
    return young / 1000.0 * (sinkage / 0.01) ** (friction_angle / 30.0)


def columns_of(time, sinkage, force, pull, torque, slip, spin):
    zero = np.zeros(ROWS)
    return {"time": time, "position": np.stack((0.1 * time, zero, zero), axis=1), "velocity": np.stack((zero + 0.1, zero, zero), axis=1),
            "angular_velocity": np.stack((zero, zero + spin, zero), axis=1), "force": np.stack((pull, zero, force), axis=1),
            "torque": np.stack((zero, -torque, zero), axis=1), "sinkage": sinkage, "slip": slip, "drawbar_pull": pull, "power": torque * spin}


def history(scene):
    time, one = np.linspace(0, 2, ROWS), np.ones(ROWS)
    sand = next(material for material in scene["material"] if "friction_angle_deg" in material)
    driven = [phase["drive"] for phase in scene["phase"] if "drive" in phase]
    noise = 0.01 * np.random.default_rng(3).standard_normal((4, ROWS))
    if not driven:
        sinkage = 0.01 * time
        return columns_of(time, sinkage, plate_force(sand["young"], sand["friction_angle_deg"], sinkage), 0 * one, 0 * one, 0 * one, 0.0)
    slope = np.degrees(np.arctan2(-scene["domain"]["gravity"][0], -scene["domain"]["gravity"][2]))
    slip = driven[-1].get("slip", "free")
    slip = 0.02 * slope if slip == "free" else slip
    friction = next((contact["friction"] for contact in scene["contact"]), 0.5)
    return columns_of(time, 0.005 + 0.01 * slip + 1e-4 * noise[0], 80 + noise[1], 40 * friction * slip - 5 + noise[2], 6 * slip + noise[3],
                      slip + 1e-3 * noise[0], driven[-1]["angular_velocity"])


def write_run(scene_path, folder):
    scene = tomllib.loads(Path(scene_path).read_text(encoding="utf-8"))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text(Path(scene_path).read_text(encoding="utf-8"), encoding="utf-8")
    body = scene["body"][0]["name"]
    units = {"time": "s", "sinkage": "m", "slip": "1"}
    with h5py.File(folder / "timeseries.h5", "w") as file:
        for name, values in history(scene).items():
            file[f"wheel/{body}/{name}"] = values
            file[f"wheel/{body}/{name}"].attrs["units"] = units.get(name, "N")
        file["phases/index"], file["phases/start"] = np.array([float(len(scene["phase"]) - 1)]), np.array([0.0])
    figure = {"resolved": 0.05, "marginal": 0.2, "verdict": "marginal"}
    figures = {name: {"value": value} | figure for name, value in (("pull_error", 0.1), ("torque_error", 0.05), ("sinkage_error", 0.2))}
    summary = {"status": "finished", "resolution": {"verdict": "marginal", "figures": figures}, "points": 1000, "wall_s": 0.5, "version": "0", "commit": "stand-in",
               "threads": 1, "warnings": []}
    (folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")


def main(arguments):
    if arguments[0] == "check":
        print(json.dumps({"points": 10, "bodies": 1, "time": 2.0, "steps": 2e3, "disk": 2500, "memory": 1, "scene": "", "set_up": 0.5,
                          "work": dict.fromkeys(WORK, 0.0)}))
        return 0
    if os.environ.get("STAND_IN_FAILS"):
        return 3
    write_run(arguments[1], Path(arguments[arguments.index("--output") + 1]))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
