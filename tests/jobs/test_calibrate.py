#!/usr/bin/python3
"""`tread calibrate`: made-up curves give back their constants, what is refused, and a whole calibration with a program that stands in for tread."""

import json
import os
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "jobs"), str(ROOT / "postprocess")]

from made_up_run import make_run  # noqa: E402
from stand_in import plate_force  # noqa: E402
from tread_jobs.calibration_plan import read_parameter  # noqa: E402
from tread_jobs.errors import CampaignError  # noqa: E402
from tread_jobs.fit import FitError, Parameter, Problem, fitted, posterior, round_places  # noqa: E402
from tread_jobs.run_answers import read_curves  # noqa: E402
from tread_post import Run, RunError  # noqa: E402
from tread_post.run_curves import run_curve  # noqa: E402

PARAMETERS = (Parameter("material.sand.young", 1e5, 1e7, "log"), Parameter("material.sand.friction_angle_deg", 20.0, 45.0))
TRUE = (2.3e6, 33.0)
PLACES = np.linspace(0.002, 0.018, 15)
NOISE = 0.02  # of the largest force
STAND_IN = ROOT / "tests" / "jobs" / "stand_in.py"
SCENE = """
title = "Plate"
[domain]
size = [1.0, 1.0, 1.0]
gravity = [0.0, 0.0, -9.81]
[[material]]
name = "sand"
model = "mohr-coulomb"
young = 1e6
friction_angle_deg = 30.0
[[body]]
name = "plate"
[[phase]]
name = "lower"
"""


def plate_values(unknowns):
    young, angle = (parameter.value(unknowns[:, [i]]) for i, parameter in enumerate(PARAMETERS))
    return plate_force(young, angle, PLACES[None])


def plate_problem(seed, with_deviations):
    """A plate of the stand-in with normal noise of a known size, and its true curve."""
    true = plate_force(*TRUE, PLACES)
    noise = NOISE * true.max()
    measured = true + noise * np.random.default_rng(seed).standard_normal(len(PLACES))
    return Problem(PARAMETERS, measured, np.full(len(PLACES), noise if with_deviations else np.nan), lambda number, unknowns: plate_values(unknowns))


def covered(fit):
    """Which of the true constants lie in the 95 % intervals."""
    low, high = fit.interval()
    return [parameter.value(low[i]) <= TRUE[i] <= parameter.value(high[i]) for i, parameter in enumerate(PARAMETERS)]


class Recovery(unittest.TestCase):
    def test_a_curve_without_noise_gives_its_constants(self):
        problem = plate_problem(0, False)
        exact = Problem(PARAMETERS, plate_force(*TRUE, PLACES), problem.deviation, problem.evaluate)
        fit = fitted(exact)
        for parameter, unknown, true in zip(PARAMETERS, fit.unknowns, TRUE):
            # The last region is 3 % of the bounds to each side, 0.14 in the logarithm of the force: a quadratic leaves 0.14^3 / 6 = 5e-4 at its edge.
            print(f"{parameter.key}: measured {parameter.value(unknown):.8g}, expected {true:.8g}, tolerance 5e-4 relative; {fit.rounds} rounds")
            self.assertLess(abs(parameter.value(unknown) / true - 1), 5e-4)

    def test_intervals_hold_the_constants_of_40_noisy_curves(self):
        fits = [fitted(plate_problem(seed, False)) for seed in range(40)]
        self.assertTrue(all(fit.settled for fit in fits))
        inside = np.array([covered(fit) for fit in fits]).sum(axis=0)
        # Of exact intervals 38 are expected, and fewer than 34 have a chance of 0.3 %.
        print(f"inside the 95 % intervals: measured {inside.tolist()} of 40, expected 38, tolerance 4 fewer")
        self.assertTrue((inside >= 34).all())

    def test_intervals_are_neither_too_narrow_nor_too_wide(self):
        inside = np.array([covered(fitted(plate_problem(seed, True))) for seed in range(1000, 1400)]).mean(axis=0)
        # Of 400 draws with a chance of 0.95 the share is within 0.033 (three standard deviations) of it.
        print(f"inside the 95 % intervals of 400 curves: measured {inside.tolist()}, expected 0.95, tolerance 0.033: three standard deviations")
        self.assertTrue((np.abs(inside - 0.95) <= 0.033).all())

    def test_scatter_is_that_of_the_noise(self):
        fits = [fitted(plate_problem(seed, True)) for seed in range(40)]
        mean = float(np.mean([fit.scatter**2 for fit in fits]))
        # Chi-square over its degrees of freedom: 1, with a standard deviation of sqrt(2 / (13 x 40)) = 0.062.
        print(f"mean square of weighted residuals: measured {mean:.3f}, expected 1, tolerance 0.19: three standard deviations")
        self.assertLess(abs(mean - 1), 0.19)

    def test_samples_have_the_spread_of_the_fit(self):
        problem = plate_problem(5, True)
        fit = fitted(problem)
        samples = posterior(problem, fit, 400)
        self.assertTrue(((samples >= 0) & (samples <= 1)).all())
        for i, parameter in enumerate(PARAMETERS):
            # The walk's neighbours are related: 400 samples count as 100 at least, whose standard deviation is known to 7 %; three of that.
            ratio = float(samples[:, i].std() / fit.errors[i])
            print(f"{parameter.key}: spread of samples over standard error: measured {ratio:.3f}, expected 1, tolerance 0.25")
            self.assertLess(abs(ratio - 1), 0.25)
        np.testing.assert_array_equal(samples, posterior(problem, fit, 400))

    def test_a_constant_outside_its_bounds_is_said(self):
        outside = Problem(PARAMETERS, plate_force(5e7, 33.0, PLACES), np.full(len(PLACES), np.nan), lambda number, unknowns: plate_values(unknowns))
        self.assertTrue(fitted(outside).at_bound[0])

    def test_what_the_data_do_not_determine_is_refused(self):
        """A product of two constants is one constant."""
        both = (Parameter("a", 1.0, 2.0), Parameter("b", 1.0, 2.0))
        problem = Problem(both, np.full(8, 2.25), np.full(8, np.nan), lambda number, u: np.repeat(u[:, :1] + u[:, 1:], 8, axis=1))
        with self.assertRaisesRegex(FitError, "apart"):
            fitted(problem)
        with self.assertRaisesRegex(FitError, "2 measured values for 2 parameters"):
            fitted(Problem(both, np.ones(2), np.full(2, np.nan), problem.evaluate))

    def test_runs_that_fail_cost_themselves_alone(self):
        problem = plate_problem(3, True)

        def one_fails(number, unknowns):
            values = plate_values(unknowns)
            values[1] = np.nan
            return values

        with_failures, whole = fitted(Problem(PARAMETERS, problem.measured, problem.deviation, one_fails)), fitted(problem)
        self.assertTrue((np.abs(with_failures.unknowns - whole.unknowns) < whole.errors).all())
        with self.assertRaisesRegex(FitError, "runs with answers"):
            fitted(Problem(PARAMETERS, problem.measured, problem.deviation, lambda number, unknowns: np.full((len(unknowns), len(PLACES)), np.nan)))

    def test_rounds_are_made_again_to_the_bit_and_stay_in_bounds(self):
        for count in (1, 2, 4):
            places = round_places(np.full(count, 0.9), 0.5, 2)
            np.testing.assert_array_equal(places, round_places(np.full(count, 0.9), 0.5, 2))
            self.assertTrue(((places >= 0) & (places <= 1)).all())
            self.assertGreaterEqual(len(places), (count + 1) * (count + 2) // 2)


class Input(unittest.TestCase):
    def test_parameters(self):
        scene = tomllib.loads(SCENE)
        self.assertEqual(read_parameter("material.sand.young=1e5..1e7:log", scene), PARAMETERS[0])
        for text, says in (("material.sand.young", "KEY=LOW..HIGH"), ("material.sand.young=1..x", "numbers"), ("material.sand.young=2..1", "under"),
                           ("material.sand.young=0..1:log", "over 0"), ("material.sand.model=1..2", "no number"), ("nothing[7].x=1..2", "nothing")):
            with self.assertRaisesRegex(CampaignError, says):
                read_parameter(text, scene)

    def test_measured_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "plate.csv"
            for text, says in (("a,b\n1,2\n", "name \\[unit\\]"), ("sinkage [mm],force [N]\n1,2\n", "given in m"), ("sinkage [m],force [N]\n1,x\n", "line 2, column force"),
                               ("sinkage [m],force [N]\n1\n", "line 2: 1 cells"), ("sinkage [m],colour [1]\n1,2\n", "accepted: two of"),
                               ("sinkage [m],force [N]\n1,\n", "empty cell"), ("sinkage [m],force [N],force_spread [N]\n1,2,0\n", "over 0"), ("", "at least one row")):
                path.write_text(text, encoding="utf-8")
                with self.assertRaisesRegex(CampaignError, f"plate.csv.*{says}"):
                    read_curves([path])

    def test_curves_of_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            make_run(Path(folder) / "run")
            run = Run(Path(folder) / "run")
            # From the made-up run: 40 N at full speed, 0.2 s after the drive began; time counts from there.
            self.assertAlmostEqual(run_curve(run, "time", "drawbar_pull", np.array([0.1, 1.0]), "drive")[0], 20.0, delta=1.0)
            self.assertAlmostEqual(run_curve(run, "time", "drawbar_pull", np.array([0.1, 1.0]))[1], 40.0, delta=1e-6)
            self.assertAlmostEqual(run_curve(run, "time", "torque", np.array([0.5, 1.0]))[1], 45.0, delta=2.4)  # four standard deviations of its noise
            with self.assertRaisesRegex(RunError, "time covers"):
                run_curve(run, "time", "force", np.array([99.0]))
            with self.assertRaisesRegex(RunError, "phase 'x' never began"):
                run_curve(run, "time", "force", np.array([1.0]), "x")


class WholeCalibration(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tread-calibrate-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "plate.toml").write_text(SCENE, encoding="utf-8")
        true = plate_force(*TRUE, PLACES)
        noisy = true + NOISE * true.max() * np.random.default_rng(7).standard_normal(len(PLACES))
        rows = "".join(f"{z:.6f},{f:.4f}\n" for z, f in zip(PLACES, noisy))
        (self.folder / "plate.csv").write_text("# made up\nsinkage [m],force [N]\n" + rows, encoding="utf-8")
        self.output = self.folder / "out"

    def calibrate(self, *more, code=0, **environment):
        command = [sys.executable, str(ROOT / "jobs" / "calibrate.py"), str(self.folder / "plate.toml"), "--measured", str(self.folder / "plate.csv"),
                   "--fit", "material.sand.young=1e5..1e7:log", "--fit", "material.sand.friction_angle_deg=20..45", "--output", str(self.output),
                   "--tread", str(STAND_IN), "--threads", "1", "--jobs", "2", *more]
        done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False, env={**os.environ, **environment})
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def test_from_runs_to_samples_and_again(self):
        first = self.calibrate("--samples", "5")
        report = json.loads((self.output / "calibration.json").read_text(encoding="utf-8"))
        for parameter, true in zip(report["parameters"], TRUE):
            print(f"{parameter['key']}: {parameter['value']:.5g}, interval {parameter['low']:.5g} to {parameter['high']:.5g}, expected {true:.5g}")
            self.assertTrue(parameter["low"] <= true <= parameter["high"])
        self.assertTrue(report["settled"])
        self.assertTrue((self.output / "calibration.png").is_file())
        samples = tomllib.loads((self.output / "samples.toml").read_text(encoding="utf-8"))
        self.assertEqual(samples["axis"][0]["keys"], ["material.sand.young", "material.sand.friction_angle_deg"])
        self.assertLessEqual(len(samples["axis"][0]["values"]), 5)
        # Again: nothing is run, and the same stands there.
        begun = {path: path.read_text() for path in self.output.rglob("attempts.log")}
        again = self.calibrate("--samples", "5")
        self.assertEqual({path: path.read_text() for path in self.output.rglob("attempts.log")}, begun)
        self.assertEqual(first.stdout.splitlines()[-6:], again.stdout.splitlines()[-6:])
        self.calibrate("--fit", "material.sand.young=1e5..1e7", code=2)

    def test_a_dry_run_writes_nothing(self):
        self.assertIn("round 0: 9 runs", self.calibrate("--dry-run").stdout)
        self.assertFalse(self.output.exists())

    def test_what_is_wrong_is_said_before_anything_is_written(self):
        for more, says in ((("--fit", "material.sand.model=1..2"), "no number"), (("--measured", str(self.folder / "none.csv")), "none.csv"),
                           (("--set", "material.sand.young=1"), "clash"), (("--set", "x"), "KEY=VALUE")):
            done = self.calibrate(*more, code=2)
            self.assertIn(says, done.stderr)
            self.assertFalse(self.output.exists())

    def test_runs_that_all_fail_stop_it_with_a_diagnosis(self):
        done = self.calibrate(code=3, STAND_IN_FAILS="1")
        self.assertIn("runs with answers", done.stderr)


if __name__ == "__main__":
    unittest.main()
