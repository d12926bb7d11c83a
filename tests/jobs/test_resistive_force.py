#!/usr/bin/python3
"""Resistive force theory of a wheel: plates with published and closed-form values, symmetries that the theory must have, and exact scalings."""

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "postprocess"))

from tread_post import resistive_force as rft  # noqa: E402
from tread_post.resistive_force import RimWheel, Sand, forces, generic_traction, planar_traction, predict, slip_for_pull, stress_on  # noqa: E402

SAND = Sand(1605.0, math.tan(math.radians(31.9)), 0.5)
DRUM = RimWheel(0.157, 0.165, 80.0)
GROUSERED = RimWheel(0.157, 0.165, 80.0, 30, 0.01, 0.004)


def unit(*vector):
    vector = np.array([vector], float)
    return vector / np.linalg.norm(vector)


class TheoryTest(unittest.TestCase):
    def check(self, what, measured, expected, tolerance, why):
        print(f"{what}: measured {measured:.6g}, expected {expected:.6g}, tolerance {tolerance:.2g}: {why}")
        self.assertLessEqual(abs(measured - expected), tolerance)


class Plates(TheoryTest):
    def test_the_plane_theory_has_its_published_scale(self):
        """Its generic profile is scaled so that a level plate that goes straight down has 1 N/cm3 (Science 339, 1408, supplement)."""
        horizontal, vertical = planar_traction(0.0, 0.5 * math.pi)
        self.check("level plate, down: vertical [N/cm3]", vertical, 1.0, 5e-4, "coefficients have three digits")
        self.check("level plate, down: horizontal [N/cm3]", horizontal, 0.0, 1e-12, "the plate is symmetric")

    def test_the_coefficient_of_a_published_sand(self):
        """PNAS 2023, verification: 0.12 N/cm3 for a density of 1310 kg/m3 and an internal friction of 0.21."""
        self.check("coefficient [N/cm3]", 1e-6 * Sand(1310.0, 0.21, 0.4).coefficient, 0.12, 0.01, "the published fit of the coefficient misses its own data by so much")

    def test_vector_form_is_the_angle_form(self):
        """The published form in the angles of plate and motion, written out apart: its components along r, theta and z."""
        for beta, psi, gamma in ((0.3, 0.2, 0.7), (1.1, -0.9, -0.2), (-0.6, 1.2, 1.3)):
            x, y, z = math.sin(gamma), math.cos(beta), math.cos(psi) * math.cos(gamma) * math.sin(beta) + math.sin(gamma) * math.cos(beta)
            terms = np.array([1, x, y, z, x**2, y**2, z**2, x * y, y * z, z * x, x**3, y**3, z**3, x * y**2, y * x**2, y * z**2, z * y**2, z * x**2,
                              x * z**2, x * y * z])
            f1, f2, f3 = (float(terms @ numbers) for numbers in (rft._NORMAL, rft._VELOCITY, rft._GRAVITY))
            expected = (f1 * math.sin(beta) * math.cos(psi) + f2 * math.cos(gamma), f1 * math.sin(beta) * math.sin(psi),
                        -f1 * math.cos(beta) - f2 * math.sin(gamma) - f3)
            normal = unit(math.sin(beta) * math.cos(psi), math.sin(beta) * math.sin(psi), -math.cos(beta))
            found = generic_traction(normal, unit(math.cos(gamma), 0.0, -math.sin(gamma)))[0]
            for name, measured, value in zip("r theta z".split(), found, expected):
                self.check(f"beta {beta}, psi {psi}, gamma {gamma}: {name}", measured, value, 1e-12, "rounding")

    def test_a_level_plate_is_pushed_straight_up_in_proportion_to_its_depth(self):
        for depth in (0.01, 0.03):
            stress = stress_on(SAND, np.array([[0.0, 0.0, -depth]]), unit(0, 0, -1), np.array([[0.0, 0.0, -2.0]]))[0]
            expected = SAND.coefficient * depth * -sum(float(numbers.sum()) for numbers in (rft._NORMAL, rft._VELOCITY, rft._GRAVITY))
            self.check(f"level plate at {depth} m: pressure [Pa]", stress[2], expected, 1e-9 * expected, "at the end of all ranges every term is 1")
            self.check("the same: sideways [Pa]", float(np.abs(stress[:2]).max()), 0.0, 1e-9, "nothing leans")

    def test_a_plate_that_comes_out_or_hangs_in_the_air_feels_nothing(self):
        for place, motion in (((0, 0, -0.02), (0, 0, 1)), ((0, 0, 0.02), (0, 0, -1)), ((0, 0, -0.02), (0, 0, 0))):
            self.assertEqual(np.abs(stress_on(SAND, np.array([place], float), unit(0, 0, -1), np.array([motion], float))).max(), 0.0)

    def test_traction_turns_with_plate_and_motion_about_the_vertical(self):
        normal, motion = unit(0.5, 0.3, -0.8), unit(0.6, -0.1, -0.4)
        c, s = math.cos(0.8), math.sin(0.8)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        off = np.abs(generic_traction(normal @ turn.T, motion @ turn.T) - generic_traction(normal, motion) @ turn.T).max()
        self.check("turned by 0.8 rad: difference", off, 0.0, 1e-12, "the sand has no direction but gravity")
        mirror = np.diag([1.0, -1.0, 1.0])
        off = np.abs(generic_traction(normal @ mirror, motion @ mirror) - generic_traction(normal, motion) @ mirror).max()
        self.check("mirrored: difference", off, 0.0, 1e-12, "the sand has no handedness")

    def test_an_upright_plate_that_goes_straight_down_is_not_pushed_sideways(self):
        sideways = generic_traction(unit(1, 0, 0), unit(0, 0, -1))[0, 0]
        self.check("upright plate, down: sideways over a level plate's", sideways, 0.0, 0.01, "both of its faces are alike; the published fit keeps this to 0.005")

    def test_both_sides_of_a_plate_are_one(self):
        normal, motion = unit(0.5, 0.3, -0.8), unit(0.6, -0.1, -0.4)
        self.assertEqual(np.abs(generic_traction(normal, motion) - generic_traction(-normal, motion)).max(), 0.0)

    def test_surface_friction_limits_what_is_tangential(self):
        """A level plate that goes down at 30 degrees: up to the ratio of its own unlimited traction it slides, beyond that it sticks."""
        place, normal, motion = np.array([[0.0, 0.0, -0.02]]), unit(0.0, 0.0, -1.0), unit(math.sqrt(3.0), 0.0, -1.0)
        free = generic_traction(normal, motion)[0]
        sticking = float(np.hypot(*free[:2])) / float(free[2])
        for friction in (0.0, 0.5 * sticking, 0.9 * sticking, 2.0 * sticking):
            stress = stress_on(Sand(1605.0, 0.62, friction), place, normal, motion)[0]
            self.assertGreater(stress[2], 0.0)
            self.check(f"friction {friction:.3f}: tangential over normal", float(np.hypot(*stress[:2]) / stress[2]), min(friction, sticking), 1e-9, "rounding")


class Wheels(TheoryTest):
    def test_the_sinkage_carries_the_weight(self):
        for wheel in (DRUM, GROUSERED):
            for slip in (-0.5, 0.0, 0.3, 0.9):
                found = predict(wheel, SAND, 1.0, 1.0 - slip)
                lift, pull, torque = forces(wheel, SAND, found.sinkage, 1.0 - slip, 1.0 / wheel.outer_radius)
                self.check(f"{wheel.grousers} grousers, slip {slip}: lift [N]", lift, wheel.weight, 1e-4 * wheel.weight, "halving ends at 1e-7 of the radius")
                self.assertEqual((pull, torque), (found.drawbar_pull, found.torque))
                self.assertGreater(torque / wheel.outer_radius - (1.0 - slip) * pull, 0.0, "the sand gains power from a wheel, it gives none")

    def test_more_slip_pulls_more_and_digs(self):
        drives = [predict(DRUM, SAND, 1.0, 1.0 - slip) for slip in (0.0, 0.1, 0.2, 0.3)]
        for before, after in zip(drives, drives[1:]):
            self.assertGreater(after.drawbar_pull, before.drawbar_pull)
            self.assertGreater(after.sinkage, before.sinkage)
        self.assertLess(drives[0].drawbar_pull, 0.0)

    def test_a_locked_wheel_drags(self):
        found = predict(DRUM, SAND, 0.0, 1.0)
        self.assertLess(found.drawbar_pull, 0.0)
        self.assertLess(found.torque, 0.0)

    def test_speed_scales_out(self):
        one, other = predict(DRUM, SAND, 1.0, 0.7), predict(DRUM, SAND, 5.0, 3.5)
        self.check("five times as fast: pull [N]", other.drawbar_pull, one.drawbar_pull, 1e-6, "the theory has no rate")

    def test_granular_scaling(self):
        """J. Slonaker et al., Phys. Rev. E 95, 052901 (2017): lengths times L with loads times L^3 give the same flow; gravity takes loads with it."""
        length, gravity = 3.0, 1.62 / 9.81
        found = predict(GROUSERED, SAND, 1.0, 0.7)
        large = predict(RimWheel(0.471, 0.495, 80.0 * length**3, 30, 0.03, 0.012), SAND, 1.0, 0.7)
        moon = predict(RimWheel(0.157, 0.165, 80.0 * gravity, 30, 0.01, 0.004), Sand(1605.0, SAND.friction, 0.5, 1.62), 1.0, 0.7)
        for name, drive, by in (("three times as large", large, (length, length**3, length**4)), ("on the Moon", moon, (1.0, gravity, gravity))):
            for what, measured, expected, factor in zip(("sinkage", "pull", "torque"), vars(drive).values(), vars(found).values(), by):
                self.check(f"{name}: {what}", measured, factor * expected, 1e-4 * abs(factor * expected), "the sinkage is found to 1e-7 of the radius")

    def test_grousers_of_no_height_are_a_drum(self):
        drum, bare = predict(DRUM, SAND, 1.0, 0.8), predict(RimWheel(0.157, 0.165, 80.0, 30, 1e-9, 0.004), SAND, 1.0, 0.8)
        self.check("pull [N]", bare.drawbar_pull, drum.drawbar_pull, 0.02 * DRUM.weight, "a tip stands for 2.9 elements of the rim")
        grousered = predict(GROUSERED, SAND, 1.0, 0.8)
        self.assertGreater(grousered.drawbar_pull, drum.drawbar_pull)

    def test_elements_are_fine_enough(self):
        usual = predict(DRUM, SAND, 1.0, 0.8).drawbar_pull
        angles, rft.ANGLES = rft.ANGLES, 8 * rft.ANGLES
        rft._mean_elements.cache_clear()
        try:
            fine = predict(DRUM, SAND, 1.0, 0.8).drawbar_pull
        finally:
            rft.ANGLES = angles
            rft._mean_elements.cache_clear()
        self.assertNotEqual(usual, fine)
        self.check("pull [N]", usual, fine, 0.01 * DRUM.weight, "a hundredth of the load is a tenth of what measured drives scatter by")

    def test_too_heavy(self):
        self.assertIsNone(predict(RimWheel(0.157, 0.165, 1e6), SAND, 1.0, 0.7))

    def test_slip_for_a_pull(self):
        self.check("linear pull: slip", slip_for_pull(lambda slip: 10 * slip - 2, 3.0), 0.5, 5e-6, "fourteen halvings of 0.045")
        self.assertEqual(slip_for_pull(lambda slip: 5.0, 3.0), 0.0)
        self.assertTrue(math.isnan(slip_for_pull(lambda slip: slip, 3.0)))
        self.assertTrue(math.isnan(slip_for_pull(lambda slip: None, 3.0)))


if __name__ == "__main__":
    unittest.main()
