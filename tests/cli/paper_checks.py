#!/usr/bin/env python3
"""Every full-size scene of the paper passes `tread check`, with the counts that its comments promise; no scene of configs/ warns.

A scene that starts from the bed of a run that was not made is told which file is missing."""

import pathlib
import re
import unittest

from command import CommandTest

CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"
PAPER = CONFIGS / "paper"
FURTHER = ["*.toml", "studies/*.toml", "campaigns/scenes/*.toml", "paper/coarse/*.toml", "paper/reduced/*.toml",
           "validation/scenes/*.toml", "rover/*.toml", "soil/*.toml", "soil/reduced/*.toml", "grains/*.toml", "grains/reduced/*.toml"]
TOO_LARGE = {CONFIGS / "studies/wide_terrain.toml"}  # a thousand million points: minutes of 48 cores

# Points: the paper's own count or the lattice's, less the volume of the rocks that stand in the sand; rocks by the scene.
POINTS = {"head_on_1": 33552, "head_on_8": 268096, "head_on_27": 904960, "wheel_drop_sand": 1150000,
          "rolling_sand": 101250, "slip_sand": 864000, "spirit": 707520, "spirit_mer": 707520,
          "wheel_drop_mixed": 1150000 - 4189, "wheel_drop_substeps": 1150000 - 4189, "rolling_mixed": 101250 - 1104,
          "slip_mixed": 864000 - 15200, "curiosity_rock": 589824 - 6291}
ROCKS = {"wheel_drop_rock": 300000, "wheel_drop_rock_filled": 300000, "wheel_drop_mixed": 8000,
         "wheel_drop_substeps": 8000, "rolling_spheres": 300000, "rolling_rocks": 300000, "rolling_mixed": 16874,
         "slip_mixed": 3000, "spirit": 53380, "spirit_mer": 53380}


class PaperChecks(CommandTest):
    def sensible(self, path):
        result = self.tread("check", path)
        self.assertEqual(result.returncode, 0, f"{path}: {result.stdout}{result.stderr}")
        self.assertEqual(re.findall("^warning: .*$", result.stdout, re.MULTILINE), [], path)
        return result

    def names_its_bed(self, path):
        result = self.tread("check", path)
        self.assertEqual(result.returncode, 2, f"{path}: {result.stdout}")
        self.assertRegex(result.stderr, r"from: there is no file .*/runs/.*/bed\.h5; accepted: bed\.h5 of a run")

    def check(self, name):
        result = self.sensible(PAPER / f"{name}.toml")
        found = re.search(r"^(\d+) points, \d+ bodies \((\d+) rocks\)$", result.stdout, re.MULTILINE)
        points, rocks = int(found[1]), int(found[2])
        if name in POINTS:
            self.assertEqual(points, POINTS[name], name)
        if name in ROCKS:
            self.assertEqual(rocks, ROCKS[name], name)


def starts_from_a_run(path):
    return re.search(r'^from +=.*/runs/', path.read_text(encoding="utf-8"), re.MULTILINE)


def add_tests():
    def add(name, test):
        def run(self):
            test(self)
        setattr(PaperChecks, f"test_{name}", run)

    for path in PAPER.glob("*.toml"):
        add(path.stem, lambda self, name=path.stem: self.check(name))
    for path in sorted({path for pattern in FURTHER for path in CONFIGS.glob(pattern)} - TOO_LARGE):
        test = PaperChecks.names_its_bed if starts_from_a_run(path) else PaperChecks.sensible
        add("_".join(path.relative_to(CONFIGS).with_suffix("").parts), lambda self, test=test, path=path: test(self, path))


add_tests()

if __name__ == "__main__":
    unittest.main()
