#!/usr/bin/python3
"""postprocess/grid_error.py recovers the laws that made-up runs follow, and says what it lacks."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

from grid_error import laws_of, row_of  # noqa: E402
from made_up_run import make_run  # noqa: E402
from tread_post import Run, RunError  # noqa: E402

SIDE, LOAD = 0.16, 1000.0  # m, of the patch; N
LIMITS = {"drawbar_pull": (-10.0, 2.0 * LOAD, 1), "torque": (100.0, 900.0, 2), "sinkage": (0.045, -0.12, 1)}


def run_at(folder, spacing):
    """A made-up run whose answers are limit + slope / cells^order."""
    path = folder / f"run_{spacing}"
    make_run(path)
    scene = (path / "scene.toml").read_text().replace("spacing = 0.02", f"spacing = {spacing}", 1)
    (path / "scene.toml").write_text(scene)
    cells = SIDE / spacing
    answers = {name: limit + slope / cells**order for name, (limit, slope, order) in LIMITS.items()}
    summary = json.loads((path / "summary.json").read_text())
    summary["resolution"] = {"verdict": "marginal", "figures": {"contact_cells": {"value": cells}}}
    (path / "summary.json").write_text(json.dumps(summary))
    with h5py.File(path / "timeseries.h5", "r+") as file:
        wheel = next(iter(file["wheel"].values()))
        wheel["drawbar_pull"][:] = answers["drawbar_pull"]
        wheel["sinkage"][:] = answers["sinkage"]
        wheel["torque"][:] = np.array([0.0, -answers["torque"], 0.0])
        wheel["force"][:] = np.array([0.0, 0.0, LOAD])
    return path


class GridErrorTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tread-grid-error-")
        self.addCleanup(folder.cleanup)
        self.paths = [run_at(Path(folder.name), spacing) for spacing in (0.02, 0.0125, 0.01, 0.005)]

    def test_the_laws_come_back(self):
        laws, rows = laws_of([Run(path) for path in self.paths])
        self.assertEqual(len(rows), 4)
        for name, key, scale in (("drawbar_pull", "pull", LOAD), ("torque", "torque", 100.0), ("sinkage", "sinkage", 0.045)):
            limit, slope, order = LIMITS[name]
            self.assertAlmostEqual(laws[key][order].limit, limit, delta=1e-6 * abs(limit))
            self.assertAlmostEqual(laws[key][order].factor, abs(slope) / scale, delta=1e-6 * abs(slope) / scale)
            self.assertGreater(laws[key][3 - order].scatter, laws[key][order].scatter)
        self.assertEqual(row_of("drum", Run(self.paths[0]).scene, laws), '{"drum", SoilKind::frictional, {{2, 1}, {9, 2}, {2.7, 1}}},')

    def test_two_spacings_are_no_ladder(self):
        with self.assertRaisesRegex(RunError, "3 spacings or more"):
            laws_of([Run(path) for path in self.paths[:2]])

    def test_the_command_prints_the_row(self):
        done = subprocess.run([ROOT / "postprocess" / "grid_error.py", "--name", "drum", *self.paths], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('{"drum", SoilKind::frictional, {{2, 1}, {9, 2}, {2.7, 1}}},', done.stdout)
        short = subprocess.run([ROOT / "postprocess" / "grid_error.py", *self.paths[:1]], capture_output=True, text=True, check=False)
        self.assertNotEqual(short.returncode, 0)
        self.assertIn("3 spacings or more", short.stderr)


if __name__ == "__main__":
    unittest.main()
