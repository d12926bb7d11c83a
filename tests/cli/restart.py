#!/usr/bin/env python3
"""Runs on one rank that are stopped and go on, started and ended as users and schedulers do it."""

import re
import signal
import time
import unittest

import h5py

from command import BODY, SCENE
from restart_test import BACKEND, BODIES, EVERY_FEW_STEPS, MIXED, RestartTest, lasting


class Restart(RestartTest):
    def test_sand_restarted_gives_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(lasting(SCENE, 0.3))

    def test_a_refined_grid_restarted_gives_the_same_bits(self):
        text = lasting(SCENE, 0.1).replace("[0.4, 0.4, 0.4]", "[0.8, 0.8, 0.8]").replace("[0.4, 0.4, 0.1]", "[0.8, 0.8, 0.35]")
        refined = text.replace("spacing = 0.05", "spacing = 0.05\nrefine = [[[0.23, 0.23, 0.23], [0.55, 0.55, 0.55]]]")
        self.assertNotEqual(refined, text)
        self.check_uninterrupted_is_stopped_and_restarted(refined)

    def test_bodies_restarted_give_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(lasting(BODIES, 0.3))

    def test_sand_and_a_body_restarted_give_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(lasting(MIXED, 0.1))

    def test_a_lowering_restarted_gives_the_same_bits(self):
        lowered = 'until = "lowered"\nmax_duration = 0.5\nlower = { body = "roller", speed = 0.02 }\n'
        text = (SCENE + BODY.replace("0.3]", '"on surface"]\ngap = 0.002')).replace("duration = 0.02\n", lowered, 1)
        self.check_uninterrupted_is_stopped_and_restarted(text)
        self.assertEqual(self.summary()["phases"][0]["end"], "lowered")

    def test_usr1_writes_a_checkpoint_and_goes_on(self):
        job = self.begin(lasting(SCENE, 1000.0), "--set=checkpoint.every_wall=0")
        self.wait_for((self.output / "timeseries.h5").exists, job)
        time.sleep(0.2)
        self.assertEqual(self.checkpoints(), [])
        job.send_signal(signal.SIGUSR1)
        self.wait_for(self.checkpoints, job)
        for number in (signal.SIGTERM, signal.SIGINT):
            self.assertIsNone(job.poll())
            job.send_signal(number)
            self.end(job, 75)
            self.assertEqual(self.summary()["reason"], f"stopped by signal {number.name[3:]}")
            job = self.begin(lasting(SCENE, 1000.0), "--set=checkpoint.every_wall=0", "--restart=auto")
            self.wait_for(lambda: "goes on from" in (self.output / "log.txt").read_text().splitlines()[-1], job)

    def test_the_walltime_limit_leaves_a_checkpoint(self):
        result = self.run_scene(lasting(SCENE, 1000.0), self.output, "--walltime-limit", "00:00:03", code=75)
        self.assertIn("stopped by the wall-time limit", result.stdout)
        self.assertEqual(self.summary()["reason"], "stopped by the wall-time limit")
        self.assertEqual(len(self.checkpoints()), 1)
        self.run_scene(lasting(SCENE, 1000.0), self.output, "--restart", "auto", "--walltime-limit", "00:00:01", code=75)
        for wrong in ("4", "00:00:00", "0:70:00", "00:00:04x"):
            self.run_scene(SCENE, self.directory / "wrong", "--walltime-limit", wrong, code=2)

    def test_auto_starts_where_there_is_nothing_and_does_nothing_where_all_is_done(self):
        self.run_scene(SCENE, self.output, "--restart", "auto")
        before = {path: path.stat().st_mtime_ns for path in self.output.rglob("*") if path.name != ".lock"}
        result = self.run_scene(SCENE, self.output, "--restart", "auto")
        self.assertIn("finished", result.stdout)
        self.assertEqual(before, {path: path.stat().st_mtime_ns for path in self.output.rglob("*") if path.name != ".lock"})
        self.run_scene(SCENE, self.output, "--restart", "auto", "--overwrite", code=2)
        self.run_scene(SCENE, self.output, code=2)

    def test_a_changed_scene_is_refused_with_every_difference(self):
        job = self.begin(lasting(SCENE, 1000.0))
        self.wait_for((self.output / "timeseries.h5").exists, job)
        job.send_signal(signal.SIGUSR2)
        self.end(job, 75)
        changed = SCENE.replace("friction_angle_deg = 30.0", "friction_angle_deg = 31.0").replace("1600.0", "1500.0")
        result = self.run_scene(changed, self.output, "--restart", "auto", code=2)
        self.assertIn("[[material]] 0 friction_angle_deg: 31.0, was 30.0", result.stderr)
        self.assertIn("[[material]] 0 density: 1500.0, was 1600.0", result.stderr)
        self.assertNotIn("duration: ", result.stderr)
        later = SCENE.replace("a small block", "the same block").replace("0.005", "0.004").replace("0.01\n", "0.0\n")
        self.run_scene(later, self.output, "--restart", "auto", "--set=checkpoint.keep=3")
        self.assertEqual(self.summary()["status"], "finished")

    def test_sand_that_stayed_awake_may_go_on_asleep(self):
        text = lasting(SCENE, 0.06) + "[sleep]\ndistance = 0.1\nrest = 1000.0\n"
        self.run_scene(text, self.output, "--set=checkpoint.every_time=0.03")
        self.assertEqual(self.summary()["asleep"], 0.0)
        other = self.directory / "other"
        self.run_scene(text.replace("1000.0", "0.001"), other, "--restart", self.checkpoints()[0])
        self.assertGreater(self.summary(other)["asleep"], 0.1)
        self.run_scene(text.partition("[sleep]")[0], self.directory / "third", "--restart", self.checkpoints()[0], code=2)

    @unittest.skipUnless(BACKEND == "cuda", "no GPU: TREAD_TEST_BACKEND=cuda")
    def test_backends_agree_as_far_as_chaos_lets_them(self):
        text = lasting(MIXED, 0.06)
        for first, second in (("cpu", "cuda"), ("cuda", "cpu")):
            checkpoint = self.stop_after_a_checkpoint(text, self.directory / f"on-{first}", backend=first)
            self.check_agreement(text, checkpoint, {second: {"backend": second}}, backend=first)

    def test_check_states_how_much_disk_a_run_takes(self):
        text = SCENE.replace("spacing = 0.05", "spacing = 0.025")
        told = self.tread("check", self.write("scene.toml", text), "--set=checkpoint.keep=2").stdout
        self.run_scene(text, self.output, EVERY_FEW_STEPS, "--set=checkpoint.keep=2")
        units = {"B": 1, "kB": 1e3, "MB": 1e6, "GB": 1e9}
        one_on_its_way = max(path.stat().st_size for path in self.checkpoints())
        taken = {"snapshots": sum(path.stat().st_size for path in (self.output / "snapshots").iterdir()),
                 "time series": (self.output / "timeseries.h5").stat().st_size,
                 "checkpoints": one_on_its_way + sum(path.stat().st_size for path in self.checkpoints())}
        for name, size in taken.items():
            amount, unit = re.search(name + r" ([\d.e+]+) ([kMG]?B)", told).groups()
            print(f"  {name}: {size / 1e6:.3g} MB, told {amount} {unit}")
            self.assertLessEqual(size, float(amount) * units[unit] * 1.01, name)
            self.assertGreater(size, float(amount) * units[unit] * 0.5, name)

    def test_every_file_says_where_it_comes_from(self):
        self.run_scene(MIXED, self.output, EVERY_FEW_STEPS)
        summary = self.summary()
        self.assertRegex(summary["start"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertLessEqual(summary["start"], summary["end"])
        self.assertTrue(summary["commit"])
        files = [self.output / "timeseries.h5", *self.checkpoints(), *(self.output / "snapshots").glob("*.h*5"),
                 *(self.output / "snapshots").glob("*.hdf")]
        self.assertGreater(len(files), 6)
        for path in files:
            with h5py.File(path, "r") as file:
                for name in ("scene_hash", "version", "commit", "backend", "start"):
                    self.assertEqual(file.attrs[name], summary[name], f"{path.name} {name}")
                self.assertEqual(file.attrs["ranks"], "1")
                self.assertGreaterEqual(file.attrs["written"].decode(), summary["start"])
        info = self.tread("info", self.checkpoints()[0])
        self.assertIn("schema = tread-checkpoint", info.stdout)


if __name__ == "__main__":
    unittest.main()
