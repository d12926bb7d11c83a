#!/usr/bin/env python3
"""The twin of the triaxial test of configs/soil measures what its soil is made of: docs/soil_tests.md."""

import unittest

from soil_case import SoilCase


class SoilTriaxial(SoilCase):
    def test_triaxial(self):
        run = self.run_twin("triaxial")
        self.compare(run, "peak_ratio", 0.02 * 3, "2 %: half a degree of the friction angle")
        self.compare(run, "stress_ratio", 0.02 * 3, "2 %, as the peak: the soil is perfectly plastic")
        self.compare(run, "dilation", 1.0, "a tenth of the angle: strains of plates, which the contacts share in")


if __name__ == "__main__":
    unittest.main()
