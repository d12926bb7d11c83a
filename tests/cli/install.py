#!/usr/bin/env python3
"""The program in a prefix that was moved: it finds its scripts, scenes and pages there. Wants BUILD, the folder of the build."""

import os
import pathlib
import subprocess
import sys
import unittest

from command import CommandTest

BUILD = pathlib.Path(os.environ["BUILD"])
HAS_PYTHON = (BUILD / "python" / "tread" / "libtread_python.so").is_file()


class Install(CommandTest):
    def setUp(self):
        super().setUp()
        first = self.directory / "first"
        for component in ["Unspecified", *(["python"] if HAS_PYTHON else [])]:
            subprocess.run(["cmake", "--install", BUILD, "--prefix", first, "--component", component], check=True, capture_output=True)
        self.prefix = self.directory / "moved"
        first.rename(self.prefix)
        self.share = self.prefix / "share" / "tread"
        self.assertEqual(list(self.share.rglob("__pycache__")), [])

    def installed(self, *arguments):
        return subprocess.run([self.prefix / "bin" / "tread", *map(str, arguments)], capture_output=True, text=True, cwd=self.directory)

    def test_a_moved_prefix_has_all_of_it(self):
        shown = self.installed("--version")
        self.assertEqual(shown.returncode, 0, shown.stderr)
        for name in ("commit", "backends", "processor", "partition", "MPI", "HDF5", "Eigen"):
            self.assertIn(f"\n{name}: ", shown.stdout)
        checked = self.installed("check", self.share / "configs" / "quickstart.toml")
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.assertIn("--vary", self.installed("study", "--help").stdout)
        self.assertIn("--no-browser", self.installed("watch", "--help").stdout)
        self.assertIn("wheel_history", self.installed("post").stdout)
        self.assertIn("RUN", self.installed("post", "wheel_history", "--help").stdout)
        for path in ("docs/install.md", "jobs/campaign.py", "README.md", "LICENSE"):
            self.assertTrue((self.share / path).is_file(), path)

    @unittest.skipUnless(HAS_PYTHON, "built without the Python package")
    def test_python_finds_its_package(self):
        command = [sys.executable, "-c", "import tread, tread_post; print(tread.features(), tread_post.__file__)"]
        place = self.prefix / "lib" / "tread"
        shown = subprocess.run(command, capture_output=True, text=True, cwd=self.directory, env={**os.environ, "PYTHONPATH": str(place)})
        self.assertEqual(shown.returncode, 0, shown.stderr)
        self.assertIn(str(place), shown.stdout)

    def test_scripts_are_those_of_the_prefix(self):
        (self.share / "postprocess" / "thin.py").unlink()
        gone = self.installed("post", "thin")
        self.assertEqual(gone.returncode, 2)
        self.assertIn("there is no command 'thin'", gone.stderr)

    def test_completion_offers_commands(self):
        script = self.prefix / "share" / "bash-completion" / "completions" / "tread"
        def offered(*words):
            line = f"source {script}; COMP_WORDS=({' '.join(words)}); COMP_CWORD={len(words) - 1}; _tread; echo ${{COMPREPLY[*]}}"
            path = f"{self.prefix / 'bin'}:{os.environ['PATH']}"
            return subprocess.run(["bash", "-c", line], capture_output=True, text=True, env={**os.environ, "PATH": path}).stdout.split()
        self.assertEqual(offered("tread", "ch"), ["check"])
        self.assertEqual(offered("tread", "post", "wheel"), ["wheel_history"])
        self.assertIn("--restart", offered("tread", "run", "--re"))


if __name__ == "__main__":
    unittest.main()
