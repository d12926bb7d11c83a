"""How runs are started, ended, killed and compared that go on from checkpoints."""

import json
import os
import random
import re
import shlex
import shutil
import signal
import subprocess
import time

import h5py
import numpy

from checkpoint_file import perturbed
from command import BODY, MPIRUN, SCENE, TREAD, CommandTest

BACKEND = os.environ.get("TREAD_TEST_BACKEND", "cpu")

# A rock is made faster than a wheel, and nothing here turns on what the body is.
WITH_ROCK = re.sub(r"generate .*", 'generate  = { kind = "rock", seed = 3 }', SCENE).replace("node_spacing = 0.0075\n", "")
ROCK = BODY + "diameter = 0.1\n"

MIXED = WITH_ROCK + ROCK.replace("0.3]", "0.155]") + "velocity = [0.3, 0.0, -0.8]\n"

# The same with a crowd of rocks that fall on the sand beside it.
STREWN = MIXED + """
[[rocks]]
shape     = "roller"
material  = "steel"
count     = 50
diameter  = 0.03
region    = { box = [[0.0, 0.0, 0.105], [0.4, 0.14, 0.19]] }
placement = "rain"
seed      = 1
"""

# MIXED with a second rock on a hinge above it, which swings as the first one hits the sand.
JOINTED = MIXED + ROCK.replace('"roller"\nshape', '"arm"\nshape').replace("[0.2, 0.2, 0.3]", "[0.23, 0.2, 0.26]") + """
[[joint]]
name    = "hinge"
type    = "revolute"
between = ["roller", "arm"]
at      = [0.21, 0.2, 0.205]
axis    = [0, 1, 0]
"""

# Bodies alone: a rock on the floor, and one that falls on it.
BODIES = re.sub(r"\[\[terrain\]\].*?\n\n", "", WITH_ROCK, flags=re.S) + ROCK.replace("0.3]", "0.06]") + ROCK.replace(
    '"roller"\nshape', '"other"\nshape').replace("[0.2, 0.2, 0.3]", "[0.22, 0.2, 0.18]")

EVERY_FEW_STEPS = "--set=checkpoint.every_steps=5"


def lasting(scene, seconds):
    """The scene with a phase of that many seconds."""
    return scene.replace("duration = 0.02\n", f"duration = {seconds}\n", 1)


# A long bed with a rock at one end, and sand that sleeps at the other.
ASLEEP = lasting(MIXED, 0.06).replace("[0.4, 0.4, 0.4]", "[1.0, 0.2, 0.4]").replace("[0.4, 0.4, 0.1]", "[1.0, 0.2, 0.1]").replace(
    "[0.2, 0.2, 0.155]", "[0.15, 0.1, 0.155]").replace("velocity = [0.3, 0.0, -0.8]\n", "") + "[sleep]\ndistance = 0.1\nrest = 0.001\nspeed = 1.0\n"


def datasets(path):
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


class RestartTest(CommandTest):
    """How runs are started, ended and compared."""

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

    def check_uninterrupted_is_stopped_and_restarted(self, text, launcher=()):
        whole = self.directory / "whole"
        self.run_scene(text, whole, "--set=checkpoint.every_wall=0", launcher=launcher)
        job = self.begin(text, EVERY_FEW_STEPS, launcher=launcher)
        self.wait_for(self.checkpoints, job)
        job.send_signal(signal.SIGUSR2)
        said = self.end(job, 75)
        self.assertIn("stopped by signal USR2", said)
        stopped = self.summary()
        self.assertEqual((stopped["status"], stopped["exit_code"], stopped["restarts"]), ("stopped", 75, 0))
        self.assertTrue((self.output / stopped["checkpoint"]).exists())
        self.assertEqual((self.output / "checkpoints" / "latest").read_text().strip(),
                         stopped["checkpoint"].split("/")[1])
        self.run_scene(text, self.output, EVERY_FEW_STEPS, "--restart", "auto", launcher=launcher)
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

    def run_on_a_small_disk(self, text, kilobytes, *options, launcher=()):
        """On a disk that a run fills; then somebody makes room, and it goes on. Both exit codes, and what was said. The disk
        is mounted for these processes alone and goes with them; what is left is copied to `output`."""
        disk = self.directory / "disk"
        disk.mkdir()
        scene = self.write("scene.toml", text)
        command = shlex.join(map(str, [*launcher, TREAD, "run", scene, "--output", disk / "run", "--backend", BACKEND,
                                       "--threads", "1", *options]))
        script = self.write("script.sh", f"""
            mount -t tmpfs -o size={kilobytes}k tmpfs {disk} || exit 99
            {command}
            code=$?
            ls {disk}/run/* > {self.directory}/left.txt
            mount -o remount,size=1g {disk}
            {command} --restart auto
            again=$?
            cp -r {disk}/run {self.output}
            echo codes $code $again
            """)
        result = subprocess.run(["unshare", "--mount", "sh", script], capture_output=True, text=True, timeout=250)
        if result.returncode == 99 or "unshare" in result.stderr:
            self.skipTest("no right to mount a small disk here")
        self.assertIn("codes 4 0", result.stdout, result.stdout + result.stderr)
        self.assertRegex(result.stderr, "(No space left on device|cannot be written|HDF5: .* failed)")
        self.assertNotRegex(result.stderr, "(?i)segmentation|on signal|core dumped")
        self.assertNotIn(".tmp", (self.directory / "left.txt").read_text())
        return result

    def check_full_disk(self, text, kilobytes, *options, launcher=()):
        whole = self.directory / "whole"
        self.run_scene(text, whole, *options, launcher=launcher)
        result = self.run_on_a_small_disk(text, kilobytes, *options, launcher=launcher)
        self.assertEqual(result.stdout.count("goes on from"), 1)
        self.assert_same_bits(whole, self.output)

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

    def stop_after_a_checkpoint(self, text, output, *options, launcher=(), backend=BACKEND):
        """What a run leaves that was stopped soon after its start: its newest checkpoint."""
        job = self.begin(text, EVERY_FEW_STEPS, *options, output=output, launcher=launcher, backend=backend)
        self.wait_for(lambda: self.checkpoints(output), job)
        job.send_signal(signal.SIGUSR2)
        self.end(job, 75)
        return self.checkpoints(output)[-1]

    def ends(self, output):
        """Positions (m) of points and bodies at the end, by number; requires that the energy balance closes to rounding."""
        self.assertEqual(self.summary(output)["status"], "finished")
        last = len(list((output / "snapshots").glob("points_*.hdf"))) - 1
        points = datasets(output / "snapshots" / f"points_{last:04}.hdf")
        order = numpy.argsort(points["VTKHDF/PointData/id"])
        bodies = datasets(output / "snapshots" / f"bodies_{last:04}.h5")
        return points["VTKHDF/Points"][order], bodies["position"]

    def check_agreement(self, text, checkpoint, others, backend=BACKEND):
        """Chaos bounds what can be the same: a restart that takes sums in another order must end no further from one on one
        rank than twice what five restarts do of which everything was moved by up to 1e-9 m."""

        def restarted(name, file, **options):
            self.run_scene(text, self.directory / name, "--restart", file, **{"backend": backend, **options})
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

    def check_other_number_of_ranks(self, scene, first, second):
        """A run on `first` ranks that goes on on `second`, and on one."""
        text = lasting(scene, 0.06)
        checkpoint = self.stop_after_a_checkpoint(text, self.directory / f"on{first}", launcher=(*MPIRUN, "-n", str(first)))
        self.check_agreement(text, checkpoint, {f"{second} ranks": {"launcher": (*MPIRUN, "-n", str(second))}})
