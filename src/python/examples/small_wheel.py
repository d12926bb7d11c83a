"""The scene of the examples as Python objects: a smooth wheel of 10 kg on 8000 points of sand, seconds of wall time a run. Too coarse for
answers that count: docs/accuracy.md."""

import copy

KEYS = {
    "title": "A small wheel on sand",
    "domain": {"size": [0.8, 0.2, 0.4], "gravity": [0.0, 0.0, -9.81], "walls": {"x": "slip", "y": "slip", "bottom": "fixed", "top": "open"}},
    "grid": {"spacing": 0.025},  # m
    "material": [
        {"name": "sand", "model": "mohr-coulomb", "density": 1600.0, "young": 5.0e5, "poisson": 0.3, "friction_angle_deg": 33.0,
         "dilation_angle_deg": 0.0, "cohesion": 100.0},
        {"name": "aluminium", "model": "rigid", "young": 7.0e10, "poisson": 0.33, "family": "wheel"},
    ],
    "contact": [{"between": ["wheel", "sand"], "friction": 0.5}],
    "shape": [{"name": "wheel", "sdf_cells": 40, "node_spacing": 0.01,
               "generate": {"kind": "wheel", "radius": 0.1, "width": 0.1, "wall_thickness": 0.03, "grousers": 0, "grouser_height": 0.0}}],
    "terrain": [{"material": "sand", "region": {"box": [[0.0, 0.0, 0.0], [0.8, 0.2, 0.1]]}}],
    "body": [{"name": "wheel", "shape": "wheel", "material": "aluminium", "mass": 10.0, "position": [0.2, 0.1, "on surface"], "gap": 0.002,
              "lock": ["roll", "yaw"]}],
    "phase": [
        {"name": "settle", "hold": ["wheel"], "damping": 0.3, "until": "equilibrium", "max_duration": 0.1},
        {"name": "lower", "until": "lowered", "max_duration": 2.0, "lower": {"body": "wheel", "speed": 0.1}},
        {"name": "drive", "duration": 1.0},
    ],
    "output": {"every": 0.02},
}


def driven(slip):
    """The scene with a wheel that is driven at a slip."""
    keys = copy.deepcopy(KEYS)
    keys["phase"][-1]["drive"] = {"body": "wheel", "angular_velocity": 2.0, "ramp": 0.1, "slip": slip}
    return keys


def pulling():
    """The scene with a wheel whose axle turns at 2 rad/s and that a rope may hold back."""
    keys = copy.deepcopy(KEYS)
    keys["phase"][-1]["motion"] = [{"body": "wheel", "y": "held", "roll": "held", "yaw": "held", "axle": {"velocity": 2.0, "ramp": 0.1}}]
    keys["phase"][-1]["duration"] = 2.0
    return keys


def means(run, *names, since=0.5):
    """Means of columns of the wheel over the end of a run; `since`: share of the drive."""
    wheel, start = run.wheel("wheel"), run.phases[-1].start
    late = wheel["time"] >= start + since * (wheel["time"][-1] - start)
    return [float(wheel[name][late].mean()) for name in names]
