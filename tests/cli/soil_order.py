#!/usr/bin/env python3
"""The twin of the shear box comes to Davis's ratio and to the dilation asked for as the spacing goes to zero: docs/soil_tests.md."""

import unittest

from soil_case import SoilCase
from tread_post.closed_forms import FORMS


class SoilOrder(SoilCase):
    def test_shear_box(self):
        coarse = self.misfits("grid.spacing=0.01")
        fine = self.misfits("grid.spacing=0.005")
        for quantity in ("stress_ratio", "dilation"):
            self.expect(f"{quantity}, misfit at half the spacing over that at the whole", fine[quantity] / coarse[quantity], 0.5, 0.1,
                        "first order: the band of shear is as wide as one or two cells")

    def misfits(self, spacing):
        run = self.run_twin("shear_box", spacing)
        form = FORMS[run.scene["reference"]["form"]]
        return {name: form.quantities[name].measure(run) - answer for name, answer in form.answers(run).items()}


if __name__ == "__main__":
    unittest.main()
