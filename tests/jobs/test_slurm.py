#!/usr/bin/python3
"""A small campaign on a real SLURM: an array runs, one task is cancelled in flight, retry completes it, collect has all rows."""

import subprocess

import slurm_session
from campaign_fixture import CAMPAIGN, CampaignTest

# Two short cases and a long one, which can be cancelled while it runs: two cores take them side by side.
THREE = CAMPAIGN.partition("[[axis]]")[0].replace('"phase.drive.duration"      = 0.05\n', "") + """
[[axis]]
keys   = ["phase.drive.duration", "phase.drive.drive.slip"]
values = [[0.05, 0.1], [0.05, 0.5], [1.0, 0.3]]
labels = ["short", "slipping", "long"]
name   = "drive"

[resources]
wall_time = "00:10:00"
"""


class SlurmTest(CampaignTest):
    def test_an_array_a_cancelled_task_and_retry(self):
        self.file.write_text(THREE, encoding="utf-8")
        job = self.campaign("submit").stdout.split()[-1]
        began = self.output / "cases" / "0002" / "run" / "timeseries.h5"
        slurm_session.wait_until(began.exists, 240, "the long case began")
        self.assertRegex(self.campaign("status").stdout, "0002  running")
        subprocess.run(["scancel", f"{job}_2"], check=True)
        slurm_session.wait_until(lambda: not slurm_session.tasks(), 240, "the queue is empty")
        self.assertIn("2 done, 1 stopped", self.campaign("status").stdout)
        self.assertRegex(self.campaign("retry").stdout, "1 cases in 1 tasks")
        self.assertRegex(self.campaign("status").stdout, "0002  (queued|running)")
        slurm_session.wait_until(lambda: not slurm_session.tasks(), 240, "the queue is empty")
        self.assertIn("3 done", self.campaign("status").stdout)
        self.campaign("collect")
        rows = (self.output / "campaign.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual([row.split(",")[1] for row in rows], ["state", "done", "done", "done"])


if __name__ == "__main__":
    slurm_session.main()
