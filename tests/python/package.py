"""What the tests of the Python package share: small scenes, a place to run in, and the package itself, which PYTHONPATH names."""

import os
import pathlib
import sys
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "cli"))

import numpy

import tread
from command import BODY, MPIRUN, SCENE, TREAD, CommandTest

BACKEND = os.environ.get("TREAD_TEST_BACKEND", "cpu")  # as the tests of tests/run

# A ball of 2 kg that no weight pulls, in a domain without walls near it.
BALL = """\
title = "a ball"

[domain]
size    = [4.0, 4.0, 4.0]
gravity = [0.0, 0.0, 0.0]

[time]
dt = 1.0e-3

[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e7
poisson = 0.3

[[shape]]
name     = "ball"
generate = { kind = "sphere" }

[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = 0.2
mass     = 2.0
position = [2.0, 2.0, 2.0]

[[phase]]
name     = "first"
duration = 0.05

[[phase]]
name     = "second"
duration = 0.05

[output]
every = 0.01
"""

# Appended to the first phase or to the end.
FREE_MOTION = '[[phase.motion]]\nbody = "ball"\n'


class PackageTest(CommandTest):
    def run_scene(self, text, name="run", **options):
        return tread.run(tread.Scene.from_text(text), self.directory / name, **{"threads": 1, "backend": BACKEND} | options)


def sand_and_roller():
    """SCENE with a roller that falls into the sand, in two phases."""
    return SCENE.replace('duration = 0.02\n', 'duration = 0.01\n\n[[phase]]\nname = "go"\nduration = 0.01\n') + BODY.replace("0.2, 0.2, 0.3", "0.2, 0.2, 0.165") + "velocity = [0.0, 0.0, -0.5]\n"


def assert_close(test, what, measured, expected, tolerance, why):
    """Prints and compares two numbers or arrays; `tolerance` is absolute."""
    error = float(numpy.max(numpy.abs(numpy.asarray(measured) - numpy.asarray(expected))))
    print(f"{what}: measured {measured}, expected {expected}, error {error:.3g}, tolerance {tolerance:.3g} ({why})")
    test.assertLessEqual(error, tolerance, what)


def keys_of(text):
    return tomllib.loads(text)
