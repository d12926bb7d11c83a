#!/usr/bin/env python3
"""Python programs on two ranks: the launcher's processes, or a communicator of mpi4py."""

import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import unittest

import tread
from package import MPIRUN, SCENE, PackageTest

PROGRAM = pathlib.Path(__file__).with_name("rank_program.py")


class Ranks(PackageTest):
    def program(self, what, ranks=2):
        command = [*MPIRUN, "-n", str(ranks), sys.executable, PROGRAM, what, str(self.directory / what)]
        # MPI adds to the environment of this process what a launcher in it stumbles over; os.environ is as it was before.
        return subprocess.run(command, capture_output=True, text=True, timeout=250, env={**os.environ})

    def assert_halves(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)
        shares = [int(count) for count in re.findall(r"points (\d+) status finished", result.stdout)]
        self.assertEqual(len(shares), 2, result.stdout)
        self.assertEqual(sum(shares), self.run_scene(SCENE).summary["points"])
        self.assertGreater(min(shares), 0)

    def test_ranks_share_a_scene(self):
        self.assert_halves(self.program("share"))

    @unittest.skipUnless(importlib.util.find_spec("mpi4py"), "mpi4py is not installed")
    def test_a_communicator_of_mpi4py(self):
        self.assert_halves(self.program("mpi4py"))

    def test_rank_0_steers(self):
        result = self.program("steer")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(tread.Run(self.directory / "steer").wheel("ball")["angular_velocity"][2][1], 3.0)

    def test_an_error_of_a_rank_stops_all(self):
        result = self.program("fail")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("LookupError: on one rank", result.stderr)
        self.assertIn("another rank: stopped by an error in a callback", result.stderr)
        self.assertIn("an error in a callback", tread.Run(self.directory / "fail").summary["reason"])


if __name__ == "__main__":
    unittest.main()
