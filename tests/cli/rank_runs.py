#!/usr/bin/env python3
"""Runs on several ranks, started as users start them."""

import json
import os
import pathlib
import signal
import subprocess
import time
import unittest

import h5py
import numpy

from command import BODY, MPIRUN, SCENE, TREAD, CommandTest


def column(path, name):
    with h5py.File(path / "timeseries.h5", "r") as file:
        return file[name][()]


def children(parent):
    """Process ids of its children that run tread."""
    found = []
    for status in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            name, fields = status.read_text().rsplit(")", 1)
        except OSError:
            continue  # it has ended
        if int(fields.split()[1]) == parent and name.endswith("(tread"):
            found.append(int(status.parent.name))
    return found


class Ranks(CommandTest):
    def run_on(self, ranks, *options, text=SCENE):
        scene = self.write("scene.toml", text)
        output = self.directory / f"ranks{ranks}"
        result = self.tread("run", scene, "--output", output, "--backend", "cpu", *options,
                            launcher=(*MPIRUN, "-n", str(ranks)))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return output, result

    def test_two_ranks_do_what_one_does(self):
        one, _ = self.run_on(1)
        two, result = self.run_on(2, "--checksums")
        self.assertEqual(result.stdout.count("phase 'rest' ends"), 1, result.stdout)
        log = (two / "log.txt").read_text()
        self.assertIn("transport: MPI", log)
        self.assertIn("partition: largest load", log)
        summary = json.loads((two / "summary.json").read_text())
        self.assertEqual((summary["ranks"], summary["points"]), (2, 8 * 8 * 2 * 8))
        self.assertTrue(next(stage for stage in summary["stages"] if stage["name"] == "halo")["calls"] > 0)
        for name in ("energy/total", "energy/strain", "balance/mass"):
            numpy.testing.assert_allclose(column(two, name), column(one, name), rtol=1e-5, err_msg=name)
        with h5py.File(two / "snapshots" / "points_0001.hdf", "r") as file:
            data = file["VTKHDF/PointData"]
            self.assertEqual(set(data["rank"][()]), {0, 1})
            self.assertEqual(sorted(data["id"][()]), list(range(8 * 8 * 2 * 8)))

    def test_a_wheel_on_sand_does_on_two_ranks_what_it_does_on_one(self):
        body = BODY.replace("0.3]", "0.165]") + "velocity = [0.0, 0.0, -0.8]\n"
        one, _ = self.run_on(1, text=SCENE + body)
        two, _ = self.run_on(2, text=SCENE + body)
        force = column(one, "wheel/roller/force")
        self.assertGreater(numpy.abs(force).max(), 1)
        numpy.testing.assert_allclose(column(two, "wheel/roller/force"), force, rtol=0, atol=1e-3 * numpy.abs(force).max())
        numpy.testing.assert_allclose(column(two, "wheel/roller/position"), column(one, "wheel/roller/position"), rtol=1e-6)
        numpy.testing.assert_allclose(column(two, "energy/total"), column(one, "energy/total"), rtol=1e-5)
        with h5py.File(two / "snapshots" / "bodies_0001.h5", "r") as file:
            self.assertEqual(file["position"].shape, (1, 3))

    def test_an_error_of_all_ranks_is_said_once(self):
        result = self.tread("run", self.directory / "missing.toml", launcher=(*MPIRUN, "-n", "3"))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("tread: error"), 1, result.stderr)

    def test_rocks_sleep_on_two_ranks_as_on_one(self):
        rocks = '[[rocks]]\nshape = "roller"\nmaterial = "steel"\ncount = 8\ndiameter = 0.06\nplacement = "rain"\n' \
            'region = { box = [[0.0, 0.0, 0.105], [0.4, 0.4, 0.18]] }\n'
        text = SCENE.replace("duration = 0.02", "duration = 0.1") + rocks + "[sleep]\nrock_speed = 0.5\nrock_rest = 0.01\n"
        one, two = (json.loads((self.run_on(ranks, text=text)[0] / "summary.json").read_text()) for ranks in (1, 2))
        print(f"  asleep on the mean: {two['rocks_asleep']:.6f}, on one rank {one['rocks_asleep']:.6f}; tolerance 1e-3: rounding moves a look")
        self.assertGreater(one["rocks_asleep"], 0.1)
        self.assertAlmostEqual(two["rocks_asleep"], one["rocks_asleep"], delta=1e-3)

    def test_an_error_of_one_rank_ends_the_job(self):
        scene = self.write("scene.toml", SCENE)
        run = (TREAD, "run", scene, "--output", self.output, "--backend", "cpu")
        other = (TREAD, "run", self.directory / "missing.toml")
        start = time.monotonic()
        result = subprocess.run([*MPIRUN, "-n", "1", *map(str, run), ":", "-n", "1", *map(str, other)],
                                cwd=self.directory, capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("tread: error"), 1, result.stderr)
        self.assertIn("rank 1 on ", result.stderr)
        self.assertLess(time.monotonic() - start, 30)

    def test_a_rank_that_dies_ends_the_job(self):
        scene = self.write("scene.toml", SCENE.replace("duration = 0.02", "duration = 1000.0"))
        job = subprocess.Popen([*MPIRUN, "-n", "2", TREAD, "run", str(scene), "--output", str(self.output), "--backend",
                                "cpu"], cwd=self.directory, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.addCleanup(job.stderr.close)
        self.addCleanup(job.kill)
        while not (self.output / "timeseries.h5").exists():
            self.assertIsNone(job.poll())
            time.sleep(0.2)
        os.kill(children(job.pid)[1], signal.SIGKILL)
        self.assertNotEqual(job.wait(timeout=30), 0)

    def test_a_rank_that_waits_too_long_says_for_whom(self):
        scene = self.write("scene.toml", SCENE.replace("duration = 0.02", "duration = 1000.0").replace("= 0.01", "= 0.0"))
        job = subprocess.Popen([*MPIRUN, "-n", "2", TREAD, "run", str(scene), "--output", str(self.output), "--backend",
                                "cpu", "--hang-timeout", "00:00:10"], cwd=self.directory, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
        self.addCleanup(job.stderr.close)
        self.addCleanup(job.kill)
        while not (self.output / "timeseries.h5").exists():
            self.assertIsNone(job.poll())
            time.sleep(0.2)
        os.kill(children(job.pid)[1], signal.SIGSTOP)
        _, said = job.communicate(timeout=100)
        self.assertEqual(job.returncode, 4, said)
        self.assertRegex(said, r"tread: error: rank [01] on \S+: has waited [0-9.]+ s for (rank [01] \([a-z -]+\)|all ranks \([a-z -]+\), "
                         r"to which (rank 1 of this node has not|all of this node have) come), after \d+ steps of this run; --hang-timeout allows for more")

    def test_the_time_to_wait_is_checked(self):
        result = self.tread("run", "scene.toml", "--hang-timeout", "0")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--hang-timeout: 0: not a time over 0 as HH:MM:SS", result.stderr)


if __name__ == "__main__":
    unittest.main()
