#!/usr/bin/env python3
"""Where a run may write: what it may replace, and that nothing goes before it is known that the run can begin."""

import shutil
import subprocess
import unittest

import bad_input
from command import SCENE, TREAD
from restart_test import EVERY_FEW_STEPS, RestartTest, lasting


class Inputs(RestartTest):
    """What a run reads outlives it."""

    def contents(self):
        return {path: path.read_bytes() for path in self.directory.rglob("*") if path.is_file() and path.suffix != ".toml"}

    def refuse(self, text, output, *options, mentions):
        scene = self.write("scene.toml", text)
        before = self.contents()
        result = self.tread("run", scene, "--output", output, "--backend", "cpu", *options)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        for part in mentions:
            self.assertIn(part, result.stderr)
        self.assertEqual(self.contents(), before)
        self.assertEqual(scene.read_text(), text)

    def test_a_bed_is_not_replaced_by_the_run_that_starts_from_it(self):
        bed = self.directory / "bedrun" / "bed.h5"
        first = (bad_input.BadBed.NO_SAND + bad_input.BadBed.BALLS).replace("[output]", '[output]\nbed_after = "rest"')
        self.run_scene(first, bed.parent)
        text = bad_input.BadBed.NO_SAND + bad_input.BadBed.FROM.replace("bed.h5", "bedrun/bed.h5")
        self.refuse(text, bed.parent, "--overwrite", mentions=[f"the run needs {bed} ([[rocks]] 0 from)", "--output"])
        (self.directory / "link").symlink_to(bed.parent)
        self.refuse(text, self.directory / "link", "--overwrite", mentions=[str(bed)])
        self.run_scene(text, self.output)

    def test_a_scene_is_not_replaced_by_its_own_run(self):
        for options in ((), ("--overwrite",)):
            self.refuse(SCENE, self.directory, *options, mentions=["scene.toml (the scene)"])

    def test_a_checkpoint_is_not_replaced_by_the_run_that_goes_on_from_it(self):
        self.run_scene(SCENE, self.output, EVERY_FEW_STEPS)
        other = self.directory / "other"
        (other / "checkpoints" / "kept").mkdir(parents=True)
        kept = shutil.copy(self.checkpoints()[-1], other / "checkpoints" / "kept" / "state.h5")
        self.refuse(SCENE, other, "--overwrite", "--restart", kept, mentions=[f"{kept} (--restart)"])

    def test_a_run_goes_on_by_the_scene_that_it_wrote(self):
        text = lasting(SCENE, 0.1)
        self.stop_after_a_checkpoint(text, self.output)
        result = self.tread("run", self.output / "scene.toml", "--output", self.output, "--backend", "cpu", "--restart",
                            "auto")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("goes on from", result.stdout)

    def test_a_lock_of_others_does_not_make_a_directory_a_runs(self):
        (self.output / "checkpoints").mkdir(parents=True)
        (self.output / "checkpoints" / "mine.h5").write_text("mine")
        (self.output / ".lock").write_text("of a package manager")
        self.refuse(SCENE, self.output, mentions=["holds 'checkpoints'"])
        self.refuse(SCENE, self.output, "--restart", "auto", mentions=["holds 'checkpoints'"])
        self.refuse(SCENE, self.output, "--overwrite", mentions=[".lock: is not the lock of a run"])

    def test_a_restart_does_not_make_a_directory_a_runs(self):
        (self.output / "snapshots").mkdir(parents=True)
        (self.output / "snapshots" / "mine.h5").write_text("mine")
        for _ in range(2):
            self.refuse(SCENE, self.output, "--restart", "auto", mentions=["holds 'snapshots'"])


class Room(RestartTest):
    """Looked for while the run that is there still is."""

    def run_again_where(self, preparation):
        """The same over a finished run, where `preparation` (a script, as root of its own mounts) took something away."""
        self.run_scene(SCENE, self.output)
        before = {path: path.read_bytes() for path in self.output.rglob("*") if path.is_file()}
        script = self.write("script.sh", f"""
            {preparation} || exit 99
            {TREAD} run {self.directory}/scene.toml --output {self.output} --backend cpu --overwrite
            """)
        result = subprocess.run(["unshare", "--mount", "sh", script], capture_output=True, text=True, timeout=250, check=False)
        if result.returncode == 99 or "unshare" in result.stderr:
            self.skipTest("no right to mount anything here")
        self.assertEqual(result.returncode, 4, result.stdout + result.stderr)
        self.assertEqual({path: path.read_bytes() for path in self.output.rglob("*") if path.is_file()}, before)
        return result.stderr

    def test_too_little_memory_leaves_the_run_that_is_there(self):
        facts = self.write("meminfo", "MemAvailable: 100 kB\n")
        self.assertIn("out of host memory", self.run_again_where(f"mount --bind {facts} /proc/meminfo"))

    def test_a_disk_without_room_for_the_first_files(self):
        scene = self.write("scene.toml", SCENE)
        disk = self.directory / "disk"
        disk.mkdir()
        script = self.write("script.sh", f"""
            mount -t tmpfs -o size=200k tmpfs {disk} || exit 99
            {TREAD} run {scene} --output {disk}/run --backend cpu
            code=$?
            ls -a {disk}
            exit $code
            """)
        result = subprocess.run(["unshare", "--mount", "sh", script], capture_output=True, text=True, timeout=250, check=False)
        if result.returncode == 99 or "unshare" in result.stderr:
            self.skipTest("no right to mount anything here")
        self.assertEqual(result.returncode, 4, result.stdout + result.stderr)
        self.assertIn("run: the disk is too full", result.stderr)
        self.assertEqual(result.stdout.split(), [".", ".."])


if __name__ == "__main__":
    unittest.main()
