#!/usr/bin/python3
"""Twelve cases of slip and gravity on a real SLURM. One is cancelled in flight, one hits its time limit and is requeued, one is killed;
retry completes them, collect gives twelve rows, and the report of it all is one page."""

import os
import re
import signal
import subprocess
import sys

import slurm_session
from campaign_fixture import CAMPAIGN, ROOT, CampaignTest

GRAVITIES = {"Moon": 1.62, "Mars": 3.72, "Earth": 9.81}
SLIPS = (0.0, 0.3, 0.6, 0.9)
# What is cancelled and what is killed runs long enough to be met; what hits the limit, longer than a task may.
CANCELLED, KILLED, LONG = ("Mars", 0.3), ("Moon", 0.6), ("Earth", 0.9)
SECONDS = {CANCELLED: 1.0, KILLED: 1.0, LONG: 9.0}  # of drive; 0.05 for all others


def campaign():
    """All twelve as one axis of linked keys, so that durations differ."""
    cases = [(gravity, slip) for gravity in GRAVITIES for slip in SLIPS]
    values = [[slip, [0.0, 0.0, -GRAVITIES[gravity]], SECONDS.get((gravity, slip), 0.05)] for gravity, slip in cases]
    labels = [f"{gravity}, {slip}" for gravity, slip in cases]
    head = CAMPAIGN.partition("[[axis]]")[0].replace('"phase.drive.duration"      = 0.05\n', '"checkpoint.every_time" = 0.1\n')
    # Of the minute that a task has, runs get 5 to 35 s: SLURM looks at limits every half minute.
    return cases, head + f"""
[[axis]]
keys   = ["phase.drive.drive.slip", "domain.gravity", "phase.drive.duration"]
name   = "case"
values = {values}
labels = {labels}

[resources]
wall_time   = "00:01:00"
signal_lead = 25
restarts    = 20
"""


class SlurmCampaignTest(CampaignTest):
    def setUp(self):
        super().setUp()
        self.cases, text = campaign()
        self.file.write_text(text, encoding="utf-8")

    def case(self, which):
        return self.output / "cases" / f"{self.cases.index(which):04}"

    def kill(self, which):
        """kill -9 of the program of a case, as the kernel does where memory runs out."""
        script = int(re.search(r"pid (\d+)$", (self.case(which) / "attempts.log").read_text().splitlines()[0])[1])
        child = subprocess.run(["ps", "--ppid", str(script), "-o", "pid=,comm="], capture_output=True, text=True, check=True).stdout
        os.kill(int(re.search(r"(\d+) tread", child)[1]), signal.SIGKILL)

    def began(self, which):
        return lambda: (self.case(which) / "run" / "timeseries.h5").exists()

    def test_twelve_cases(self):
        program = os.environ["TREAD"]
        job = self.campaign("submit", program=program).stdout.split()[-1]
        # In the order in which they begin.
        slurm_session.wait_until(self.began(KILLED), 120, "the case to kill began")
        self.kill(KILLED)
        slurm_session.wait_until(self.began(CANCELLED), 120, "the case to cancel began")
        subprocess.run(["scancel", f"{job}_{self.cases.index(CANCELLED)}"], check=True)
        slurm_session.wait_until(lambda: not slurm_session.tasks(), 1500, "the queue is empty")

        done = self.campaign("status", code=3).stdout
        print(done)
        self.assertIn("10 done, 1 stopped, 1 failed", done)
        self.assertRegex(done, rf"{self.cases.index(KILLED):04}  failed .*killed by SIGKILL")
        attempts = (self.case(LONG) / "attempts.log").read_text()
        self.assertGreaterEqual(attempts.count("end code 75"), 1, "the long case stopped for the limit and came back by itself")

        self.campaign("retry", program=program)
        slurm_session.wait_until(lambda: not slurm_session.tasks(), 300, "the queue is empty")
        self.assertIn("12 done", self.campaign("status").stdout)
        self.campaign("collect")
        self.assertEqual(len((self.output / "campaign.csv").read_text(encoding="utf-8").splitlines()), 13)
        report = [sys.executable, str(ROOT / "postprocess" / "campaign_report.py"), str(self.output)]
        subprocess.run(report, check=True, timeout=240)
        self.assertIn("12 done", (self.output / "report.html").read_text(encoding="utf-8"))


if __name__ == "__main__":
    slurm_session.main()
