#!/usr/bin/python3
"""Twelve cases of slip and gravity on a real SLURM. One is cancelled in flight, one hits its time limit and is requeued, one is killed;
retry completes them, each from its last checkpoint, collect gives twelve rows, and the report of it all is one page."""

import csv
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import slurm_session
from campaign_fixture import CAMPAIGN, ROOT, CampaignTest

GRAVITIES = {"Moon": 1.62, "Mars": 3.72, "Earth": 9.81}
SLIPS = (0.0, 0.3, 0.6, 0.9)
# In the order in which they begin. They run long enough to be met.
KILLED, CANCELLED, LATE = ("Moon", 0.6), ("Mars", 0.3), ("Earth", 0.9)
SECONDS = {KILLED: 2.0, CANCELLED: 2.0, LATE: 2.0}  # of drive; 0.05 for all others


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

    def program_of(self, which):
        """Process of the program that computes a case."""
        script = re.findall(r" start .* pid (\d+)$", (self.case(which) / "attempts.log").read_text(), re.MULTILINE)[-1]
        child = subprocess.run(["ps", "--ppid", script, "-o", "pid=,comm="], capture_output=True, text=True, check=True).stdout
        return int(re.search(r"(\d+) tread", child)[1])

    def wait_for_checkpoint(self, which):
        checkpoints = self.case(which) / "run" / "checkpoints"
        slurm_session.wait_until(lambda: list(checkpoints.glob("*.h5")), 240, f"case {which} wrote a checkpoint")

    def delay_until_the_limit(self, which):
        """Keeps a run from computing until it has been told that its time is up, however fast the machine is."""
        program = self.program_of(which)
        os.kill(program, signal.SIGSTOP)
        try:
            slurm_session.wait_until(lambda: is_pending(program, signal.SIGUSR2), 150, "the time limit was told")
        finally:
            os.kill(program, signal.SIGCONT)

    def test_twelve_cases(self):
        job = self.campaign("submit").stdout.split()[-1]
        self.wait_for_checkpoint(KILLED)
        os.kill(self.program_of(KILLED), signal.SIGKILL)  # as the kernel does where memory runs out
        self.wait_for_checkpoint(CANCELLED)
        subprocess.run(["scancel", f"{job}_{self.cases.index(CANCELLED)}"], check=True)
        self.wait_for_checkpoint(LATE)
        self.delay_until_the_limit(LATE)
        slurm_session.wait_for_empty_queue(900)

        done = self.campaign("status", code=3).stdout
        print(done)
        self.assertIn("10 done, 1 stopped, 1 failed", done)
        self.assertRegex(done, rf"{self.cases.index(KILLED):04}  failed .*killed by SIGKILL")
        self.assertRegex((self.case(LATE) / "attempts.log").read_text(), "(?s)code 75\n.* start .*code 0\n$")

        self.assertRegex(self.campaign("retry").stdout, "2 cases in 2 tasks")
        slurm_session.wait_for_empty_queue(900)
        self.assertIn("12 done", self.campaign("status").stdout)
        self.campaign("collect")
        with open(self.output / "campaign.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        restarted = [case for case, row in zip(self.cases, rows) if float(row["restarts"]) >= 1]
        self.assertEqual((len(rows), restarted), (12, [KILLED, CANCELLED, LATE]))
        report = [sys.executable, str(ROOT / "postprocess" / "campaign_report.py"), str(self.output)]
        subprocess.run(report, check=True, timeout=240)
        self.assertIn("12 done", (self.output / "report.html").read_text(encoding="utf-8"))


def is_pending(process, number):
    """Whether a signal waits for a process to run on."""
    masks = re.findall(r"^(?:SigPnd|ShdPnd):\t([0-9a-f]+)$", Path(f"/proc/{process}/status").read_text(), re.MULTILINE)
    return any(int(mask, 16) >> (number - 1) & 1 for mask in masks)


if __name__ == "__main__":
    slurm_session.main()
