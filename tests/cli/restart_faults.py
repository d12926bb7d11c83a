#!/usr/bin/env python3
"""Runs that are killed, crowded, out of disk or given damaged files, and go on."""

import os
import random
import re
import resource
import shutil
import signal
import unittest

import h5py
import numpy

from checkpoint_file import edited
from command import SCENE
from restart_test import EVERY_FEW_STEPS, MIXED, MPIRUN, RestartTest, lasting


class Faults(RestartTest):
    def test_a_damaged_checkpoint_is_passed_over_and_named(self):
        whole = self.directory / "whole"
        text = lasting(SCENE, 0.1)
        self.run_scene(text, whole, EVERY_FEW_STEPS, "--set=checkpoint.keep=100")
        names = self.checkpoints(whole)
        self.assertGreater(len(names), 3)

        def stopped(*damages):
            """A copy of the run as it was before its end, with its newest checkpoints damaged."""
            shutil.rmtree(self.output, ignore_errors=True)
            shutil.copytree(whole, self.output)
            (self.output / "summary.json").unlink()
            for damage, name in zip(damages, reversed(names)):
                damage(self.output / "checkpoints" / name.name)

        def cut(path):
            os.truncate(path, path.stat().st_size // 2)

        def flip(path):
            place = random.Random(1).randrange(512, path.stat().st_size)
            with open(path, "r+b") as file:
                file.seek(place)
                byte = file.read(1)[0]
                file.seek(place)
                file.write(bytes([byte ^ 1 << 5]))

        def spoil_the_head(path):
            with open(path, "r+b") as file:
                file.write(b"nothing")

        stopped(cut, flip, spoil_the_head)
        result = self.run_scene(text, self.output, "--restart", "auto", EVERY_FEW_STEPS, "--set=checkpoint.keep=100")
        for name, why in zip(reversed(names), ("bytes of", "checksum", "no checkpoint")):
            self.assertRegex(result.stderr, f"{name.name}: passed over: .*{why}")
        self.assertIn(f"goes on from {self.output / 'checkpoints' / names[-4].name}", result.stdout)
        self.assert_same_bits(whole, self.output)

        stopped(*[cut] * len(names))
        result = self.run_scene(text, self.output, "--restart", "auto", code=4)
        self.assertIn("no checkpoint of", result.stderr)
        self.run_scene(SCENE, self.directory / "new", "--restart", self.output / "checkpoints" / names[0].name, code=4)

    def test_names_pointers_and_dates_are_not_trusted(self):
        whole = self.directory / "whole"
        text = lasting(SCENE, 0.1)
        self.run_scene(text, whole, EVERY_FEW_STEPS, "--set=checkpoint.keep=100")
        names = [path.name for path in self.checkpoints(whole)]
        shutil.copytree(whole, self.output)
        (self.output / "summary.json").unlink()
        folder = self.output / "checkpoints"
        (folder / "latest").write_text("checkpoint_0000099999.h5\n")  # which is not there
        (folder / names[-1]).rename(folder / "checkpoint_0000088888.h5")
        for age, name in enumerate(names[:-1]):  # the clock went backwards: the newest has the oldest date
            os.utime(folder / name, (1e9 - age, 1e9 - age))
        result = self.run_scene(text, self.output, "--restart", "auto", EVERY_FEW_STEPS, "--set=checkpoint.keep=100")
        self.assertRegex(result.stderr, "checkpoint_0000088888.h5: passed over: it holds step [0-9]+, which is not what its "
                         "name says")
        self.assertIn(f"goes on from {folder / names[-2]}", result.stdout)
        self.assertEqual([path.name for path in self.checkpoints()], names)
        self.assert_same_bits(whole, self.output)

    def test_a_changed_mesh_is_refused(self):
        mesh = self.directory / "rock.stl"

        def write_mesh(seed):
            self.write("mesh.toml", MIXED.replace("seed = 3", f"seed = {seed}"))
            self.assertEqual(self.tread("sdf", "mesh.toml", "--write-stl", mesh).returncode, 0)

        write_mesh(3)
        text = re.sub(r"generate .*", 'file = "rock.stl"', MIXED)
        self.stop_after_a_checkpoint(text, self.output)
        write_mesh(4)
        result = self.run_scene(text, self.output, "--restart", "auto", code=2)
        self.assertIn("a file that it names", result.stderr)
        write_mesh(3)
        self.run_scene(text, self.output, "--restart", "auto")

    def test_another_schema_is_refused(self):
        self.run_scene(SCENE, self.output, EVERY_FEW_STEPS, "--set=checkpoint.keep=1")
        original = self.checkpoints()[0]
        with h5py.File(original, "r") as file:
            major, minor = map(int, file.attrs["schema_version"])
        for version, program in ((major + 1, "older"), (major - 1, "newer: go on with the version that wrote it")):
            path = self.directory / f"schema_{version}.h5"
            with edited(original, path) as file:
                file.attrs.modify("schema_version", numpy.array([version, 0]))
            new = self.directory / f"new_{version}"
            result = self.run_scene(SCENE, new, "--restart", path, code=4)
            self.assertIn(f"schema is {version}.0, and this program (schema {major}.{minor}) is {program}", result.stderr)
            self.assertFalse(new.exists())

    def test_one_run_at_a_time(self):
        job = self.begin(lasting(SCENE, 1000.0))
        self.wait_for((self.output / "timeseries.h5").exists, job)
        for options in (("--restart=auto",), ("--overwrite",)):
            result = self.run_scene(SCENE, self.output, *options, code=4)
            self.assertIn(f"in use by process {job.pid} on ", result.stderr)

    def test_a_full_disk_leaves_the_checkpoints_that_are_there(self):
        whole = self.directory / "whole"
        self.run_scene(SCENE, whole, EVERY_FEW_STEPS, "--set=checkpoint.keep=1")
        largest = self.checkpoints(whole)[0].stat().st_size
        # Python ignores SIGXFSZ: a write beyond the limit then fails like one to a full disk.
        job = self.begin(lasting(SCENE, 1000.0), "--set=checkpoint.every_wall=0", restore_signals=False)
        self.wait_for((self.output / "timeseries.h5").exists, job)
        job.send_signal(signal.SIGUSR1)
        self.wait_for(self.checkpoints, job)
        first = self.checkpoints()[0].read_bytes()
        resource.prlimit(job.pid, resource.RLIMIT_FSIZE, (largest // 2, largest // 2))
        job.send_signal(signal.SIGUSR1)
        said = self.end(job, 4)
        self.assertRegex(said, r"checkpoint_\d+\.h5")
        self.assertEqual([path.read_bytes() for path in (self.output / "checkpoints").glob("checkpoint_*")], [first])
        self.run_scene(lasting(SCENE, 0.05), self.output, "--restart", "auto")

    def test_a_disk_that_checkpoints_fill(self):
        self.check_full_disk(lasting(SCENE, 0.2), 3000, EVERY_FEW_STEPS, "--set=checkpoint.keep=100",
                             "--set=output.snapshots_every=0.1")

    def test_a_disk_that_snapshots_fill(self):
        self.check_full_disk(lasting(SCENE, 0.2), 3000, "--set=checkpoint.every_steps=20", "--set=checkpoint.keep=1",
                             "--set=output.snapshots_every=0.005")

    def test_a_disk_that_is_full_for_several_ranks(self):
        self.check_full_disk(lasting(SCENE, 0.04), 2100, "--set=checkpoint.every_steps=16", "--set=checkpoint.keep=100",
                             "--set=output.snapshots_every=0.02", launcher=(*MPIRUN, "-n", "2"))

    def test_a_killed_run_loses_nothing_older_than_its_last_checkpoint(self):
        self.check_killed_runs(lasting(MIXED, 0.1), 8, seed=7)


if __name__ == "__main__":
    unittest.main()
