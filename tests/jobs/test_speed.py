#!/usr/bin/python3
"""The cost of a step stands twice: in the program, for `tread check`, and in jobs, which must run without the program."""

import re
import sys
import unittest
from dataclasses import astuple
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "jobs"))

from tread_jobs.resources import CORE_SPEED, GPU_SPEED  # noqa: E402

HEADER = ROOT / "src" / "run" / "wall_time.hpp"


def cost_of(name):
    numbers = re.search(rf"WorkCost {name}\s*= \{{([^}}]*)\}}", HEADER.read_text())[1]
    return tuple(float(number) for number in numbers.split(","))


class Speeds(unittest.TestCase):
    def test_are_those_of_the_program(self):
        for name, speed in (("gpu_cost", GPU_SPEED), ("core_cost", CORE_SPEED)):
            self.assertEqual(cost_of(name), astuple(speed), name)


if __name__ == "__main__":
    unittest.main()
