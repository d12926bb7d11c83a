#!/usr/bin/python3
"""jobs/campaign.py beside files that are damaged: one bad case is one failed row, and ends no command."""

import csv
import io
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from campaign_fixture import ROOT, CampaignTest

sys.path[:0] = [str(ROOT / "jobs"), str(ROOT / "postprocess")]

from made_up_run import RESOLUTION, make_run  # noqa: E402
from tread_jobs.files import number_of, printable, write_text  # noqa: E402
from tread_post import Run, RunError  # noqa: E402

SUMMARY = {"status": "finished", "wall_s": 1.5, "steps": 100, "errors": {"mass": 1e-12}, "resolution": RESOLUTION, "warnings": ["gravity points up"]}
HOW = {"means": "local", "site": "", "at_once": 2, "gpus": 0}


class Files(unittest.TestCase):
    def test_what_cannot_be_written_leaves_the_old_text(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "submission.json"
            write_text(path, "old")
            with self.assertRaises(UnicodeEncodeError):
                write_text(path, "new" * 10000 + "\ud800")
            self.assertEqual([(file.name, file.read_text()) for file in path.parent.iterdir()], [("submission.json", "old")])

    def test_texts_and_numbers(self):
        self.assertEqual(printable("a\x1b[2J\x00\ud800\tb\n\u00e9"), "a\ufffd[2J\ufffd\ufffd\tb\n\u00e9")
        self.assertEqual((printable(None), number_of(3), number_of(None) != number_of(None)), ("None", 3.0, True))
        for value in ("fast", [1.0], {}, "1"):
            self.assertRaises(TypeError, number_of, value)


class Runs(unittest.TestCase):
    def test_what_is_no_text_is_an_error_of_the_run(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            for name in ("scene.toml", "summary.json"):
                (path / name).write_bytes(b"\xff")
            for read, words in ((lambda: Run(path).scene, "scene.toml: .*utf-8"), (lambda: Run(path).summary, "summary.json: .*utf-8")):
                self.assertRaisesRegex(RunError, words, read)


class Damage(CampaignTest):
    """Four cases that are done."""

    @classmethod
    def setUpClass(cls):
        directory = tempfile.TemporaryDirectory()
        cls.addClassCleanup(directory.cleanup)
        cls.run_directory = pathlib.Path(directory.name) / "run"
        make_run(cls.run_directory)

    def setUp(self):
        super().setUp()
        self.campaign("expand", program=self.checked_only())
        for number in range(4):
            shutil.copytree(self.run_directory, self.run_of(number), ignore=None if number == 0 else shutil.ignore_patterns("snapshots"))
            self.summary(number, SUMMARY)
            (self.case(number) / "attempts.log").write_text("T start job local_0 host elsewhere pid 1\nT end job local_0 host elsewhere pid 1 code 0\n")
        self.submission("0001", json.dumps(HOW))

    def case(self, number):
        return self.output / "cases" / f"{number:04}"

    def run_of(self, number):
        return self.case(number) / "run"

    def summary(self, number, summary):
        (self.run_of(number) / "summary.json").write_text(json.dumps(summary), encoding="utf-8")

    def submission(self, name, record):
        folder = self.output / "submissions" / name
        folder.mkdir(parents=True)
        (folder / "tasks.txt").write_text("0000\n0001\n0002\n0003\n", encoding="utf-8")
        (folder / "submission.json").write_text(record, encoding="utf-8")
        return folder

    def states(self, code=0):
        lines = self.campaign("status", code=code).stdout.splitlines()
        return [line.split("  ")[1].strip() for line in lines if line[:4].isdigit()]

    def rows(self):
        return list(csv.DictReader(io.StringIO(self.campaign("collect", "--dry-run").stdout)))

    def collected(self):
        self.campaign("collect")
        with open(self.output / "campaign.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def report(self):
        done = subprocess.run([sys.executable, str(ROOT / "postprocess" / "campaign_report.py"), str(self.output)], capture_output=True, text=True,
                              timeout=240, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.output / "report.html").read_text(encoding="utf-8")

    def check_one_failed_row(self, rows, number, words):
        self.assertEqual([row["state"] for row in rows], ["failed" if row == number else "done" for row in range(4)])
        self.assertRegex(rows[number]["reason"], words)
        self.assertEqual((rows[number]["verdict"], rows[number]["torque [N m]"]), ("failed", ""))
        for row in rows[:number] + rows[number + 1:]:
            self.assertEqual((row["verdict"], row["wall_s [s]"], row["steps"], row["warnings"]), ("under-resolved", "1.5", "100", "1"))
            self.assertAlmostEqual(float(row["torque [N m]"]), 45, 0)

    def test_an_empty_record_of_a_submission(self):
        self.submission("0002", "")
        self.assertEqual(self.states(), ["done"] * 4)
        self.assertEqual(len(self.rows()), 4)
        (self.case(1) / "attempts.log").unlink()
        # Means and their numbers are those of the last record that can be read.
        self.assertRegex(self.campaign("retry", "--dry-run", program=self.checked_only()).stdout, "1 cases in 1 tasks: .*/submissions/0003\n")
        for record in ("", "[1]", '{"means": "local"}', "[" * 100000):
            (self.output / "submissions/0001/submission.json").write_text(record, encoding="utf-8")
            self.assertIn("0002/submission.json: cannot be read", self.campaign("retry", program=self.checked_only(), code=2).stderr)
            self.assertIn("submitted before", self.campaign("local", program=self.checked_only(), code=2).stderr)

    def test_what_a_user_lays_beside_submissions(self):
        for name in ("0001.bak", "1 (copy)", "notes"):
            shutil.copytree(self.output / "submissions/0001", self.output / "submissions" / name)
        (self.output / "submissions/0007").touch()
        self.assertEqual(self.states(), ["done"] * 4)
        (self.case(1) / "attempts.log").unlink()
        self.assertIn("/submissions/0002\n", self.campaign("retry", "--dry-run", program=self.checked_only()).stdout)

    def test_bytes_that_are_no_text(self):
        log = self.case(1) / "attempts.log"
        log.write_bytes(b"\xff\xfe\x00\n" + log.read_bytes())
        (self.output / "submissions/0001/tasks.txt").write_bytes(b"\xff\n")
        (self.run_of(2) / "summary.json").write_bytes(b'\xff{"status": "finished"}')
        self.assertEqual(self.states(code=3), ["done", "done", "failed", "done"])
        self.check_one_failed_row(self.rows(), 2, "summary.json cannot be read")

    def test_a_series_that_is_empty_or_cut_short(self):
        series = self.run_of(1) / "timeseries.h5"
        whole = series.read_bytes()
        for text in (b"", whole[:51], whole[:-1], b"x" * len(whole)):
            series.write_bytes(text)
            self.assertEqual(self.states(code=3), ["done", "failed", "done", "done"])
        self.check_one_failed_row(self.collected(), 1, "finished, but run/timeseries.h5 is no whole HDF5 file")
        page = self.report()
        self.assertIn("4 cases: 3 done, 1 failed", page)
        self.assertIn("run/timeseries.h5 is no whole HDF5 file", page)

    def test_a_series_that_is_damaged_within(self):
        series = self.run_of(3) / "timeseries.h5"
        whole = series.read_bytes()
        series.write_bytes(whole[:96] + bytes(len(whole) - 96))
        self.assertEqual(self.states(), ["done"] * 4)  # what `status` can tell without h5py
        self.check_one_failed_row(self.collected(), 3, "cannot be read: ")
        self.assertIn("4 cases: 3 done, 1 failed", self.report())

    def test_a_summary_of_other_types(self):
        for wrong in ({"wall_s": "fast"}, {"steps": 10**400}, {"errors": [1, "mass"]}, {"resolution": "fine"}, {"warnings": 3},
                      {"resolution": {"verdict": ["resolved"]}},
                      {"resolution": {"figures": {"pull_error": {"verdict": "marginal", "value": 0.1, "resolved": "low", "marginal": 1}}}}):
            with self.subTest(wrong=wrong):
                self.summary(2, SUMMARY | wrong)
                self.check_one_failed_row(self.rows(), 2, "cannot be read: summary.json: ")

    def test_texts_that_a_terminal_or_hdf5_does_not_take(self):
        self.summary(0, SUMMARY | {"version": "1\x1b[2J\x00\ud800", "warnings": ["\x00"]})
        (self.case(1) / "attempts.log").write_text("T end job local_0 host elsewhere pid 1 code 3\n")
        self.summary(1, {"status": "failed", "exit_code": 3, "reason": "a\x1b[2J\ud800"})
        (self.case(1) / "output.txt").write_bytes(b"\x1b]0;title\x07 \xff\n")
        (self.case(2) / "attempts.log").write_text("T start job local_0 host e\x1b[2Jvil pid 1\n")
        done = self.campaign("status", code=3)
        self.assertIn("(on e\ufffd[2Jvil)", done.stdout)
        self.assertIn("exit 3: a\ufffd[2J\ufffd", done.stdout)
        self.assertNotIn("\x1b", done.stdout)
        self.assertEqual(self.collected()[0]["version"], "1\ufffd[2J\ufffd\ufffd")
        self.assertNotIn("\x1b", self.report())

    def test_damage_after_the_table_was_collected(self):
        self.campaign("collect")
        (self.run_of(0) / "snapshots/bodies_0007.h5").write_bytes(b"")
        (self.run_of(1) / "timeseries.h5").write_bytes(b"")
        (self.run_of(2) / "scene.toml").write_bytes(b"\xff = ")
        page = self.report()
        self.assertRegex(page, "Case 0000 cannot be drawn: .*bodies_0007.h5")
        self.assertEqual(page.count("data:image/png;base64,"), 3)  # curves, drives of the two others, sinkage


if __name__ == "__main__":
    unittest.main()
