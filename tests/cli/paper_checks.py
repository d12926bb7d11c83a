#!/usr/bin/env python3
"""Every full-size scene of the paper passes `tread check`, with the counts that its comments promise."""

import pathlib
import re
import unittest

from command import CommandTest

PAPER = pathlib.Path(__file__).resolve().parents[2] / "configs" / "paper"

# Points: the paper's own count or the lattice's, less the volume of the rocks that stand in the sand; rocks by the scene.
POINTS = {"head_on_1": 33552, "head_on_8": 268096, "head_on_27": 904960, "wheel_drop_sand": 1150000,
          "rolling_sand": 101250, "slip_sand": 864000, "spirit": 707520, "spirit_mer": 707520,
          "wheel_drop_mixed": 1150000 - 4189, "wheel_drop_substeps": 1150000 - 4189, "rolling_mixed": 101250 - 1104,
          "slip_mixed": 864000 - 15200, "curiosity_rock": 589824 - 6291}
ROCKS = {"wheel_drop_rock": 300000, "wheel_drop_rock_filled": 300000, "wheel_drop_mixed": 8000,
         "wheel_drop_substeps": 8000, "rolling_spheres": 300000, "rolling_rocks": 300000, "rolling_mixed": 16874,
         "slip_mixed": 3000, "spirit": 53380, "spirit_mer": 53380}


class PaperChecks(CommandTest):
    def check(self, name):
        result = self.tread("check", PAPER / f"{name}.toml")
        self.assertEqual(result.returncode, 0, f"{name}: {result.stdout}{result.stderr}")
        found = re.search(r"^(\d+) points, \d+ bodies \((\d+) rocks\)$", result.stdout, re.MULTILINE)
        points, rocks = int(found[1]), int(found[2])
        if name in POINTS:
            self.assertEqual(points, POINTS[name], name)
        if name in ROCKS:
            self.assertEqual(rocks, ROCKS[name], name)


def add_tests():
    for path in sorted(PAPER.glob("*.toml")):
        name = path.stem
        setattr(PaperChecks, f"test_{name}", lambda self, name=name: self.check(name))


add_tests()

if __name__ == "__main__":
    unittest.main()
