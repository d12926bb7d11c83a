#!/usr/bin/env python3
"""Twins of the soil tests that take minutes: plates and cone lie between both bounds of bearing capacity, the others at their closed forms:
docs/soil_tests.md."""

import unittest

from soil_case import SoilCase


class SoilBounds(SoilCase):
    def test_plates(self):
        self.compare(self.run_twin("plate"), "capacity", 0.5, "between the bounds: 0 is the lower one, 1 the upper one")

    def test_cone(self):
        self.compare(self.run_twin("cone"), "capacity", 0.5, "between the bounds")

    def test_repose(self):
        self.compare(self.run_twin("repose"), "angle", 3.0, "a tenth of the angle: the sand comes to rest from a flow, on cells of a fifteenth of its height")

    def test_collapse(self):
        self.compare(self.run_twin("collapse"), "run_out", 0.15 * 1.2, "the two laboratories are 15 % apart")

    def test_ring_shear(self):
        self.compare(self.run_twin("ring_shear"), "stress_ratio", 0.15 * 0.5, "the soil beside and under the ring takes a share")


if __name__ == "__main__":
    unittest.main()
