#!/usr/bin/python3
"""Jobs on a real SLURM: an array runs, one task is cancelled in flight, retry completes it, collect has all rows; a scene by itself stops, is
requeued and goes on."""

import csv
import json
import os
import pathlib
import subprocess

import slurm_session
from campaign_fixture import CAMPAIGN, ROOT, TREAD, CampaignTest

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
        slurm_session.wait_for_empty_queue(240)
        self.assertIn("2 done, 1 stopped", self.campaign("status").stdout)
        self.assertRegex(self.campaign("retry").stdout, "1 cases in 1 tasks")
        self.assertRegex(self.campaign("status").stdout, "0002  (queued|running)")
        slurm_session.wait_for_empty_queue(240)
        self.assertIn("3 done", self.campaign("status").stdout)
        self.campaign("collect")
        with (self.output / "campaign.csv").open(encoding="utf-8", newline="") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual([row["state"] for row in rows], ["done", "done", "done"])
        self.assertEqual([row["axis_drive"] for row in rows], ["short", "slipping", "long"])

    def test_one_scene_as_one_job(self):
        self.file.write_text(THREE, encoding="utf-8")
        self.campaign("expand")
        summary = self.directory / "run" / "summary.json"
        job = self.run_sbatch()
        slurm_session.wait_until((self.directory / "run" / "timeseries.h5").exists, 240, "the run began")
        # As the time limit does.
        subprocess.run(["scancel", "--batch", "--signal=USR2", job], check=True)
        slurm_session.wait_until(lambda: slurm_session.tasks().get(job) == "PENDING", 120, "the job was requeued")
        self.assertEqual(json.loads(summary.read_text())["exit_code"], 75)
        # A requeued job waits for two minutes unless it is told otherwise; within a second the node would still take it for the job that ended.
        subprocess.run(["scontrol", "update", f"jobid={job}", "starttime=now+5"], check=True)
        slurm_session.wait_for_empty_queue(240)
        done = json.loads(summary.read_text())
        self.assertEqual((done["status"], done["restarts"]), ("finished", 1))

        again = self.run_sbatch()
        slurm_session.wait_for_empty_queue(120)
        self.assertEqual(json.loads(summary.read_text()), done)
        self.assertIn("finished", (self.directory / f"slurm-{again}.out").read_text())

    def run_sbatch(self):
        """The job's number."""
        here = ["--ntasks-per-node=1", "--cpus-per-task=1", "--gpus-per-node=0", "--time=00:10:00"]
        scene = self.output / "cases" / "0002" / "scene.toml"
        done = subprocess.run(["sbatch", "--parsable", *here, ROOT / "jobs" / "run.sbatch", scene, "run"], cwd=self.directory, text=True,
                              env={**os.environ, "PATH": f"{pathlib.Path(TREAD).parent}:{os.environ['PATH']}"}, capture_output=True, check=True)
        return done.stdout.strip()


if __name__ == "__main__":
    slurm_session.main()
