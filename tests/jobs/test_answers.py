#!/usr/bin/python3
"""What postprocess/ makes of drives: steady parts, answers, Wong and Reece's formulas, and the figures and page of a campaign."""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
from matplotlib.image import imread

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import campaign_report  # noqa: E402
import compare  # noqa: E402
import render  # noqa: E402
import slices  # noqa: E402
import slip_curves  # noqa: E402
from made_up_run import RADIUS, SCENE, SURFACE, colours_of, make_run  # noqa: E402
from slow_parts import slow  # noqa: E402
from tread_post import Run, RunError  # noqa: E402
from tread_post.answers import answers_of, last_drive  # noqa: E402
from tread_post.campaign import CampaignTable, write_campaign_table  # noqa: E402
from tread_post.sections import outline_of  # noqa: E402
from tread_post.steady import steady_part  # noqa: E402
from tread_post.verdict import headline, plot_verdicts, resolution_of, verdict_handles  # noqa: E402
from tread_post.wong_reece import PUBLISHED, Wheel, predict  # noqa: E402


class SteadyTest(unittest.TestCase):
    time = np.linspace(0, 10, 1000)
    noise = np.random.default_rng(3).normal(0, 1, 1000)

    def test_a_transient_is_cut(self):
        found = steady_part(self.time, 50 - 40 * np.exp(-self.time / 0.5) + self.noise)
        self.assertTrue(found.is_steady)
        # After three to seven time constants what is left of the transient is within the noise.
        self.assertTrue(1.0 < found.start < 3.5, found)
        self.assertLess(abs(found.mean - 50), 4 * found.error + 0.1)
        self.assertLess(abs(found.spread - 1), 0.1)

    def test_noise_and_waves_are_steady(self):
        for values in (20 + self.noise, 20 + 5 * np.sin(2 * np.pi * self.time / 0.37), np.full(1000, 0.3)):
            found = steady_part(self.time, values)
            self.assertTrue(found.is_steady)
            self.assertLess(abs(found.mean - values.mean()), 0.3)
            self.assertLess(found.start, 5)

    def test_what_still_changes_is_not_steady(self):
        for values in (10 + 2 * self.time + self.noise, np.exp(self.time / 5), 5 - 4 * np.exp(-self.time / 20) + 0.01 * self.noise):
            found = steady_part(self.time, values)
            self.assertFalse(found.is_steady)
            self.assertAlmostEqual(found.start, 5, 1)

    def test_a_drift_that_does_not_matter_is_steady(self):
        self.assertTrue(steady_part(self.time, 100 + 0.1 * self.time + 0.01 * self.noise).is_steady)

    def test_too_little_says_nothing(self):
        self.assertIsNone(steady_part(self.time[:10], self.noise[:10]))
        self.assertIsNone(steady_part(self.time, np.full(1000, np.nan)))


class VerdictTest(unittest.TestCase):
    """What is read from a summary.json, and what is said and drawn of it."""

    figures = {"mass_error": {"value": 0.0, "resolved": 1e-6, "marginal": 1e-3, "verdict": "resolved"},
               "transfer_loss": {"value": 0.5, "resolved": 0.02, "marginal": 0.1, "verdict": "under-resolved"},
               "contact_cells": {"value": 2.0, "resolved": 20.0, "marginal": 6.0, "verdict": "under-resolved"},
               "pull_error": {"value": 0.18, "resolved": 0.05, "marginal": 0.2, "verdict": "marginal"}}

    def test_of_a_summary(self):
        found = resolution_of({"status": "finished", "resolution": {"verdict": "under-resolved", "figures": self.figures}, "warnings": ["gravity points up"]})
        self.assertEqual((found.verdict, found.errors, found.warnings), ("under-resolved", {"pull_error": 0.18}, ("gravity points up",)))
        # 0.5 is 25 times its bound, 2 cells a tenth of theirs.
        self.assertEqual(found.worst_figure, "transfer_loss 0.5 (resolved to 0.02, marginal to 0.1)")
        fewer = {name: figure for name, figure in self.figures.items() if name != "transfer_loss"}
        self.assertEqual(resolution_of({"resolution": {"verdict": "under-resolved", "figures": fewer}}).worst_figure,
                         "contact_cells 2 (resolved from 20, marginal from 6)")

    def test_a_failed_run_is_never_resolved(self):
        for verdict in ("resolved", "marginal", "under-resolved"):
            self.assertEqual(resolution_of({"status": "failed", "resolution": {"verdict": verdict, "figures": {}}}).verdict, "failed")

    def test_without_figures(self):
        for summary in (None, {}, {"status": "finished"}, {"status": "finished", "resolution": None, "warnings": None}):
            self.assertEqual((resolution_of(summary).verdict, resolution_of(summary).worst_figure, resolution_of(summary).warnings), ("", "", ()))
        # JSON writes null for what is not a number.
        broken = {"energy_error": {"value": None, "resolved": 0.01, "marginal": 0.05, "verdict": "under-resolved"}}
        self.assertIn("energy_error no number", resolution_of({"resolution": {"verdict": "under-resolved", "figures": broken}}).worst_figure)

    def test_headlines(self):
        self.assertEqual(headline(["under-resolved", "marginal", "under-resolved", "marginal"]), "2 of 4 cases are under-resolved, 2 are marginal; none resolved.")
        self.assertEqual(headline(["resolved", "failed", ""]), "1 of 3 cases failed, 1 has no verdict; 1 resolved.")
        self.assertEqual(headline(["resolved"] * 3), "All 3 cases are resolved.")

    def test_markers(self):
        from tread_post.style import figure_grid

        axis = figure_grid(1, 1)[1][0, 0]
        plot_verdicts(axis, [1, 2, 3, 4], [1, 2, 3, 4], np.array(["resolved", "marginal", "under-resolved", "failed"], object), "#0072B2",
                      np.array([False, True, False, True]))
        drawn = [(line.get_marker(), line.get_markerfacecolor(), line.get_xdata().tolist()) for line in axis.get_lines() if len(line.get_xdata())]
        self.assertEqual(drawn, [("o", "#0072B2", [1]), ("o", "white", [2]), ("x", "#0072B2", [3]), ("o", "none", [2])])
        labels = [handle.get_label() for handle in verdict_handles(["resolved", "under-resolved", "failed"])]
        self.assertEqual(labels, ["resolved: 1", "marginal: 0", "under-resolved: 1", "failed, not drawn: 1", "ring: not steady, or not done"])


class WongReeceTest(unittest.TestCase):
    def check(self, wheel, soil, slip, sinkage, pull, torque):
        found = predict(wheel, soil, slip)
        # References are rounded to their last digit; the integrals converge to far less.
        for name, measured, expected, digit in (("sinkage (mm)", 1e3 * found.sinkage, sinkage, 0.1), ("pull (N)", found.drawbar_pull, pull, 0.1),
                                                ("torque (N m)", found.torque, torque, 0.1)):
            print(f"{soil.name}, {wheel.weight} N, slip {slip}: {name} {measured:.2f}, expected {expected} +- {digit}")
            self.assertLessEqual(abs(measured - expected), digit + 0.005 * abs(expected))

    def test_against_an_independent_integration(self):
        small, large = Wheel(0.13, 0.16, 130.0), Wheel(0.26, 0.33, 635.5)
        simulant, sand = PUBLISHED
        for slip, *expected in ((0.1, 28.6, 38.6, 10.3), (0.3, 30.7, 34.6, 10.2), (0.9, 42.4, 17.6, 10.1)):
            self.check(small, simulant, slip, *expected)
        for slip, *expected in ((0.1, 19.6, -10.7, 2.5), (0.9, 22.9, 18.1, 7.2)):
            self.check(small, sand, slip, *expected)
        self.check(large, simulant, 0.3, 68.7, 154, 99.4)
        self.check(large, sand, 0.3, 27.6, 84, 54.8)

    def test_too_heavy_for_the_soil(self):
        self.assertIsNone(predict(Wheel(0.13, 0.16, 1e7), PUBLISHED[1], 0.3))


class RunTest(unittest.TestCase):
    """From the made-up run: pull 40 N, torque 45 N m, 635 N on the wheel, noise of 6 N and 0.6 N m."""

    @classmethod
    def setUpClass(cls):
        directory = tempfile.TemporaryDirectory()
        cls.addClassCleanup(directory.cleanup)
        cls.path = Path(directory.name) / "run"
        make_run(cls.path)

    def test_answers(self):
        values, units = answers_of(Run(self.path))
        self.assertEqual(values["steady"], 1)
        for name, expected, tolerance in (("slip", 0.3, 1e-12), ("drawbar_pull", 40, 1e-9), ("torque", 45, 0.3), ("weight", 635, 3),
                                          ("sinkage", 0.03, 1e-4), ("speed", 0.7 * 0.7 * RADIUS, 1e-12),
                                          ("power_number", 45 * 0.7 / (635 * 0.7 * 0.7 * RADIUS), 3e-3)):
            self.assertLess(abs(values[name] - expected), tolerance, name)
        self.assertEqual((units["torque"], units["sinkage"]), ("N m", "m"))
        self.assertGreaterEqual(last_drive(Run(self.path)).time[0], 1.1)  # the ramp ends there

    def test_a_run_that_goes_on(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "run"
            shutil.copytree(self.path, path)
            (path / "summary.json").unlink()
            with h5py.File(path / "timeseries.h5", "a") as file:
                group = file["wheel/front wheel"]
                for name in list(group):
                    values, unit = group[name][:], group[name].attrs["units"]
                    del group[name]
                    # Rows of some columns only: the run is writing.
                    group[name] = values[: 100 if name != "slip" else 99]
                    group[name].attrs["units"] = unit
            self.assertAlmostEqual(answers_of(Run(path))[0]["drawbar_pull"], 40, 6)
            for name in ("wheel_history.py", "energy.py", "slices.py"):
                self.assertEqual(self.command(name, path).returncode, 0)

    def command(self, name, *options):
        done = subprocess.run([sys.executable, str(ROOT / "postprocess" / name), *map(str, options)], capture_output=True, text=True, timeout=240,
                              check=False)
        self.assertNotIn("Traceback", done.stderr)
        return done

    def test_pictures(self):
        for name, options in (("energy.py", (self.path,)), ("slices.py", (self.path,)), ("slices.py", (self.path, "--plane", "z", "--at", "0.145")),
                              ("compare.py", (self.path, self.path))):
            output = self.path.parent / f"{name}.png"
            done = self.command(name, *options, "--output", output)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.splitlines()[-1], str(output))
            self.assertGreater(colours_of(output), 20, name)

    def test_picture_of_sinkage_and_slip(self):
        """All rows of the run have one slip and one sinkage: a blue dot and a blue line of the legend, in a picture that is grey otherwise."""
        output = self.path.parent / "sinkage_slip.png"
        done = self.command("sinkage_slip.py", self.path, "--output", output)
        self.assertEqual(done.returncode, 0, done.stderr)
        picture = imread(output)[:, :, :3]
        blue = picture[:, :, 2] - picture[:, :, 0] > 0.3
        columns, rows = np.flatnonzero(blue.any(axis=0)), np.flatnonzero(blue.any(axis=1))
        self.assertGreater(blue.sum(), 50)
        self.assertGreater(np.diff(rows).max(), 100)  # the dot, far above the legend's line
        self.assertLess(columns.max(), 0.6 * picture.shape[1])

    def test_film(self):
        from PIL import Image

        output = self.path.parent / "film.gif"
        done = self.command("render.py", self.path, "--film", "--fps", "20", "--size", "400", "250", "--output", output)
        self.assertEqual(done.returncode, 0, done.stderr)
        with Image.open(output) as film:
            self.assertEqual(film.n_frames, 2)
            self.assertEqual(film.info["duration"], 50)
        refused = self.command("render.py", self.path, "--film", "--output", "film.avi")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("a film is written as .gif or .mp4", refused.stderr)
        self.assertTrue(np.allclose(render.rates([0.0, 0.5, 0.7], 10), [5, 2, 2]))

    def test_film_by_ffmpeg(self):
        output = self.path.parent / "film.mp4"
        done = self.command("render.py", self.path, "--film", "--size", "401", "250", "--output", output)
        if shutil.which("ffmpeg") is None:
            self.assertIn("MP4 wants ffmpeg", done.stderr)
            self.assertFalse(output.exists())
            return
        self.assertEqual(done.returncode, 0, done.stderr)
        shown = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream=codec_name,width,nb_frames", "-of", "csv=p=0", output],
                               capture_output=True, text=True).stdout.strip()
        self.assertEqual(shown, "h264,400,11")  # two pictures, the last for a second

    def test_sections(self):
        run = Run(self.path)
        bodies = run.bodies(7)
        cut = outline_of(bodies, run.shapes, 1, 0.25)
        wheel = cut[np.abs(np.linalg.norm(cut[:, :, (0, 2)] - bodies.position[0, (0, 2)], axis=2) - RADIUS).max(axis=1) < 3e-3 * RADIUS]
        # The rim of 48 corners, each side of it cut once more by its diagonal.
        self.assertEqual(len(wheel), 96)
        self.assertAlmostEqual(np.linalg.norm(wheel[:, 0] - wheel[:, 1], axis=1).sum(), 2 * np.pi * RADIUS, 2)
        self.assertTrue(np.allclose(cut[:, :, 1], 0.25))
        sand = run.points(0).position[slices.slice_of(run.points(0), 1, 0.255, 0.01)]
        self.assertEqual(len(sand), 100 * round(SURFACE / 0.01))

    def test_comparison(self):
        self.assertIn("all rows agree to the bit", self.command("compare.py", self.path, self.path, "--output", self.path / "c.png").stdout)
        one = {"a": 1, "m": [{"name": "sand", "x": 1}, {"name": "rock", "x": 2}]}
        other = {"a": 1, "m": [{"name": "rock", "x": 3}, {"name": "sand", "x": 1}], "b": [1]}
        self.assertEqual(compare.differences(one, other), ["m.rock.x: 2 | 3", "b: absent | [1]"])

    def test_errors_name_what_is_wrong(self):
        for name, options, words in (
            ("slip_curves.py", (self.path,), "no campaign.h5; `jobs/campaign.py collect` writes it"),
            ("campaign_report.py", (self.path,), "no campaign.h5"),
            ("slices.py", (self.path, "--snapshots", "3"), "no sand in snapshot 3; this run has 0 to 7"),
            ("energy.py", (self.path / "absent",), "no scene.toml"),
            ("compare.py", (self.path, self.path / "absent"), "no scene.toml"),
        ):
            done = self.command(name, *options)
            self.assertEqual(done.returncode, 1)
            self.assertIn(words, done.stderr)


class CampaignPagesTest(unittest.TestCase):
    """Two terrains at four slips; one case failed, its words are not HTML; one never became steady."""

    @classmethod
    def setUpClass(cls):
        directory = tempfile.TemporaryDirectory()
        cls.addClassCleanup(directory.cleanup)
        cls.path = Path(directory.name)
        slips, count = [0.0, 0.3, 0.6, 0.9] * 2, 8
        for number in range(count):
            case = cls.path / "cases" / f"{number:04}"
            case.mkdir(parents=True)
            (case / "scene.toml").write_text(SCENE, encoding="utf-8")
            if number < 3:  # the others left no snapshots
                make_run(case / "run")
        failed = [float(number == 5) for number in range(count)]
        column = lambda values: [np.nan if bad else value for value, bad in zip(values, failed)]  # noqa: E731
        answers = {"steady": (column([1.0] * 7 + [0.0]), "1"), "steady_from": (column([1.5] * count), "s")}
        for name, unit, scale in (("slip", "1", 1), ("drawbar_pull", "N", 100), ("torque", "N m", 50), ("sinkage", "m", 0.05),
                                  ("power_number", "1", 2), ("weight", "N", 0), ("speed", "m/s", 0.1)):
            answers[name] = (column([scale * slip + (635 if name == "weight" else 0) for slip in slips]), unit)
            answers[f"{name}_spread"] = (column([0.05 * scale] * count), unit)
        axes = [{"name": "terrain", "unit": "1", "keys": ["scene"], "labels": ["sand", "rocks"]},
                {"name": "slip", "unit": "1", "keys": ["phase.drive.drive.slip"], "labels": ["0", "0.3", "0.6", "0.9"]}]
        write_campaign_table(cls.path / "campaign.h5", {
            "title": "Two terrains <at> four slips", "campaign": "title = 'x'", "axes": json.dumps(axes), "collected": "today",
            "cost": json.dumps({"gpu_hours": 0.0, "core_hours": 1.5})}, {
            "case": {"number": (list(range(count)), "1"), "state": (["failed" if bad else "done" for bad in failed], "1"),
                     "reason": (["exit 3: <script>alert(1)</script>" if bad else "1 s" for bad in failed], "1"),
                     "tail": (["a & b" if bad else "" for bad in failed], "1"),
                     # Of case 5, as if collected from a summary of before it failed.
                     "verdict": (["resolved", "marginal", "under-resolved", "", "resolved", "resolved", "under-resolved", "marginal"], "1"),
                     "worst_figure": (["", "", "contact_cells 2 (resolved from 20, marginal from 6)"] + [""] * 5, "1"),
                     "warning_text": (["", "gravity <up>"] + [""] * 5 + ["gravity <up>"], "1")},
            "labels": {"terrain": (["sand"] * 4 + ["rocks"] * 4, "1"), "slip": ([f"{slip:g}" for slip in slips], "1")},
            "axes": {"slip": (slips, "1")}, "answers": answers,
            "summary": {"wall_s": ([10.0] * count, "s"), "warnings": ([0.0, 1.0] + [0.0] * 5 + [1.0], "1"), "pull_error": ([0.18] * count, "1")},
            "provenance": {"version": (["0.1.0"] * count, "1")}})

    def test_curves(self):
        curves = slip_curves.curves_of(CampaignTable(self.path))
        self.assertEqual([(curve.name, curve.rows.tolist()) for curve in curves], [("sand", [0, 1, 2, 3]), ("rocks", [4, 6, 7])])
        self.assertEqual((curves[0].wheel.radius, curves[0].wheel.weight), (0.2, 635.0))

    @slow
    def test_pictures_and_page(self):
        for name in ("slip_curves.py", "drives.py", "sinkage_slip.py", "campaign_report.py"):
            output = self.path / (f"{name}.html" if "report" in name else f"{name}.png")
            done = subprocess.run([sys.executable, str(ROOT / "postprocess" / name), str(self.path), "--output", str(output)],
                                  capture_output=True, text=True, timeout=240, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            if output.suffix == ".png":
                self.assertGreater(colours_of(output), 20)
        page = output.read_text(encoding="utf-8")
        self.assertIn("8 cases: 7 done, 1 failed", page)
        self.assertIn("exit 3: &lt;script&gt;", page)
        self.assertNotIn("<script", page)
        self.assertEqual(page.count("data:image/png;base64,"), 5)  # curves, drives, sinkage, two sections
        # Self-contained: nothing is loaded from anywhere.
        self.assertEqual(re.findall(r"(?:src|href)=\"(?!data:)", page), [])
        self.assertIn("15.0 ± 2.5", page)  # mm
        self.assertIn("6 of 7 drives became steady", page)
        self.check_verdicts(page)

    def check_verdicts(self, page):
        # The first thing under the title; the first table; rows of their own kind; warnings once, with their cases.
        self.assertIn('</h1>\n<p class="headline">2 of 8 cases are under-resolved, 2 are marginal, 1 failed, 1 has no verdict; 2 resolved.</p>', page)
        first = page[page.index("<table>"):page.index("</table>")]
        rows = first.split("<tr")[2:]
        self.assertEqual([next(word for word in ("under-resolved", "marginal", "resolved", "failed", "no verdict") if f">{word}</td>" in row.replace(
            ">failed</td>", "", 1)) for row in rows],
            ["resolved", "marginal", "under-resolved", "no verdict", "resolved", "failed", "under-resolved", "marginal"])
        self.assertIn("contact_cells 2 (resolved from 20, marginal from 6)", first)
        self.assertIn("pull error (estimated)", first)
        self.assertEqual(len(re.findall(r'<tr class="under-resolved">', first)), 2)
        self.assertIn("<p>gravity &lt;up&gt; (0001, 0007)</p>", page)

    @slow
    def test_a_table_of_before_verdicts(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(self.path / "cases", Path(folder) / "cases")
            shutil.copy(self.path / "campaign.h5", folder)
            with h5py.File(Path(folder) / "campaign.h5", "a") as file:
                for name in ("verdict", "worst_figure", "warning_text"):
                    del file[f"case/{name}"]
            table = CampaignTable(folder)
            self.assertEqual(table.verdicts.tolist(), [""] * 5 + ["failed"] + [""] * 2)
            page = campaign_report.report_of(table)
            self.assertIn("This table is older than verdicts", page)
            self.assertIn("1 of 8 cases failed, 7 have no verdict; none resolved.", page)

    def test_tables_of_other_schemas(self):
        for version, words in (((2, 0), "read here is"), (None, "schema None")):
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "campaign.h5"
                shutil.copy(self.path / "campaign.h5", path)
                with h5py.File(path, "a") as file:
                    if version:
                        file.attrs["schema_version"] = version
                    else:
                        del file.attrs["schema"]
                with self.assertRaisesRegex(RunError, words):
                    CampaignTable(folder)


if __name__ == "__main__":
    unittest.main()
