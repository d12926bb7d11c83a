#!/usr/bin/python3
"""Constants of made-up soil tests: Bekker's, Janosi's and those of a triaxial test and an oedometer, recovered from curves with noise and from runs."""

import csv
import json
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "postprocess"))

from tread_post.bearing_capacity import Ground, flow_value, n_c, n_gamma, n_q, reduced_tan, round_bounds, strip_bounds  # noqa: E402
from tread_post.soil_curves import Curve  # noqa: E402
from tread_post.soil_fits import FitError, bekker, janosi, line, one_plate  # noqa: E402
from tread_post.soil_forms import place_between, shear_dilation, triaxial_dilation  # noqa: E402

SCRIPT = Path(__file__).resolve().parents[2] / "postprocess" / "soil_test.py"
K_C, K_PHI, EXPONENT = 990.0, 1.528e6, 1.1
WIDTHS = (0.05, 0.075, 0.1)
COHESION, FRICTION, SHEAR_LENGTH = 400.0, math.radians(30), 0.012


def plates(noise, random):
    """(sinkages, pressures) of three plates by Bekker's law, with noise of that share of the largest pressure."""
    sinkages = [np.linspace(0.001, 0.03, 60) for _ in WIDTHS]
    clean = [(K_C / b + K_PHI) * z**EXPONENT for b, z in zip(WIDTHS, sinkages)]
    top = max(part.max() for part in clean)
    return sinkages, [part + noise * top * random.normal(size=len(part)) for part in clean]


def sheared(noise, random, normals=(5e3, 1e4, 2e4)):
    displacements = [np.linspace(0, 0.06, 80) for _ in normals]
    pressures = [np.full(80, normal) for normal in normals]
    clean = [(COHESION + math.tan(FRICTION) * normal) * -np.expm1(-j / SHEAR_LENGTH) for j, normal in zip(displacements, normals)]
    return displacements, pressures, [part + noise * max(normals) * random.normal(size=80) for part in clean]


class SoilTest(unittest.TestCase):
    def check(self, what, measured, expected, tolerance, why):
        print(f"{what}: measured {measured:.6g}, expected {expected:.6g}, tolerance {tolerance:.2g}: {why}")
        self.assertLessEqual(abs(measured - expected), tolerance)


class Fits(SoilTest):
    def test_bekkers_constants_of_clean_curves(self):
        found = bekker(WIDTHS, *plates(0.0, np.random.default_rng(1)))
        for name, right in (("k_c", K_C), ("k_phi", K_PHI), ("n", EXPONENT)):
            self.check(name, found[name].value, right, 1e-4 * right, "the least squares end where their gain is 1e-8")

    def test_janosis_constants_of_clean_curves(self):
        found = janosi(*sheared(0.0, np.random.default_rng(1)))
        for name, right in (("c", COHESION), ("tan_phi", math.tan(FRICTION)), ("K", SHEAR_LENGTH), ("phi", 30.0)):
            self.check(name, found[name].value, right, 1e-4 * right, "the least squares end where their gain is 1e-8")

    def test_intervals_hold_the_constants(self):
        """Noise of 1 %; of 400 repeats 95 % are expected inside, with a standard deviation of 1.1 %."""
        random, inside = np.random.default_rng(7), {}
        right = {"k_c": K_C, "k_phi": K_PHI, "n": EXPONENT, "c": COHESION, "tan_phi": math.tan(FRICTION), "K": SHEAR_LENGTH}
        repeats = 400
        for _ in range(repeats):
            found = bekker(WIDTHS, *plates(0.01, random)) | janosi(*sheared(0.01, random))
            for name, value in right.items():
                inside[name] = inside.get(name, 0) + (found[name].low <= value <= found[name].high)
        for name, count in inside.items():
            self.check(f"share of intervals with {name}", count / repeats, 0.95, 0.035, "three standard deviations of 400 repeats")

    def test_one_plate_has_one_stiffness(self):
        z = np.linspace(0.001, 0.03, 60)
        found = one_plate(z, 2e6 * z**0.9)
        self.check("k", found["k"].value, 2e6, 200, "the least squares end where their gain is 1e-8")
        self.check("n", found["n"].value, 0.9, 1e-4, "likewise")

    def test_one_load_tells_no_cohesion(self):
        found = janosi(*sheared(0.0, np.random.default_rng(1), (1e4,)))
        self.assertNotIn("c", found)
        self.check("tan phi with c in it", found["tan_phi"].value, math.tan(FRICTION) + COHESION / 1e4, 1e-4, "c = 0 is assumed")

    def test_what_tells_nothing_is_refused(self):
        with self.assertRaisesRegex(FitError, "two widths"):
            bekker((0.1, 0.1), *(part[:2] for part in plates(0.0, np.random.default_rng(1))))
        with self.assertRaisesRegex(FitError, "8 at least"):
            one_plate(np.array([0.01, 0.02]), np.array([1.0, 2.0]))
        with self.assertRaisesRegex(FitError, "3 at least"):
            line(np.ones(9), np.ones(9), ("1", "1"))


class ClosedForms(SoilTest):
    def test_factors_of_bearing_capacity(self):
        for angle, surcharge, cohesion, weight in ((20, 6.40, 14.83, 2.84), (30, 18.40, 30.14, 14.75), (40, 64.20, 75.31, 85.6)):
            friction = math.radians(angle)
            self.check(f"N_q at {angle} degrees", n_q(friction), surcharge, 0.005 * surcharge, "printed with three digits")
            self.check(f"N_c at {angle} degrees", n_c(friction), cohesion, 0.005 * cohesion, "printed with three digits")
            self.check(f"N_gamma at {angle} degrees", n_gamma(friction), weight, 0.03 * weight, "the fit's own error, of exact values by Martin (2005)")
        self.check("N_c of clay", n_c(0.0), 2 + math.pi, 1e-12, "Prandtl")

    def test_davis(self):
        phi = math.radians(30)
        self.check("associated flow", reduced_tan(phi, phi), math.tan(phi), 1e-12, "an identity")
        self.check("no dilation", reduced_tan(phi, 0.0), 0.5, 1e-12, "sin phi")
        self.check("ratio of principal stresses", flow_value(phi), 3.0, 1e-12, "tan^2 60 degrees")

    def test_bounds_enclose_and_grow(self):
        ground = Ground(math.radians(30), 0.0, 0.0, 16e3)
        for bounds in (strip_bounds, round_bounds):
            lower, upper = bounds(ground, 0.1, 0.0)
            self.assertLess(lower, upper)
            self.assertGreater(bounds(ground, 0.1, 0.02)[1], upper)
        self.check("half way between 1 and 4", place_between(1.0, 4.0, 2.0), 0.5, 1e-12, "logarithmic")

    def test_dilation_of_made_up_curves(self):
        way = np.linspace(0, 0.01, 100)
        shear = Curve("direct-shear", "upper", {"displacement": way, "rise": way * math.tan(math.radians(12))}, {})
        self.check("shear box", shear_dilation(shear), 12.0, 1e-9, "a straight line")
        strain = Curve("triaxial", "top", {"axial_strain": way, "volume_strain": way * (1 - flow_value(math.radians(12)))}, {})
        self.check("triaxial", triaxial_dilation(strain), 12.0, 1e-9, "a straight line")


SCENE = """
title = "Three plates"
[domain]
size = [1.0, 0.5, 0.4]
gravity = [0.0, 0.0, -9.81]
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
region = { box = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.2]] }
%s
[[phase]]
name = "push"
[reference]
form = "%s"
"""
PLATE = """
[[shape]]
name = "disc_%(number)d"
generate = { kind = "plate", radius = %(radius)g, thickness = 0.02 }
[[body]]
name = "plate_%(number)d"
shape = "disc_%(number)d"
"""


def write_run(path, form="plate-sinkage"):
    path.mkdir()
    text = "".join(PLATE % {"number": number, "radius": radius} for number, radius in enumerate(WIDTHS))
    (path / "scene.toml").write_text(SCENE % (text, form), encoding="utf-8")
    sinkages, pressures = plates(0.005, np.random.default_rng(3))
    with h5py.File(path / "timeseries.h5", "w") as file:
        file["phases/index"], file["phases/start"] = [0], [0.0]
        for number, radius in enumerate(WIDTHS):
            group, rows = file.create_group(f"wheel/plate_{number}"), len(sinkages[number])
            force = np.zeros((rows, 3))
            force[:, 2] = pressures[number] * math.pi * radius**2
            group["time"], group["sinkage"], group["force"] = np.arange(rows) * 0.01, sinkages[number], force


class Command(SoilTest):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name)

    def command(self, *arguments):
        return subprocess.run([sys.executable, SCRIPT, *map(str, arguments)], capture_output=True, text=True, check=False)

    def test_a_run_of_three_plates(self):
        write_run(self.path / "run")
        done = self.command(self.path / "run", "--output", self.path / "report")
        self.assertEqual(done.returncode, 0, done.stderr)
        found = json.loads((self.path / "report" / "soil_test.json").read_text())["constants"]
        for name, right, tolerance in (("k_phi", K_PHI, 0.1), ("n", EXPONENT, 0.02)):
            self.check(name, found[name]["value"], right, tolerance * right, "five standard errors at a noise of 0.5 %")
            self.assertIn(name, done.stdout)
        low, high = found["k_c"]["interval"]
        self.assertLess(low, high)
        with open(self.path / "report" / "soil_test.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["curve"] for row in rows}, {"plate_0", "plate_1", "plate_2"})
        self.assertIn("pressure [Pa]", rows[0])
        self.assertTrue((self.path / "report" / "soil_test.png").read_bytes().startswith(b"\x89PNG"))

    def test_what_is_no_soil_test_is_refused(self):
        write_run(self.path / "run", "weight")
        done = self.command(self.path / "run", "--output", self.path / "report")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('form = "weight" is no soil test', done.stderr)
        write_run(self.path / "cone", "cone-penetration")
        done = self.command(self.path / "cone", "--output", self.path / "report")
        self.assertIn("not a cone", done.stderr)


if __name__ == "__main__":
    unittest.main()
