#!/usr/bin/env python3
"""Calls that go wrong on purpose, one a run: whatever it was, a restart ends with the same bits, and a run that ends early says why.

TREAD_FAULT_POINTS: calls of each kind that are tried, evenly spread over a run, or "all"; on several ranks that many over their
number, as runs that end there take their time. Prints what became of them.
"""

import collections
import os
import shutil
import signal
import subprocess
import unittest

from command import SCENE, TREAD
from restart_test import BACKEND, MIXED, MPIRUN, RestartTest, lasting

FAULTS = os.environ["TREAD_FAULTS"]  # tests/faults
POINTS = os.environ.get("TREAD_FAULT_POINTS", "10")
TEXT = lasting(MIXED, 0.05)
OPTIONS = ("--backend", BACKEND, "--threads", "1", "--set=checkpoint.every_steps=20", "--set=checkpoint.keep=2")
LONGEST = 200  # s that a run may take on a machine that does other things too; alone it takes one, or 30 where ranks wait


def chosen(calls, ranks):
    """Which of so many calls go wrong."""
    wanted = calls if POINTS == "all" else min(int(POINTS) // ranks, calls)
    return sorted({1 + round(at * (calls - 1) / max(1, wanted - 1)) for at in range(wanted)})


class Faults(RestartTest):
    def start(self, fault, ranks, *options, rank=0):
        """The run with a fault, "KIND N"; None where it hung."""
        variables = {"LD_PRELOAD": FAULTS, "TREAD_FAULT": fault, "TREAD_FAULT_RANK": rank, "TREAD_FAULT_BELOW": self.output,
                     "TREAD_FAULT_COUNTS": self.directory / "counts.txt"}
        launcher = (*MPIRUN, "-n", ranks) if ranks > 1 else ()
        # A rank that fails within a collective call of HDF5 leaves the others there: what ends them is the time to wait.
        options = (*options, "--hang-timeout", "00:00:20") if ranks > 1 else options
        command = [*launcher, "env", *(f"{key}={value}" for key, value in variables.items()), TREAD, "run",
                   self.write("scene.toml", TEXT), "--output", self.output, *OPTIONS, *options]
        job = subprocess.Popen(list(map(str, command)), cwd=self.directory, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        try:
            out, err = job.communicate(timeout=LONGEST)
        except subprocess.TimeoutExpired:
            job.terminate()
            job.communicate()
            return None
        return subprocess.CompletedProcess(command, job.returncode, out, err)

    def calls(self, ranks, rank=0):
        """How many calls of each kind the whole run makes; it stays in `whole`."""
        shutil.rmtree(self.output, ignore_errors=True)
        (self.directory / "counts.txt").unlink(missing_ok=True)
        whole = self.start("write 0", ranks, rank=rank)
        self.assertEqual(whole.returncode, 0, whole.stderr)
        counts = collections.Counter()
        for line in (self.directory / "counts.txt").read_text().splitlines():
            kind, count = line.split()
            counts[kind] = max(counts[kind], int(count))  # children of the program add lines of their own
        shutil.rmtree(self.directory / "whole", ignore_errors=True)
        self.output.rename(self.directory / "whole")
        return counts

    def check_kind(self, kind, calls, ranks=1, rank=0):
        """Tries a kind's calls; prints how the runs ended."""
        ends = collections.Counter()
        tried = chosen(calls, ranks)
        self.assertTrue(tried, kind)
        for call in tried:
            with self.subTest(kind=kind, call=call, ranks=ranks):
                shutil.rmtree(self.output, ignore_errors=True)
                ended = self.start(f"{kind} {call}", ranks, rank=rank)
                ends["hung" if ended is None else self.end_of(ended, kind, ranks)] += 1
                self.assertIsNotNone(ended, "hung")
                again = self.start("write 0", ranks, "--restart", "auto", rank=rank)
                self.assertIsNotNone(again, "the restart hung")
                self.assertEqual(again.returncode, 0, again.stdout + again.stderr)
                self.assertNotIn("passed over", again.stderr)
                self.assert_same_end(ranks)
                ends["restarted to the same end"] += 1
        print(f"  {kind} on {ranks} ranks: {len(tried)} of {calls} calls: "
              + ", ".join(f"{count} {name}" for name, count in sorted(ends.items())), flush=True)

    def end_of(self, ended, kind, ranks):
        """How the run with the fault ended, in words. What ended early without being killed must say why."""
        if ended.returncode == 0:
            return "finished"
        if kind == "kill":
            self.assertTrue(ended.returncode == -signal.SIGKILL or ranks > 1, ended.stdout + ended.stderr)
            return "killed"
        if ended.returncode == 4:
            self.assertIn("tread: error: ", ended.stderr)
            return "refused with the cause"
        # Open MPI without memory may end the process by itself, before the program is there to speak.
        self.assertTrue(kind == "allocation" and "tread: error: " not in ended.stderr, f"code {ended.returncode}: {ended.stdout}{ended.stderr}")
        return f"ended by a library without memory (code {ended.returncode})"

    def assert_same_end(self, ranks):
        if ranks == 1:
            self.assert_same_bits(self.directory / "whole", self.output)
        else:  # sums over ranks keep no bits once the rank of a page may differ
            self.assertEqual(self.summary()["status"], "finished")
            self.assertEqual(self.summary()["steps"], self.summary(self.directory / "whole")["steps"])

    def test_files(self):
        calls = self.calls(1)
        for kind in ("write", "quota", "fsync", "rename", "open", "close", "truncate"):
            self.check_kind(kind, calls["write" if kind == "quota" else kind])

    def test_memory(self):
        self.check_kind("allocation", self.calls(1)["allocation"])

    @unittest.skipUnless(BACKEND == "cuda", "TREAD_TEST_BACKEND is not cuda")
    def test_gpu(self):
        calls = self.calls(1)
        for kind in ("launch", "device_memory"):
            self.check_kind(kind, calls[kind])

    def test_clock(self):
        for ranks in (1, 2):
            calls = self.calls(ranks, ranks - 1)
            for kind in ("clock", "clock_back"):
                self.check_kind(kind, calls[kind], ranks, ranks - 1)

    def test_messages_of_a_rank(self):
        for rank in (0, 1):
            self.check_kind("message", self.calls(2, rank)["message"], 2, rank)

    def test_kill_at_each_touch_of_a_file(self):
        for ranks in (1, 2, 3):
            self.check_kind("kill", self.calls(ranks)["kill"], ranks)


if __name__ == "__main__":
    unittest.main()
