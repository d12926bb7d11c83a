"""What the tests of campaigns share: a small campaign, a place for it, and jobs/campaign.py."""

import json
import os
import pathlib
import stat
import subprocess
import sys
import tempfile
import tomllib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "jobs" / "campaign.py"
TREAD = os.environ["TREAD"]
WORK = ("sand_steps", "searches", "substeps", "joint_substeps", "rows", "points", "yielding_points", "pages", "bodies", "body_substeps", "near_substeps")
TWIN = ROOT / "configs" / "paper" / "reduced" / "slip_sand.toml"

CAMPAIGN = f"""
title = "A small campaign"
scene = "{TWIN}"

[set]
"phase.settle.max_duration" = 0.01
"phase.lower.max_duration"  = 0.03
"phase.drive.duration"      = 0.05
"phase.drive.drive.ramp"    = 0.01
"output.every"              = 0.001

[[axis]]
key    = "phase.drive.drive.slip"
values = [0.1, 0.5]

[[axis]]
keys   = ["domain.gravity", "body.wheel.mass"]
name   = "gravity"
unit   = "m/s2"
values = [[[0.0, 0.0, -3.72], 170.8], [[0.0, 0.0, -9.81], 64.8]]
labels = ["Mars", "Earth"]

[resources]
wall_time = "00:10:00"
"""


class CampaignTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tread-campaign-")
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)
        self.output = self.directory / "out"
        self.file = self.directory / "campaign.toml"
        self.file.write_text(CAMPAIGN, encoding="utf-8")

    def campaign(self, command, *options, output=None, program=TREAD, path=None, code=0):
        arguments = [sys.executable, str(PROGRAM), command, str(self.file), "--output", str(output or self.output), *map(str, options)]
        if command in ("expand", "submit", "local", "retry") and program:
            arguments += ["--tread", str(program)]
        environment = {**os.environ, "PATH": path if path is not None else os.environ["PATH"]}
        if command == "expand":  # starts programs alone, side by side (tread_alone in tests/CMakeLists.txt)
            environment["OMPI_MCA_orte_create_session_dirs"] = "0"
        done = subprocess.run(arguments, cwd=self.directory, env=environment, capture_output=True, text=True, timeout=250, check=False)
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def text(self, number, output=None):
        return ((output or self.output) / "cases" / f"{number:04}" / "scene.toml").read_text(encoding="utf-8")

    def scene(self, number):
        return tomllib.loads(self.text(number))

    def scene_of(self, output, number):
        return tomllib.loads(self.text(number, output))

    def script(self, name, text):
        path = self.directory / name
        path.write_text(text, encoding="utf-8")
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return path

    def checked_only(self):
        """A program that says of every scene what `tread check` would: for tests that run nothing."""
        work = dict.fromkeys(WORK, 0.0) | {"sand_steps": 2e3, "points": 2e4}
        plan = {"points": 10, "bodies": 1, "time": 2.0, "steps": 2e3, "disk": 2500, "memory": 1, "scene": "", "set_up": 0.5, "work": work}
        return self.script("checks_only", f"#!/bin/sh\necho '{json.dumps(plan)}'\n")
