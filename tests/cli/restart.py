#!/usr/bin/env python3
"""Runs that are stopped, killed, damaged or crowded, and go on, started and ended as users and schedulers do it."""

import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import time
import unittest

import h5py
import numpy

from checkpoint_file import edited, perturbed
from command import BODY, SCENE, TREAD, CommandTest

MPIRUN = (shutil.which("mpirun"), "--allow-run-as-root", "--oversubscribe")

BACKEND = os.environ.get("TREAD_TEST_BACKEND", "cpu")

# A rock is made eight times as fast as a wheel, and nothing here turns on what the body is.
WITH_ROCK = re.sub(r"generate .*", 'generate  = { kind = "rock", seed = 3 }', SCENE)
ROCK = BODY + "diameter = 0.1\n"

MIXED = WITH_ROCK + ROCK.replace("0.3]", "0.155]") + "velocity = [0.3, 0.0, -0.8]\n"

# Bodies alone: a rock on the floor, and one that falls on it.
BODIES = re.sub(r"\[\[terrain\]\].*?\n\n", "", WITH_ROCK, flags=re.S) + ROCK.replace("0.3]", "0.06]") + ROCK.replace(
    '"roller"\nshape', '"other"\nshape').replace("[0.2, 0.2, 0.3]", "[0.22, 0.2, 0.18]")

EVERY_FEW_STEPS = "--set=checkpoint.every_steps=5"


def lasting(scene, seconds):
    """The scene with a phase of that many seconds."""
    return scene.replace("duration = 0.02\n", f"duration = {seconds}\n", 1)


def datasets(path):
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


class Restart(CommandTest):
    def run_scene(self, text, output, *options, code=0, launcher=(), backend=BACKEND):
        scene = self.write("scene.toml", text)
        result = self.tread("run", scene, "--output", output, "--backend", backend, "--threads", "1", *options,
                            launcher=launcher)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def begin(self, text, *options, launcher=(), backend=BACKEND, output=None, **more):
        """The run as a process that goes on by itself."""
        scene = self.write("scene.toml", text)
        command = [*launcher, TREAD, "run", scene, "--output", output or self.output, "--backend", backend, "--threads", "1",
                   *options]
        job = subprocess.Popen(list(map(str, command)), cwd=self.directory, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True, **more)
        self.addCleanup(lambda: (job.stdout.close(), job.stderr.close()))
        self.addCleanup(job.kill)
        return job

    def end(self, job, code):
        out, err = job.communicate(timeout=120)
        self.assertEqual(job.returncode, code, out + err)
        return out + err

    def wait_for(self, condition, job):
        while not condition():
            self.assertIsNone(job.poll(), job.poll())
            time.sleep(0.02)

    def checkpoints(self, output=None):
        return sorted(((output or self.output) / "checkpoints").glob("*.h5"))

    def summary(self, output=None):
        return json.loads(((output or self.output) / "summary.json").read_text())

    def assert_same_bits(self, one, other):
        ours, theirs = datasets(one / "timeseries.h5"), datasets(other / "timeseries.h5")
        self.assertEqual(ours.keys(), theirs.keys())
        for name, values in ours.items():
            self.assertEqual(values.tobytes(), theirs[name].tobytes(), name)
        names = {path.name for path in (one / "snapshots").glob("*_*")}
        self.assertEqual(names, {path.name for path in (other / "snapshots").glob("*_*")})
        for name in names:
            ours, theirs = datasets(one / "snapshots" / name), datasets(other / "snapshots" / name)
            for field, values in ours.items():
                self.assertEqual(values.tobytes(), theirs[field].tobytes(), f"{name} {field}")

    def check_uninterrupted_is_stopped_and_restarted(self, text):
        whole = self.directory / "whole"
        self.run_scene(text, whole, "--set=checkpoint.every_wall=0")
        job = self.begin(text, EVERY_FEW_STEPS)
        self.wait_for(self.checkpoints, job)
        job.send_signal(signal.SIGUSR2)
        said = self.end(job, 75)
        self.assertIn("stopped by signal USR2", said)
        stopped = self.summary()
        self.assertEqual((stopped["status"], stopped["exit_code"], stopped["restarts"]), ("stopped", 75, 0))
        self.assertTrue((self.output / stopped["checkpoint"]).exists())
        self.assertEqual((self.output / "checkpoints" / "latest").read_text().strip(),
                         stopped["checkpoint"].split("/")[1])
        self.run_scene(text, self.output, EVERY_FEW_STEPS, "--restart", "auto")
        ended = self.summary()
        self.assertEqual((ended["status"], ended["restarts"], ended["start"]), ("finished", 1, stopped["start"]))
        self.assertEqual(ended["steps"], self.summary(whole)["steps"])
        self.assertEqual(ended["resolution"], self.summary(whole)["resolution"])
        self.assertGreaterEqual(ended["checkpoints"]["written"], stopped["checkpoints"]["written"])
        self.assertLessEqual(len(self.checkpoints()), 2)
        self.assert_same_bits(whole, self.output)
        log = (self.output / "log.txt").read_text()
        self.assertEqual(log.count("goes on from"), 1)
        self.assertEqual(log.count("phase 'rest' ends"), 1)

    def test_sand_restarted_gives_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(lasting(SCENE, 0.3))

    def test_bodies_restarted_give_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(lasting(BODIES, 0.3))

    def test_sand_and_a_body_restarted_give_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(lasting(MIXED, 0.1))

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
        start = time.monotonic()
        result = self.run_scene(lasting(SCENE, 1000.0), self.output, "--walltime-limit", "00:00:04", code=75)
        self.assertLess(time.monotonic() - start, 4)
        self.assertIn("stopped by the wall-time limit", result.stdout)
        self.assertEqual(len(self.checkpoints()), 1)
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

    def test_a_newer_schema_is_refused(self):
        self.run_scene(SCENE, self.output, EVERY_FEW_STEPS, "--set=checkpoint.keep=1")
        path = self.directory / "newer.h5"
        with edited(self.checkpoints()[0], path) as file:
            file.attrs.modify("schema_version", numpy.array([2, 0]))
        result = self.run_scene(SCENE, self.directory / "new", "--restart", path, code=4)
        self.assertIn("schema is 2.0", result.stderr)

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

    def check_killed_runs(self, text, kills, seed):
        """Runs that are killed at random moments: while they begin, compute, or write a checkpoint."""
        whole = self.directory / "whole"
        self.run_scene(text, whole)
        dice = random.Random(seed)
        killed = 0
        while True:
            there = self.checkpoints()
            job = self.begin(text, "--set=checkpoint.every_steps=8", "--restart=auto")
            if killed < kills and self.kill_at_a_random_moment(job, dice):
                killed += 1
            out, err = job.communicate()
            self.assertNotIn("passed over", err)
            begun = re.search(r"goes on from (\S+) ", out)
            if begun:
                self.assertEqual(begun[1], str(there[-1]))
            if job.returncode == -signal.SIGKILL:
                continue
            self.assertEqual(job.returncode, 0, out + err)
            self.assert_same_bits(whole, self.output)
            if killed == kills:
                return
            shutil.rmtree(self.output)

    def kill_at_a_random_moment(self, job, dice):
        """Whether it was killed before its end; then none of its checkpoints is lost."""
        if dice.random() < 0.25:
            time.sleep(dice.uniform(0, 0.2))
        else:
            self.wait_for_new_checkpoints(job, dice.randint(1, 3))
            time.sleep(dice.uniform(0, 0.05))
        there = self.checkpoints()
        job.kill()
        killed = job.wait() == -signal.SIGKILL
        if there:
            self.assertGreaterEqual(self.checkpoints()[-1], there[-1])
        return killed

    def wait_for_new_checkpoints(self, job, wanted):
        """Or for the end."""
        first, seen = set(self.checkpoints()), set()
        while len(seen) < wanted and job.poll() is None:
            seen |= set(self.checkpoints()) - first
            time.sleep(0.002)

    def test_a_killed_run_loses_nothing_older_than_its_last_checkpoint(self):
        self.check_killed_runs(lasting(MIXED, 0.1), 8, seed=7)

    def stop_after_a_checkpoint(self, text, output, launcher=(), backend=BACKEND):
        """What a run leaves that was stopped soon after its start: its newest checkpoint."""
        job = self.begin(text, EVERY_FEW_STEPS, output=output, launcher=launcher, backend=backend)
        self.wait_for(lambda: self.checkpoints(output), job)
        job.send_signal(signal.SIGUSR2)
        self.end(job, 75)
        return self.checkpoints(output)[-1]

    def ends(self, output):
        """Where points and bodies are at the end (m), by their numbers; the books close as far as rounding goes."""
        self.assertEqual(self.summary(output)["status"], "finished")
        last = len(list((output / "snapshots").glob("points_*.hdf"))) - 1
        points = datasets(output / "snapshots" / f"points_{last:04}.hdf")
        order = numpy.argsort(points["VTKHDF/PointData/id"])
        bodies = datasets(output / "snapshots" / f"bodies_{last:04}.h5")
        return points["VTKHDF/Points"][order], bodies["position"]

    def check_agreement(self, text, checkpoint, others):
        """Chaos bounds what can be the same: a restart that takes sums in another order must end no further from one that
        does not than twice what five restarts do of which everything was moved by up to 1e-9 m."""

        def restarted(name, file, **options):
            launcher, backend = options.get("launcher", ()), options.get("backend", BACKEND)
            self.run_scene(text, self.directory / name, "--restart", file, launcher=launcher, backend=backend)
            return self.ends(self.directory / name)

        stem = checkpoint.parent.parent.name
        expected = restarted(f"{stem}-same", checkpoint)
        spread = numpy.zeros(2)
        for seed in range(5):
            moved = self.directory / f"{stem}-{seed}.h5"
            perturbed(checkpoint, moved, 1e-9, seed)
            ended = restarted(f"{stem}-moved{seed}", moved)
            spread = numpy.maximum(spread, [numpy.abs(a - b).max() for a, b in zip(ended, expected)])
        for name, options in others.items():
            ended = restarted(f"{stem}-{name}", checkpoint, **options)
            off = [numpy.abs(a - b).max() for a, b in zip(ended, expected)]
            print(f"  {stem} to {name}: points {off[0]:.3g} m, bodies {off[1]:.3g} m off; "
                  f"five moved by 1e-9 m: {spread[0]:.3g}, {spread[1]:.3g} m")
            self.assertTrue((off <= 2 * spread).all(), name)

    def test_other_numbers_of_ranks_agree_as_far_as_chaos_lets_them(self):
        text = lasting(MIXED, 0.06)
        for first, second in ((1, 3), (3, 2)):
            ranks = (*MPIRUN, "-n", str(first))
            checkpoint = self.stop_after_a_checkpoint(text, self.directory / f"on{first}", launcher=ranks)
            self.check_agreement(text, checkpoint, {f"{second} ranks": {"launcher": (*MPIRUN, "-n", str(second))}})

    @unittest.skipUnless(BACKEND == "cuda", "no GPU: TREAD_TEST_BACKEND=cuda")
    def test_backends_agree_as_far_as_chaos_lets_them(self):
        text = lasting(MIXED, 0.06)
        for first, second in (("cpu", "cuda"), ("cuda", "cpu")):
            checkpoint = self.stop_after_a_checkpoint(text, self.directory / f"on-{first}", backend=first)
            self.check_agreement(text, checkpoint, {second: {"backend": second}})

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
