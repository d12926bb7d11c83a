#!/usr/bin/env python3
"""Callbacks that steer: what a body or a motor is set to is what it does, until the phase ends, and what cannot be is refused."""

import unittest

import numpy

import tread
from package import BALL, PackageTest, assert_close, sand_and_roller

# The ball's motion in both phases leaves all its axes free.
FREE = BALL.replace("duration = 0.05\n", 'duration = 0.05\n[[phase.motion]]\nbody = "ball"\n')
LED = BALL.replace("duration = 0.05\n", 'duration = 0.05\n[[phase.motion]]\nbody = "ball"\nx = { velocity = 0.1 }\naxle = { velocity = 1.0 }\n')
HINGE = """
[[joint]]
name    = "hinge"
type    = "revolute"
between = ["world", "ball"]
at      = [2.0, 2.0, 2.0]
axis    = [0, 1, 0]
motor   = { speed = 0.0, max_torque = 100.0 }
"""
ROUNDING = "rounding of a hundred steps"


class Steering(PackageTest):
    def end_of(self, text, steer, name="run", **options):
        """State of the ball at the end of each phase, of a run in which `steer` is called at the start of the first."""
        ends = {}

        def visit(state):
            if state.time == 0:
                steer(state)
            ends[state.phase if not state.over else "end"] = state.body("ball")

        self.run_scene(text, name, on_span=visit, **options)
        return ends

    def refused(self, text, steer, name="refused"):
        with self.assertRaises(tread.SceneError) as caught:
            self.run_scene(text, name, on_span=steer, existing="overwrite")
        return str(caught.exception)

    def test_speeds_without_a_motion(self):
        ends = self.end_of(BALL, lambda state: state.steer("ball", spin=3.0, forward=0.4))
        assert_close(self, "angular velocity in rad/s", ends["second"].angular_velocity, [0, 3, 0], 1e-12, ROUNDING)
        assert_close(self, "velocity in m/s", ends["second"].velocity, [0.4, 0, 0], 1e-12, ROUNDING)
        assert_close(self, "way in the first phase in m", ends["second"].position[0] - 2, 0.4 * 0.05, 1e-12, ROUNDING)
        assert_close(self, "slip", ends["second"].slip, 1 - 0.4 / (3.0 * 0.1), 1e-6, "the radius of a mesh of the sphere")

    def test_speeds_of_a_motion(self):
        ends = self.end_of(LED, lambda state: state.steer("ball", spin=3.0, forward=0.4))
        assert_close(self, "spin in rad/s", ends["second"].spin, 3.0, 1e-12, ROUNDING)
        assert_close(self, "way in the first phase in m", ends["second"].position[0] - 2, 0.4 * 0.05, 1e-12, ROUNDING)
        assert_close(self, "way in the second, as the scene says", ends["end"].position[0] - ends["second"].position[0], 0.1 * 0.05, 1e-12, ROUNDING)

    def test_forces_accelerate(self):
        force, mass, dt, duration = numpy.array([3.0, -2.0, 1.0]), 2.0, 1e-3, 0.05
        ends = self.end_of(FREE, lambda state: state.steer("ball", force=force))
        assert_close(self, "velocity in m/s, F t / m", ends["second"].velocity, force * duration / mass, 1e-12, ROUNDING)
        # Symplectic Euler: x_n = a dt^2 n (n + 1) / 2.
        assert_close(self, "way in m", ends["second"].position - 2, force / mass * dt**2 * 50 * 51 / 2, 1e-12, ROUNDING)
        assert_close(self, "velocity after the phase in m/s", ends["end"].velocity, ends["second"].velocity, 1e-12, "no force acts any more")

    def test_torques_accelerate(self):
        inertia = 0.4 * 2.0 * 0.1**2
        about_axle = self.end_of(FREE, lambda state: state.steer("ball", axle_torque=0.02), "axle")
        about_y = self.end_of(FREE, lambda state: state.steer("ball", torque=(0.0, 0.02, 0.0)), "y")
        expected = 0.02 * 0.05 / inertia
        assert_close(self, "spin in rad/s, T t / (2/5 m r^2)", about_axle["second"].spin, expected, 0.01 * expected, "a mesh of the sphere has 1 % less")
        assert_close(self, "spin by a torque about y", about_y["second"].spin, about_axle["second"].spin, 1e-12, ROUNDING)

    def test_forces_act_besides_those_of_the_motion(self):
        text = FREE.replace('body = "ball"\n', 'body = "ball"\nx = { velocity = 0.1 }\n', 1)
        ends = self.end_of(text, lambda state: state.steer("ball", force=(50.0, 2.0, 0.0)))
        assert_close(self, "velocity in m/s", ends["second"].velocity, [0.1, 0.05, 0], 1e-12, "x is led, whatever pushes")

    def test_a_motor_turns(self):
        ends = self.end_of(BALL + HINGE, lambda state: state.motor("hinge", 2.0))
        assert_close(self, "spin in rad/s", ends["second"].spin, 2.0, 1e-4, "a motor may miss a millionth of its speed; rows of a joint are solved to rounding")
        assert_close(self, "spin after the phase in rad/s", ends["end"].spin, 0.0, 1e-4, "the motor has the scene's speed again")
        weak = self.end_of(BALL + HINGE, lambda state: state.motor("hinge", 2.0, max_torque=0.02), "weak")
        expected = 0.02 * 0.05 / (0.4 * 2.0 * 0.1**2)
        assert_close(self, "spin by a largest torque in rad/s", weak["second"].spin, expected, 0.01 * expected, "a mesh of the sphere has 1 % less inertia")

    def test_a_joint_is_seen(self):
        seen = []
        self.run_scene(BALL + HINGE, on_span=lambda state: (state.motor("hinge", 2.0), seen.append(state.joint("hinge"))) if state.phase == "first" else seen.append(state.joint("hinge")))
        assert_close(self, "coordinate in rad", seen[1].coordinate, 2.0 * 0.05, 3e-3, "as of the start of the last substep, 1 ms")

    def test_the_steered_wheel_pulls(self):
        pulls = {}
        for name, spin in (("slow", 1.0), ("fast", 20.0)):
            drive = sand_and_roller().replace("velocity = [0.0, 0.0, -0.5]\n", "").replace('name = "go"\nduration = 0.01\n', 'name = "go"\nduration = 0.05\n')
            run = self.run_scene(drive, name, on_span=lambda state: None if state.over else state.steer("roller", spin=spin, forward=0.06))
            pulls[name] = run.wheel("roller")["drawbar_pull"][-5:].mean()
            self.assertIn("the calling program steers", (run.path / "log.txt").read_text())
        print(f"pull at slip 0: {pulls['slow']:.3g} N, at slip 0.95: {pulls['fast']:.3g} N; the second is larger, as sand carries more shear there")
        self.assertGreater(pulls["fast"], pulls["slow"])

    def test_what_cannot_be_steered_is_refused(self):
        self.assertIn("forces and torques need a [[phase.motion]]", self.refused(BALL, lambda state: state.steer("ball", force=(1, 0, 0))))
        self.assertIn("a spin needs axle", self.refused(FREE, lambda state: state.steer("ball", spin=1.0)))
        self.assertIn("a forward speed needs x", self.refused(FREE, lambda state: state.steer("ball", forward=1.0)))
        self.assertIn("a torque about its axle needs", self.refused(LED, lambda state: state.steer("ball", axle_torque=1.0)))
        held = BALL.replace("duration = 0.05\n", 'duration = 0.05\nhold = ["ball"]\n')
        self.assertIn("holds or lowers it", self.refused(held, lambda state: state.steer("ball", spin=1.0)))
        self.assertIn("accepted: a finite number", self.refused(BALL, lambda state: state.steer("ball", spin=float("inf"))))
        self.assertIn("did you mean", self.refused(BALL, lambda state: state.steer("bal", spin=1.0)))
        self.assertIn("has no motor", self.refused(BALL + HINGE.replace("motor ", "# "), lambda state: state.motor("hinge", 1.0)))
        self.assertIn("0 at least", self.refused(BALL + HINGE, lambda state: state.motor("hinge", 1.0, max_torque=-1.0)))
        self.assertIn("the run is over", self.refused(BALL, lambda state: state.steer("ball", spin=1.0) if state.over else None))

    def test_a_controller_goes_on_after_a_restart(self):
        def control(state):
            if not state.over:
                state.steer("ball", force=(1.0 - state.time * 10, 0, 0))

        def stop(state):
            control(state)
            if state.steps == 30:
                state.stop("half way")

        whole = self.run_scene(FREE, "whole", on_span=control, span_steps=10)
        self.run_scene(FREE, on_span=stop, span_steps=10)
        after = self.run_scene(FREE, restart="auto", on_span=control, span_steps=10)
        for name in ("position", "velocity"):
            numpy.testing.assert_array_equal(after.wheel("ball")[name], whole.wheel("ball")[name])


if __name__ == "__main__":
    unittest.main()
