#!/usr/bin/env python3
"""Twins of the soil tests that take minutes: plates and cone lie between both bounds of bearing capacity, the others at their closed forms, the shear box on
its way there: docs/soil_tests.md."""

import unittest

from soil_case import SoilCase
from tread_post.closed_forms import FORMS


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

    def test_shear_box_converges_to_davis(self):
        coarse = self.misfits(self.run_twin("shear_box"))
        fine = self.misfits(self.run_twin("shear_box", "grid.spacing=0.005"))
        for quantity in ("stress_ratio", "dilation"):
            self.expect(f"{quantity}, misfit at half the spacing over that at the whole", fine[quantity] / coarse[quantity], 0.5, 0.1,
                        "first order: the band of shear is as wide as one or two cells")

    @staticmethod
    def misfits(run):
        form = FORMS[run.scene["reference"]["form"]]
        return {name: form.quantities[name].measure(run) - answer for name, answer in form.answers(run).items()}


if __name__ == "__main__":
    unittest.main()
