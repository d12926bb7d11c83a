#!/usr/bin/python3
"""What a run has written so far is read and drawn while it goes on, and it does not mind."""

import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

from campaign_fixture import ROOT, TREAD, TWIN

sys.path.insert(0, str(ROOT / "postprocess"))

from tread_post import Run  # noqa: E402
from tread_post.answers import answers_of  # noqa: E402

# Ends when it is told to.
SETTINGS = {"phase.settle.max_duration": 0.01, "phase.lower.max_duration": 0.03, "phase.drive.duration": 1000, "phase.drive.drive.ramp": 0.01, "phase.drive.drive.angular_velocity": 0.2,
            "output.every": 0.001, "output.snapshots_every": 0.02}


class RunningTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tread-running-")
        self.addCleanup(directory.cleanup)
        self.path = Path(directory.name) / "run"
        command = [TREAD, "run", TWIN, "--output", self.path, "--backend", "cpu", "--threads", "1", "--quiet"]
        command += [f"--set={key}={value}" for key, value in SETTINGS.items()]
        self.process = subprocess.Popen(command)
        self.addCleanup(self.process.kill)

    def wait_for_rows(self, count):
        while not (self.path / "timeseries.h5").exists() or len(Run(self.path).wheel("wheel")["time"]) < count:
            self.assertIsNone(self.process.poll())
            time.sleep(0.1)

    def test_read_and_drawn_while_it_runs(self):
        self.wait_for_rows(100)
        run, lengths = Run(self.path), []
        while len(lengths) < 50 or lengths[-1] == lengths[0]:  # rows come in blocks, and a loaded machine is slow to write one
            self.assertIsNone(self.process.poll())
            wheel = run.wheel("wheel")
            lengths.append(len(wheel["time"]))
            self.assertTrue((np.diff(wheel["time"]) > 0).all())
            self.assertTrue((np.diff(run.energy["time"]) > 0).all())
            self.assertEqual(len(run.points(run.snapshots[0]).position), 2880)
        self.assertAlmostEqual(answers_of(run)[0]["slip"], 0.3, 5)
        for name in ("wheel_history.py", "energy.py", "slices.py"):
            done = subprocess.run([sys.executable, str(ROOT / "postprocess" / name), str(self.path)], capture_output=True, text=True, timeout=240, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIsNone(self.process.poll())
        self.process.send_signal(signal.SIGTERM)
        self.assertEqual(self.process.wait(timeout=60), 75)


if __name__ == "__main__":
    unittest.main()
