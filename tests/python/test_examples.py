#!/usr/bin/env python3
"""The examples of src/python/examples do what their pages say."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "src" / "python" / "examples"))

import calibration
import slip_control
import slip_curve
from package import PackageTest, assert_close


class Examples(PackageTest):
    def test_pull_and_sinkage_grow_with_slip(self):
        rows = slip_curve.curve(self.directory, [-0.2, 0.1, 0.4])
        pulls = [pull for _, pull, _ in rows]
        print(f"pulls {pulls} N at slips -0.2, 0.1 and 0.4: a braked wheel is pulled, a driven one pulls more at more slip")
        self.assertEqual(pulls, sorted(pulls))
        self.assertLess(pulls[0], 0)
        slip_curve.draw(rows, self.directory / "curve.png")
        self.assertGreater((self.directory / "curve.png").stat().st_size, 1000)

    def test_the_controller_keeps_slip(self):
        slip, pull = slip_control.controlled(self.directory / "run")
        assert_close(self, "mean slip", slip, 0.2, 0.02, "a tenth of the goal: rows hold slips of single moments")
        self.assertGreater(pull, 0)

    def test_the_calibration_finds_the_angle(self):
        found, low, high = calibration.calibrate(self.directory)
        assert_close(self, "friction angle in degrees", found, calibration.TRUE_ANGLE, 0.5, "the quadratic of the last rounds spans a degree or two")
        self.assertTrue(low <= calibration.TRUE_ANGLE <= high, (low, high))


if __name__ == "__main__":
    unittest.main()
