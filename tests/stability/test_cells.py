#!/usr/bin/env python3
"""How the stability matrix judges: made-up runs, and every scene of its tables."""

import dataclasses
import json
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

import cells

STORES = ("kinetic_points", "strain", "kinetic_bodies", "contact", "gravity", "work_in")
CELL = cells.Cell("a cell", "sand", {}, [], {"energy_held": 1.1, "energy_error": 0.05, "momentum": 1e-4}, {"stable": "", "stopped": "too deep"})


class Judging(unittest.TestCase):
    def judge(self, code, kinetic=(0, 1.0), energy=0.0, momentum=0.0, verdict="resolved", reason="all phases ran", steps=1000, cell=CELL):
        """A fall by 1 J to `kinetic`, with these errors and the verdict on energy."""
        with tempfile.TemporaryDirectory() as folder:
            run = Path(folder)
            figure = {"value": abs(energy), "verdict": verdict}
            (run / "summary.json").write_text(json.dumps(
                {"steps": steps, "substeps": steps, "time": 1, "wall_s": 1, "status": "finished" if code == 0 else "stopped",
                 "reason": reason, "peak_host_bytes": 1, "errors": {"mass": 0, "momentum": momentum, "energy": energy},
                 "resolution": {"verdict": verdict, "figures": {"energy_error": figure}}}), encoding="utf-8")
            with h5py.File(run / "timeseries.h5", "w") as file:
                for name in STORES:
                    file[f"energy/{name}"] = np.zeros(len(kinetic))
                file["energy/gravity"][:] = np.linspace(1, 0, len(kinetic))
                file["energy/kinetic_points"][:] = kinetic
            result = cells._result(cell, code, "said", run)
            return result.outcome, result.expected

    def test_what_keeps_its_bounds_is_stable(self):
        self.assertEqual(self.judge(0), ("stable", True))
        self.assertEqual(self.judge(75), ("stable", True))

    def test_growth_and_drift_are_wrong(self):
        self.assertEqual(self.judge(0, kinetic=(0, 1.2)), ("wrong", False))
        self.assertEqual(self.judge(0, kinetic=(0, float("nan"))), ("wrong", False))
        self.assertEqual(self.judge(0, momentum=1e-3), ("wrong", False))
        self.assertEqual(self.judge(1), ("wrong", False))
        self.assertEqual(self.judge(75, steps=3), ("wrong", False))

    def test_an_error_that_the_run_reports_is_not_silent(self):
        self.assertEqual(self.judge(0, energy=0.2, verdict="under-resolved"), ("told", False))
        self.assertEqual(self.judge(0, energy=-0.2, verdict="marginal"), ("wrong", False))
        reporting = dataclasses.replace(CELL, allowed={"told": "energy_error"})
        self.assertEqual(self.judge(0, energy=0.2, verdict="under-resolved", cell=reporting), ("told", True))

    def test_a_stop_wants_its_diagnosis_in_time(self):
        self.assertEqual(self.judge(3, reason="t = 1 s: point 3 is too deep"), ("stopped", True))
        self.assertEqual(self.judge(3, reason="t = 1 s: a body is lost"), ("stopped", False))
        self.assertEqual(self.judge(3, reason="it broke"), ("wrong", False))
        self.assertEqual(self.judge(3, reason="t = 1 s: too deep", kinetic=(0, 20.0)), ("wrong", False))


class Tables(unittest.TestCase):
    def test_every_cell_has_a_scene_and_a_name_of_its_own(self):
        for table in ("matrix.toml", "limits.toml"):
            found = cells.read_matrix(cells.HERE / table)
            self.assertEqual(len({cell.name for cell in found}), len(found))
            for cell in found:
                scene, _ = cells.scene_of(cell)
                self.assertTrue(cells.toml_text(scene), cell.name)


if __name__ == "__main__":
    unittest.main()
