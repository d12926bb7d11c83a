#!/usr/bin/env python3
"""The small twins of the paper's scenes run, and what they compute is physics: weights, speeds, signs, conservation."""

import json
import pathlib
import tomllib
import unittest

import h5py
import numpy

from command import CommandTest

PAPER = pathlib.Path(__file__).resolve().parents[2] / "configs" / "paper"
TWINS = PAPER / "reduced"


class Run:
    """What a finished run left behind, as far as these tests ask."""

    def __init__(self, directory, body):
        self.summary = json.loads((directory / "summary.json").read_text())
        with h5py.File(directory / "timeseries.h5", "r") as file:
            self.rows = {name: item[:] for name, item in file["wheel"][body].items()}
            self.momentum = file["balance"]["momentum"][:]

    def last(self, name, span):
        """Rows of the run's last `span` seconds."""
        times = self.rows["time"]
        return self.rows[name][times > times[-1] - span]


class PaperScenes(CommandTest):
    def run_twin(self, name, body="wheel", momentum_error=1e-5):
        scene = TWINS / f"{name}.toml"
        result = self.tread("run", scene, "--output", self.output, "--backend", "cpu", "--quiet")
        self.assertEqual(result.returncode, 0, f"{name}: {result.stdout}{result.stderr}")
        run = Run(self.output, body)
        self.assertEqual(run.summary["status"], "finished", name)
        self.assertEqual(run.summary["errors"]["mass"], 0, name)
        # Single precision rounds an impulse to 1e-7; a few thousand steps of random sign stay far below 1e-5.
        self.expect("momentum error", run.summary["errors"]["momentum"], 0, momentum_error)
        return run

    def expect(self, what, measured, expected, tolerance):
        print(f"{self.id().split('.')[-1]}: {what} {measured:.6g}, expected {expected:.6g} +- {tolerance:.2g}")
        self.assertLessEqual(abs(measured - expected), tolerance, what)

    def expect_within(self, what, measured, low, high):
        print(f"{self.id().split('.')[-1]}: {what} {measured:.6g}, expected {low:.6g} to {high:.6g}")
        self.assertTrue(low <= measured <= high, f"{what} = {measured}")

    def test_every_scene_has_a_twin(self):
        scenes = {path.name for path in PAPER.glob("*.toml")} - {"sdf.toml"}  # of shapes alone, nothing to run
        self.assertEqual(scenes, {path.name for path in TWINS.glob("*.toml")})
        for path in [*PAPER.glob("*.toml"), *TWINS.glob("*.toml")]:
            self.assertIn("title", tomllib.loads(path.read_text()), path)

    # 3.1 ------------------------------------------------------------------------------------------------------------

    def head_on(self, name, slowest):
        run = self.run_twin(name, "ball")
        # Nothing acts from outside (the body is let go after the first row); single precision rounds the 67 kg m/s that change sides to 1e-7 a step.
        self.expect("change of momentum (kg m/s)", numpy.abs(run.momentum[1:] - run.momentum[1]).max(), 0, 1e-3)
        self.expect_within("final speed of the body (m/s)", run.rows["velocity"][-1, 0], -1.0, slowest)
        # Rigid on elastic Hertz gives 10.02 kN; the layer of points and the coarse cells soften or stiffen by a tenth.
        self.expect("peak force (N)", abs(run.rows["force"][:, 0]).max(), 10020, 1500)

    # The elastic sphere keeps 1 to 2 % of the energy as vibration. Here a cell is a fifth of its radius, and at one point
    # a cell the motion that the grid does not carry, which is damped, is that of a few points: speed 0.84.
    def test_head_on_1(self):
        self.head_on("head_on_1", slowest=-0.8)

    def test_head_on_8(self):
        self.head_on("head_on_8", slowest=-0.96)

    def test_head_on_27(self):
        self.head_on("head_on_27", slowest=-0.96)

    # 3.2 ------------------------------------------------------------------------------------------------------------

    def wheel_drop(self, name):
        run = self.run_twin(name)
        weight = 15.66 * 9.8
        time, velocity = run.last("time", 0.3), run.last("velocity", 0.3)[:, 2]
        span = time[-1] - time[0]
        # A row's force is the mean since the row before: times that span it is the impulse, by rows to the last bit but
        # for single precision.
        push = (run.last("force", 0.3)[1:, 2] * numpy.diff(time)).sum() / span
        gained = 15.66 * (velocity[-1] - velocity[0]) / span
        self.expect("force less what moves the wheel (N)", push - gained, weight, 1e-3 * weight)
        # At rest but for the last bobbing and rolling on smooth rocks: under 0.08 g over 0.3 s.
        self.expect("force at rest (N)", push, weight, 0.08 * weight)
        # It fell from 0.1 m and has stopped: far below the 1.4 m/s of the fall.
        self.expect("vertical velocity at rest (m/s)", velocity.mean(), 0, 0.05)
        self.assertGreater(run.rows["force"][:, 2].max(), 2 * weight, "no impact was felt")

    def test_wheel_drop_rock(self):
        self.wheel_drop("wheel_drop_rock")

    def test_wheel_drop_rock_filled(self):
        self.wheel_drop("wheel_drop_rock_filled")

    def test_wheel_drop_sand(self):
        self.wheel_drop("wheel_drop_sand")

    def test_wheel_drop_mixed(self):
        self.wheel_drop("wheel_drop_mixed")

    def test_wheel_drop_substeps(self):
        self.wheel_drop("wheel_drop_substeps")
        summary = json.loads((self.output / "summary.json").read_text())
        self.assertEqual(summary["substeps"], 20 * summary["steps"])

    # 3.3, 4, 5 ------------------------------------------------------------------------------------------------------

    def driven(self, name, weight, omega, radius=0.26, **limits):
        """A wheel free to slip: it goes ahead, no faster than it rolls, and the bed brakes its spin."""
        run = self.run_twin(name, **limits)
        phase = tomllib.loads((TWINS / f"{name}.toml").read_text())["phase"][-1]
        path = run.last("position", phase["duration"])[:, 0]
        rolled = omega * radius * (phase["duration"] - 0.5 * phase["drive"]["ramp"])
        # Rocks a third as large as the wheel may throw it ahead by half of the little way that it rolls here.
        self.expect_within("advance (m)", path[-1] - path[0], 0.02 * rolled, 1.5 * rolled)
        self.expect("spin (rad/s)", run.rows["angular_velocity"][-1, 1], omega, 1e-6 * omega + 1e-7)
        torque, force = run.last("torque", 0.5)[:, 1].mean(), run.last("force", 0.5)[:, 2].mean()
        # Against the spin, and no more than full friction at twice the radius under the weight.
        self.expect_within("torque of the bed (N m)", torque, -2 * 0.5 * weight * radius, -1e-3 * weight * radius)
        return run, force

    def rolling(self, name):
        weight = 170.8 * 9.8
        run, force = self.driven(name, weight, 0.5)
        # The wheel neither falls nor rises by more than it sinks: its mean acceleration over half a second is below
        # 0.1 g, on rocks as on sand.
        self.expect("mean force of the bed (N)", force, weight, 0.1 * weight)
        return run

    def test_rolling_spheres(self):
        self.rolling("rolling_spheres")

    def test_rolling_rocks(self):
        self.rolling("rolling_rocks")

    def test_rolling_sand(self):
        run = self.rolling("rolling_sand")
        # The paper's: close to omega R, which is 0.13 m/s; a wheel sinking 1 cm into coarse cells slips by up to a quarter.
        self.expect_within("speed (m/s)", run.last("velocity", 0.5)[:, 0].mean(), 0.75 * 0.13, 1.02 * 0.13)

    def test_rolling_mixed(self):
        self.rolling("rolling_mixed")

    def test_spirit(self):
        run, _ = self.driven("spirit", 170.8 * 3.72, 0.16)
        self.assertGreater(run.rows["sinkage"][-1], 0, "the wheel did not sink")

    def test_spirit_mer(self):
        run, _ = self.driven("spirit_mer", 115.0, 0.32, radius=0.13)
        # So light a wheel, lowered, rests on the crust: on rocks of 70 mm, at most as high above the sand as one of them; one that is held up in the air is not.
        self.expect_within("sinkage (m)", run.rows["sinkage"][-1], -0.07, 0.13)

    def test_curiosity_rock(self):
        self.driven("curiosity_rock", 170.8 * 3.72, 0.16)

    def test_curiosity_core(self):
        self.driven("curiosity_core", 170.8 * 3.72, 0.16)

    # 3.4 ------------------------------------------------------------------------------------------------------------

    def slip(self, name):
        run = self.run_twin(name)
        # Prescribed: (1 - 0.3) * 0.7 rad/s * 0.26 m, to the rounding of single precision.
        self.expect("v_x (m/s)", run.last("velocity", 0.3)[:, 0].mean(), 0.1274, 1e-6)
        self.expect("slip", numpy.abs(run.last("slip", 0.3) - 0.3).max(), 0, 1e-5)
        weight = 170.8 * 3.72
        # The wheel sinks slowly: its mean vertical acceleration over 0.3 s is below 0.1 g.
        self.expect("mean force of the bed (N)", run.last("force", 0.3)[:, 2].mean(), weight, 0.1 * weight)
        # mu W R is 49.6 N m; grousers add what the sand bears, rocks take some off.
        self.expect_within("torque of the bed (N m)", run.last("torque", 0.3)[:, 1].mean(), -130.0, -15.0)

    def test_slip_sand(self):
        self.slip("slip_sand")

    def test_slip_mixed(self):
        self.slip("slip_mixed")


if __name__ == "__main__":
    unittest.main()
