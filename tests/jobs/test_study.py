#!/usr/bin/python3
"""`tread study`: its options, what is refused, and studies of scenes that take a second."""

import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "jobs"), str(ROOT / "postprocess")]

from made_up_run import colours_of  # noqa: E402
from slow_parts import slow  # noqa: E402
from tread_jobs.study_plan import read_setting, read_variation  # noqa: E402

TREAD = os.environ["TREAD"]


class Options(unittest.TestCase):
    def test_values_are_toml_and_bare_words(self):
        found = read_variation("domain.gravity=[0, 0, -9.8],[0,0,-3.7]")
        self.assertEqual((found.key, found.values), ("domain.gravity", ([0, 0, -9.8], [0, 0, -3.7])))
        self.assertEqual(read_variation('time.dt=auto,1e-4,"auto"').values, ("auto", 1e-4, "auto"))
        self.assertEqual(read_setting("body[0].lock=[\"y\"]"), ("body[0].lock", ["y"]))


BALL = """
title = "a ball that rolls down"
[domain]
size    = [2.0, 1.0, 1.0]
gravity = [0.8, 0.0, -9.8]
walls   = { x = "open", y = "open" }
[time]
dt       = 1e-3
substeps = 10
[[material]]
name    = "steel"
model   = "elastic"
density = 2500.0
young   = 3e6
poisson = 0.3
[[contact]]
between  = ["steel", "wall"]
friction = 0.5
[[shape]]
name     = "ball"
generate = { kind = "sphere", nodes = 162 }
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = 0.1
mass     = 1.3
position = [0.5, 0.5, 0.05]
[[phase]]
name     = "roll"
duration = 0.2
[reference]
form = "rolling-ball"
"""


class Studies(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tread-study-")
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)
        self.scene = self.directory / "ball.toml"
        self.scene.write_text(BALL, encoding="utf-8")

    def study(self, *options, scene=None, code=0):
        command = [TREAD, "study", str(scene or self.scene), "--threads", "1", *options]
        done = subprocess.run(command, cwd=self.directory, capture_output=True, text=True, timeout=250, check=False)
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def rows(self, output):
        with open(self.directory / output / "study.csv", encoding="utf-8") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))

    def test_closed_form_from_end_to_end(self):
        """A ball rolls down to half a percent: the tolerance of tests/physics/rolling.cpp."""
        options = ("--vary", "time.dt=2e-3,1e-3", "--vary", "time.substeps=10,20", "--output", "out", "--jobs", "2")
        done = self.study(*options)
        rows = self.rows("out")
        self.assertEqual([(row["time.dt"], row["time.substeps"]) for row in rows], [("0.002", "10"), ("0.002", "20"), ("0.001", "10"), ("0.001", "20")])
        for row in rows:
            self.assertAlmostEqual(float(row["right"]), 5 / 7 * 0.8, 2)
            self.assertLess(float(row["error"]), 5e-3)
            self.assertEqual((row["state"], row["reference"], row["bodies"]), ("done", "a ball that rolls", "1"))
            self.assertGreater(float(row["wall_s"]), 0)
            self.assertGreater(float(row["memory_bytes"]), 0)
        self.assertRegex(done.stdout, r"acceleration within 5 %: dt \S+, substeps \d+; (the dearest|[\d.]+ times cheaper)")
        self.assertGreater(colours_of(self.directory / "out" / "study.png"), 10)
        # Again: nothing is run, and the table is the same. Other values are another study.
        before = (self.directory / "out" / "study.csv").read_text(encoding="utf-8")
        self.assertNotIn("task", self.study(*options).stdout)
        self.assertEqual((self.directory / "out" / "study.csv").read_text(encoding="utf-8"), before)
        self.assertIn("was expanded from another", self.study("--vary", "time.dt=2e-3,3e-3", "--output", "out", code=2).stderr)

    @slow
    def test_what_was_interrupted_goes_on(self):
        options = ("--vary", "time.dt=2e-3,1e-3", "--output", "out")
        self.study(*options)
        cases = self.directory / "out" / "variants" / "cases"
        kept = (cases / "0000" / "run" / "summary.json").stat().st_mtime_ns
        for path in sorted((cases / "0001").rglob("*"), reverse=True):
            if path.name != "scene.toml" or path.parent.name == "run":
                path.rmdir() if path.is_dir() else path.unlink()
        done = self.study(*options)
        self.assertIn("task 0 (cases 0001): done", done.stdout)
        self.assertEqual((cases / "0000" / "run" / "summary.json").stat().st_mtime_ns, kept)
        self.assertEqual(len(self.rows("out")), 2)

    @slow
    def test_star_with_repeats_and_without_the_closed_form(self):
        self.study("--design", "star", "--vary", "time.dt=4e-3,2e-3", "--vary", "numerics.precision=single,double", "--repeats", "2", "--output", "out",
                   "--reference", "finest", "--quantities", "acceleration,energy")
        rows = [row for row in self.rows("out") if row["quantity"] == "acceleration"]
        # Single precision is the default, so that it is the scene as it is; that one is compared with itself.
        self.assertEqual([(row["time.dt"], row["numerics.precision"], row["repeat"]) for row in rows],
                         [("0.001", "single", ""), ("0.004", "single", ""), ("0.002", "single", ""), ("0.001", "double", ""),
                          ("0.001", "single", "1e-09 m"), ("0.001", "single", "2e-09 m")])
        self.assertIn("mean of 3 perturbed repeats", rows[0]["reference"])
        self.assertLess(float(rows[0]["scatter"]), 1e-5)
        self.assertLess(abs(float(rows[0]["right"]) / (5 / 7 * 0.8) - 1), 1e-2)

    def test_a_variant_that_stops_is_told(self):
        """Two substeps of 1e-2 s are far beyond what contact bears: exit 3 of that variant, and a table of the others."""
        done = self.study("--vary", "time.dt=2e-2,1e-3", "--set", "time.substeps=2", "--output", "out", code=3)
        self.assertRegex(done.stdout, r"variant 0000: exit 3: .*substeps")
        self.assertEqual([(row["state"], row["error"] != "") for row in self.rows("out")], [("failed", False), ("done", True)])

    @slow
    def test_a_damaged_variant_is_told(self):
        """Whether its series cannot be read, or its summary has other types: one failed row, and the others are compared."""
        options = ("--vary", "time.dt=4e-3,2e-3,1e-3", "--output", "out")
        self.study(*options)
        run = self.directory / "out" / "variants" / "cases" / "0001" / "run"
        series, summary = (run / "timeseries.h5").read_bytes(), (run / "summary.json").read_text(encoding="utf-8")
        for name, damaged in (("timeseries.h5", series[:96] + bytes(len(series) - 96)), ("timeseries.h5", b""),
                              ("summary.json", json.dumps(json.loads(summary) | {"wall_s": "fast"}).encode())):
            with self.subTest(name=name, length=len(damaged)):
                (run / name).write_bytes(damaged)
                done = self.study(*options, code=3)
                self.assertRegex(done.stdout, "2 done, 1 failed\nvariant 0001: .*(cannot be compared|no whole HDF5 file)")
                self.assertEqual([(row["state"], row["error"] != "") for row in self.rows("out")], [("done", True), ("failed", False), ("done", True)])
                self.assertIn("\n# variant 0001: ", (self.directory / "out" / "study.csv").read_text(encoding="utf-8"))
                (run / "timeseries.h5").write_bytes(series)
                (run / "summary.json").write_text(summary, encoding="utf-8")

    def test_dry_run_writes_nothing(self):
        done = self.study("--vary", "time.dt=2e-3,1e-3", "--dry-run")
        self.assertIn("2 variants, about", done.stdout)
        self.assertEqual(sorted(path.name for path in self.directory.iterdir()), ["ball.toml"])

    def test_what_is_refused(self):
        for options, words in (
            ((), "--vary KEY=A,B,... is missing"),
            (("--vary", "time.dt"), "--vary time.dt: KEY=VALUE,VALUE"),
            (("--vary", "time.dt=1e-3"), "at least two values"),
            (("--vary", "time.dt=1e-3,"), "an empty value"),
            (("--vary", "time.dt=1e-3,1e-3"), "stands there twice"),
            (("--vary", "time.dt=1e-3,0"), r"\[time\] dt: 0 is out of range; accepted: number >= 1e-12 and <= 1000, or \"auto\" \(s\)"),
            (("--vary", "time.substeps=1,2.5"), r"\[time\] substeps: .*accepted: .*integer"),
            (("--vary", "time.td=1e-3,2e-3"), r"\[time\] td: unknown key; accepted: dt, substeps"),
            (("--vary", "body.bell.mass=1,2"), "no 'bell' among ball"),
            (("--vary", "time.dt=1e-3,2e-3", "--vary", "time.dt=3e-3,4e-3"), "two axes are called 'time.dt'"),
            (("--vary", "time.dt=1e-3,2e-3", "--set", "time.dt=1e-3"), "clash"),
            (("--vary", "time.dt=1e-3,2e-3", "--quantities", "torqe"), "--quantities torqe: unknown; this scene has force,"),
            (("--vary", "time.dt=1e-3,2e-3", "--reference", "coarsest"), "--reference coarsest: finest, or"),
            (("--vary", "time.dt=1e-3,2e-3", "--reference", "torque=5"), "--reference torque: is not compared"),
            (("--vary", "time.dt=1e-3,2e-3", "--perturb", "seed", "--repeats", "1"), r"draws no \[\[rocks\]\]"),
            (("--vary", "time.dt=1e-3,2e-3", "--within", "2"), "over 0 and under 100%"),
            (("--vary", "time.dt=1e-3,2e-3", "--jobs", "0"), "at least 1"),
        ):
            with self.subTest(options=options):
                done = self.study(*options, "--output", "out", code=2)
                self.assertRegex(done.stderr, words)
        self.assertIn("nowhere.toml", self.study("--vary", "time.dt=1e-3,2e-3", scene="nowhere.toml", code=2).stderr)
        self.scene.write_text(BALL.replace("rolling-ball", "run-out"), encoding="utf-8")
        self.assertIn("the scene is not of its kind, which wants one box", self.study("--vary", "time.dt=1e-3,2e-3", code=2).stderr)
        self.assertEqual(sorted(path.name for path in self.directory.iterdir()), ["ball.toml"])


if __name__ == "__main__":
    unittest.main()
