#!/usr/bin/env python3
"""What summary.json and the log say of a driven wheel, beside what postprocess makes of the same time series."""

import json
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "postprocess"))

import h5py  # noqa: E402
import numpy as np  # noqa: E402

from command import BODY, SCENE, CommandTest  # noqa: E402
from tread_post import Run  # noqa: E402
from tread_post.answers import answers_of, last_drive  # noqa: E402
from tread_post.steady import steady_part  # noqa: E402

# A roller set down on the sand, then driven with slip; twenty rows and more after the ramp.
WHEEL = BODY.replace("0.3]", "0.165]").replace("mass     = 1.0", "mass     = 3.0") + 'lock = ["y", "roll", "yaw"]\n'
DRIVE = """
[[phase]]
name     = "drive"
duration = 0.3
drive    = { body = "roller", angular_velocity = %s, ramp = 0.02, slip = 0.3 }
"""


def driven(speed=2.0):
    scene = SCENE.replace("snapshots_every = 0.01\n", "").replace("duration = 0.02", "duration = 0.1", 1)
    return scene.replace("[output]", DRIVE % speed + "\n[output]") + WHEEL


# Ours by theirs.
NAMES = {"pull": "drawbar_pull", "torque": "torque", "sinkage": "sinkage", "slip": "slip", "load": "weight"}


class Answers(CommandTest):
    def summary_of(self, text, *options, code=0):
        result = self.tread("run", self.write("scene.toml", text), "--output", self.output, "--backend", "cpu", *options)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return json.loads((self.output / "summary.json").read_text())

    def answers(self, text):
        summary = self.summary_of(text)
        found = summary["answers"]["roller"]
        self.assertEqual([phase["phase"] for phase in found], ["drive"])
        self.check_error_of_the_grid(found[0], summary["grid_error"])
        return found[0]

    def check_error_of_the_grid(self, answers, error):
        """Requires estimated errors of pull, torque and sinkage; others have none."""
        self.assertEqual(answers["pull"]["estimated_error"], error["pull"] * error["load"])
        self.assertEqual(answers["pull_over_load"]["estimated_error"], error["pull"])
        for name in ("torque", "sinkage"):
            self.assertAlmostEqual(answers[name]["estimated_error"], error[name] * abs(answers[name]["mean"]), places=12)
        for name in answers.keys() & {"slip", "power", "load"}:
            self.assertIsNone(answers[name]["estimated_error"])

    def test_answers_are_those_of_postprocess(self):
        for speed in (2.0, -2.0):
            with self.subTest(speed=speed):
                self.output = self.directory / f"run{speed}"
                answers = self.answers(driven(speed))
                values, _ = answers_of(Run(self.output))
                self.assertEqual(answers["steady"], bool(values["steady"]))
                self.assertAlmostEqual(answers["from"], values["steady_from"], places=9)
                for ours, theirs in NAMES.items():
                    self.assertAlmostEqual(answers[ours]["mean"], values[theirs], delta=1e-9 * max(1, abs(values[theirs])), msg=ours)
                    self.assertAlmostEqual(answers[ours]["spread"], values[f"{theirs}_spread"], delta=1e-9, msg=ours)
                self.assertAlmostEqual(answers["pull_over_load"]["mean"], values["drawbar_pull"] / values["weight"], places=9)
                self.check_error_of_mean(answers)

    def check_error_of_mean(self, answers):
        drive = last_drive(Run(self.output))
        part = drive.series["drawbar_pull"][drive.time >= answers["from"]]
        self.assertEqual(answers["rows"], len(part))
        means = [piece.mean() for piece in np.array_split(part, 8)]
        self.assertAlmostEqual(answers["pull"]["standard_error"], np.std(means, ddof=1) / np.sqrt(8), places=9)
        self.assertEqual(answers["steady"], all(steady_part(drive.time, drive.series[name]).is_steady
                                                for name in ("drawbar_pull", "torque", "sinkage")))

    def test_signs_and_units(self):
        """A wheel that is driven needs a torque and takes power, whichever way it goes, and throws sand backwards: it pulls or is held back alike."""
        for speed in (2.0, -2.0):
            self.output = self.directory / f"signs{speed}"
            answers = self.answers(driven(speed))
            self.assertGreater(answers["torque"]["mean"], 0)
            self.assertAlmostEqual(answers["power"]["mean"], abs(speed) * answers["torque"]["mean"], delta=0.02 * answers["power"]["mean"])
            self.assertAlmostEqual(answers["slip"]["mean"], 0.3, places=3)
            self.assertGreater(answers["load"]["mean"], 0)
            units = {name: answers[name]["unit"] for name in ("pull", "pull_over_load", "load", "torque", "sinkage", "slip", "power")}
            self.assertEqual(units, {"pull": "N", "pull_over_load": "1", "load": "N", "torque": "N m", "sinkage": "m", "slip": "1", "power": "W"})
            with h5py.File(self.output / "timeseries.h5", "r") as file:
                wheel = file["wheel/roller"]
                # Rolling towards +x is a positive spin about +y, against which the ground turns the wheel.
                self.assertGreater(speed * wheel["velocity"][-1, 0], 0)
                self.assertGreater(speed * wheel["angular_velocity"][-1, 1], 0)
                self.assertLess(speed * wheel["torque"][-10:, 1].mean(), 0)

    def test_the_log_ends_with_them(self):
        answers = self.answers(driven())
        line = (self.output / "log.txt").read_text().rstrip().splitlines()[-1]
        self.assertRegex(line, r"answers: roller, drive: pull \S+ \+- \S+ N \(\S+ of the load\), load .* N, torque .* N m, sinkage .* m, slip .*, "
                               r"power .* W, (NOT steady, means|steady) over \S+ to 0.4 s$")
        self.assertEqual("NOT steady" in line, not answers["steady"])

    def test_a_wheel_that_only_stands_has_its_sinkage(self):
        text = SCENE.replace("duration = 0.02", "duration = 0.1", 1) + WHEEL
        phases = self.summary_of(text)["answers"]["roller"]
        self.assertEqual([phase["phase"] for phase in phases], ["rest"])
        self.assertEqual(set(phases[0]) - {"phase", "from", "to", "rows", "steady", "ended"}, {"load", "sinkage"})
        self.assertTrue(phases[0]["ended"])
        with h5py.File(self.output / "timeseries.h5", "r") as file:
            wheel = file["wheel/roller"]
            rows = wheel["time"][:] >= phases[0]["from"]
            self.assertAlmostEqual(phases[0]["sinkage"]["mean"], wheel["sinkage"][rows].mean(), places=12)
            # Before it sinks in, it stands as far above the bed as the scene says: lowest point at 0.105 m, sand up to 0.1 m.
            self.assertAlmostEqual(wheel["sinkage"][0], -0.005, delta=1e-6)

    def test_a_wheel_that_is_kept_from_turning_has_no_slip(self):
        answers = self.answers(driven(0.0).replace(", slip = 0.3", ""))
        with h5py.File(self.output / "timeseries.h5", "r") as file:
            wheel = file["wheel/roller"]
            self.assertTrue(np.isnan(wheel["slip"][wheel["time"][:] >= answers["from"]]).all())
        self.assertEqual(set(answers) & {*NAMES, "pull_over_load", "power"}, {"pull", "pull_over_load", "load", "torque", "sinkage", "power"})
        line = (self.output / "log.txt").read_text().rstrip().splitlines()[-1]
        self.assertRegex(line, r"answers: roller, drive: pull .* of the load\), load .*, torque .*, sinkage .* m, power ")
        self.assertNotRegex(line, "slip|nan")
        self.assertNotRegex((self.output / "summary.json").read_text(), r'"mean": null')

    def test_a_wheel_that_carries_nothing_has_no_share_of_its_load(self):
        """It still falls."""
        text = driven().replace("duration = 0.1", "duration = 0.02").replace("duration = 0.3", "duration = 0.1").replace("0.165]", "0.3]")
        answers = self.summary_of(text)["answers"]["roller"][0]
        self.assertEqual((answers["pull"]["mean"], answers["load"]["mean"]), (0, 0))
        self.assertNotIn("pull_over_load", answers)
        self.assertIn("pull 0 +- 0 N, load 0 +- 0 N, ", (self.output / "log.txt").read_text())

    def test_a_run_that_stops_within_a_phase_says_so(self):
        phases = self.summary_of(driven(0.01).replace("duration = 0.3", "duration = 300"), "--walltime-limit", "00:00:08", code=75)["answers"]["roller"]
        self.assertEqual([phase["ended"] for phase in phases], [False])
        self.assertIn("(the phase did not end)", (self.output / "log.txt").read_text())

    def test_sinkage_goes_on_from_a_checkpoint_to_the_bit(self):
        text = driven()
        self.summary_of(text)
        with h5py.File(self.output / "timeseries.h5", "r") as file:
            whole = file["wheel/roller/sinkage"][:].tobytes()
        answers = json.loads((self.output / "summary.json").read_text())["answers"]
        self.output = self.directory / "halves"
        scene = self.write("scene.toml", text)
        self.tread("run", scene, "--output", self.output, "--backend", "cpu", "--set", "checkpoint.every_steps=200", "--set", "checkpoint.keep=1000")
        middle = sorted((self.output / "checkpoints").glob("*.h5"))
        middle = middle[len(middle) // 2]
        again = self.directory / "again"
        result = self.tread("run", scene, "--output", again, "--backend", "cpu", "--restart", middle)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        with h5py.File(again / "timeseries.h5", "r") as file:
            self.assertEqual(file["wheel/roller/sinkage"][:].tobytes(), whole)
        self.assertEqual(json.loads((again / "summary.json").read_text())["answers"], answers)


if __name__ == "__main__":
    unittest.main()
