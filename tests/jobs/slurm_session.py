"""Tests beside a real SLURM: the script starts itself again inside ci/slurm, and asks squeue and scontrol of that."""

import os
import pathlib
import subprocess
import sys
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
INSIDE = "TREAD_TEST_SLURM"


def main():
    """Runs the tests of the calling script inside ci/slurm."""
    if INSIDE in os.environ:
        unittest.main()
    command = [ROOT / "ci" / "slurm", sys.executable, *sys.argv]
    sys.exit(subprocess.run(command, env={**os.environ, INSIDE: "yes"}, check=False).returncode)


def tasks():
    """State of each task that waits or runs, by "job_task"."""
    done = subprocess.run(["squeue", "--noheader", "--array", "--format=%i %T"], capture_output=True, text=True, check=True)
    return dict(line.split() for line in done.stdout.splitlines())


def wait_until(holds, seconds, what):
    """Asks every half second."""
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            raise AssertionError(f"{what}: not within {seconds} s; {tasks()}")
        time.sleep(0.5)


def wait_for_empty_queue(seconds):
    """Empty for two seconds: between its lives a job that is requeued is unknown for a moment."""
    looks = []

    def stays_empty():
        looks.append(not tasks())
        return len(looks) >= 4 and all(looks[-4:])

    wait_until(stays_empty, seconds, "the queue is empty")
