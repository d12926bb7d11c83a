#!/usr/bin/env python3
"""The commands that run nothing: --version, --help, check, sdf, info."""

import pathlib
import re
import unittest

from bad_input import binary_stl, cube
from command import BODY, SCENE, CommandTest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Commands(CommandTest):
    def test_version_is_that_of_the_build(self):
        result = self.tread("--version")
        wanted = re.search(r"project\(tread VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
        self.assertEqual((result.returncode, result.stdout), (0, f"tread {wanted}\n"))

    def test_help_names_every_command(self):
        result = self.tread("--help")
        self.assertEqual(result.returncode, 0)
        for command in ("run", "check", "sdf", "info"):
            self.assertIn(f"  {command} ", result.stdout)
            self.assertEqual(self.tread(command, "--help").returncode, 0)

    def test_check_writes_nothing(self):
        scene = self.write("scene.toml", SCENE + BODY)
        result = self.tread("check", scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("points", result.stdout)
        self.assertEqual(self.files(), ["scene.toml"])

    def test_sdf_of_a_cube(self):
        (self.directory / "cube.stl").write_bytes(binary_stl(cube(20.0)))
        result = self.tread("sdf", "cube.stl", "--unit", "mm", "--cells", "32", "--write-stl", "metres.stl")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"volume +8e-06 m3")
        self.assertRegex(result.stdout, r"area +0.0024 m2")
        self.assertRegex(result.stdout, r"inertia \(1\) +5.33333e-10 ")  # V a^2 / 6
        again = self.tread("sdf", "metres.stl", "--cells", "32")
        self.assertRegex(again.stdout, r"volume +8e-06 m3")

    def test_sdf_of_a_built_in_wheel(self):
        result = self.tread("sdf", "perseverance")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("watertight      yes", result.stdout)

    def test_info_needs_an_hdf5_file(self):
        scene = self.write("scene.toml", SCENE)
        self.assertEqual(self.tread("info", scene).returncode, 2)
        self.assertEqual(self.tread("info", "nowhere.h5").returncode, 2)


if __name__ == "__main__":
    unittest.main()
