#!/usr/bin/env python3
"""The twin of the shear box comes to Davis's ratio and to the dilation asked for as the spacing goes to zero: docs/soil_tests.md."""

import unittest

from soil_case import SoilCase

QUANTITIES = ("stress_ratio", "dilation")


class SoilOrder(SoilCase):
    def test_shear_box(self):
        coarse, fine = (self.misfits(f"grid.spacing={spacing}") for spacing in (0.01, 0.005))
        for quantity in QUANTITIES:
            self.expect(f"{quantity}, misfit at half the spacing over that at the whole", fine[quantity] / coarse[quantity], 0.5, 0.1,
                        "first order: the band of shear is as wide as one or two cells")

    def misfits(self, setting):
        run = self.run_twin("shear_box", setting)
        return {quantity: measured - answer for quantity in QUANTITIES for measured, answer in [self.figures(run, quantity)]}


if __name__ == "__main__":
    unittest.main()
