#!/usr/bin/env python3
"""What a run leaves behind, read the way users read it: h5py, VTK, JSON; and that its scene runs again."""

import json
import re
import unittest

import h5py
import numpy as np
import vtk

from command import BODY, SCENE, CommandTest


def datasets(file):
    found = {}
    file.visititems(lambda name, item: found.update({name: item}) if isinstance(item, h5py.Dataset) else None)
    return found


class RunOutput(CommandTest):
    def setUp(self):
        super().setUp()
        scene = self.write("scene.toml", SCENE + BODY)
        result = self.tread("run", scene, "--output", self.output, "--backend", "cpu")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_run_directory(self):
        self.check_summary()
        self.check_time_series()
        self.check_snapshots()
        self.check_resolved_scene_runs_to_the_same_result()

    def test_a_phase_that_did_not_settle_says_so(self):
        text = SCENE.replace("duration = 0.02", 'until = "equilibrium"\nmax_duration = 0.002')
        output = self.directory / "unsettled"
        result = self.tread("run", self.write("unsettled.toml", text), "--output", output, "--backend", "cpu")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        phase = json.loads((output / "summary.json").read_text())["phases"][0]
        self.assertIs(phase["settled"], False)
        self.assertAlmostEqual(phase["time"], 0.002)
        self.assertRegex((output / "log.txt").read_text(), "(?i)warning.*phase 'rest' ends: NOT settled after .* unbalanced")

    def test_a_drive_that_gets_to_the_wall_ends_there(self):
        drive = '\n[[phase]]\nname = "{}"\nduration = 0.5\ndrive = {{ body = "roller", angular_velocity = 10.0, slip = 0.0 }}\n'
        text = SCENE.replace("size    = [0.4,", "size    = [0.5,").replace("[0.4, 0.4, 0.1]", "[0.5, 0.4, 0.1]")
        text += BODY.replace("position = [0.2, 0.2, 0.3]", 'position = [0.2, 0.2, "on surface"]') + drive.format("drive") + drive.format("on")
        scene, output = self.write("wall.toml", text), self.directory / "wall"
        warned = r"phase 'drive': 'roller' has 0.13\d* m to go before the wall at x = 0.5 m, .*; a duration of 0.2\d* s fits"
        self.assertRegex(self.tread("check", scene).stdout, "warning: " + warned)
        result = self.tread("run", scene, "--output", output, "--backend", "cpu")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        log = (output / "log.txt").read_text()
        self.assertRegex(log, "(?i)warning.*" + warned)
        self.assertRegex(log, "(?i)warning.*phase 'drive' ends: 'roller' reached the end of the bed after 0.2")
        phases = json.loads((output / "summary.json").read_text())["phases"]
        self.assertEqual([phase["end"] for phase in phases], ["duration", "end of the bed", "end of the bed"])
        self.assertEqual(phases[2]["time"], 0)
        with h5py.File(output / "timeseries.h5", "r") as file:
            wheel = file["wheel/roller"]
            self.assertLess(wheel["position"][-1, 0], 0.5 - 1.05 * 0.06)
            self.assertLess(abs(wheel["drawbar_pull"][:]).max(), 1e3)

    def test_power_is_the_mean_of_a_row(self):
        """Within a ramp the spin grows from row to row: the mean torque acts at its mean, and not at that of the row's end."""
        text = SCENE + BODY.replace("position = [0.2, 0.2, 0.3]", 'position = [0.2, 0.2, "on surface"]')
        text += '\n[[phase]]\nname = "drive"\nduration = 0.04\ndrive = { body = "roller", angular_velocity = 10.0, ramp = 0.04 }\n'
        output = self.directory / "ramp"
        result = self.tread("run", self.write("ramp.toml", text), "--output", output, "--backend", "cpu", "--set", "time.dt=2e-4")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        with h5py.File(output / "timeseries.h5", "r") as file:
            wheel = {name: item[:] for name, item in file["wheel/roller"].items()}
        spin, torque = wheel["angular_velocity"][:, 1], -wheel["torque"][:, 1]
        rows = np.flatnonzero((wheel["time"][:-1] > 0.021) & (abs(torque[1:]) > 0)) + 1
        self.assertGreater(len(rows), 3)
        expected = torque[rows] * 0.5 * (spin[rows - 1] + spin[rows])
        # A step has the spin of its end: the mean of a row of 25 steps or more is half a step's growth above that of its ends.
        step = (spin[rows] - spin[rows - 1]) / 25
        error = abs(wheel["power"][rows] - expected) / abs(torque[rows])
        print("mean spin: measured off by", error.max(), "rad/s, expected 0, tolerance", step.min(), "(a step's growth)")
        self.assertTrue((error <= step).all(), (error, step))

    def test_a_body_that_rolls_off_an_open_bed_stops_the_run(self):
        text = SCENE.replace("gravity =", 'walls = { x = "open" }\ngravity =').replace("[0.0, 0.0, -9.81]", "[4.0, 0.0, -9.0]")
        text += BODY + '\n[[phase]]\nname = "drive"\nduration = 0.01\ndrive = { body = "roller", angular_velocity = 1.0 }\n'
        text += '\n[[phase]]\nname = "coast"\nduration = 2.0\n'
        result = self.tread("run", self.write("edge.toml", text), "--output", self.directory / "edge", "--backend", "cpu")
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        self.assertRegex(result.stderr + result.stdout, "'roller' has left the terrain")

    def test_without_output_check_and_log_say_what_is_left_out(self):
        scene = self.write("bare.toml", SCENE.replace("0.005", "1e9").replace("snapshots_every = 0.01", ""))
        checked = self.tread("check", "--stages", scene).stdout
        output = self.directory / "bare"
        result = self.tread("run", scene, "--output", output, "--backend", "cpu", "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        off = dict(re.findall(r"^  off (.*?)  +(.*)$", checked, re.MULTILINE))
        self.assertRegex(off["snapshots"], r"output.snapshots_every = 0; by model 258 bytes and 40 ns a point: .* ms a snapshot")
        self.assertEqual(dict(re.findall("^left out: (.*?) - (.*; by model .*)$", (output / "log.txt").read_text(), re.MULTILINE)),
                         {name: why for name, why in off.items() if "by model" in why})
        stages = json.loads((output / "summary.json").read_text())["stages"]
        self.assertEqual({stage["name"] for stage in stages if not stage["on"]}, off.keys())
        self.assertFalse((output / "snapshots").exists())
        with h5py.File(output / "timeseries.h5", "r") as file:
            self.assertEqual(len(file["energy/time"]), 2)

    def check_summary(self):
        summary = json.loads((self.output / "summary.json").read_text())
        self.assertEqual((summary["status"], summary["exit_code"]), ("finished", 0))
        self.assertEqual(summary["points"], 8 * 8 * 2 * 8)
        self.assertEqual(summary["bodies"], 1)
        self.assertGreaterEqual(summary["time"], 0.02)
        self.assertEqual([(phase["name"], phase["settled"]) for phase in summary["phases"]], [("rest", None)])
        resolution = summary["resolution"]
        self.assertIn(resolution["verdict"], ("resolved", "marginal", "under-resolved"))
        self.assertAlmostEqual(resolution["figures"]["margin_wave"]["value"], 1.0, places=6)
        self.assertIn(f"resolution: {resolution['verdict']}", (self.output / "log.txt").read_text())

    def check_time_series(self):
        with h5py.File(self.output / "timeseries.h5", "r") as file:
            found = datasets(file)
            self.assertTrue(any(name.endswith("/time") for name in found))
            for name, dataset in found.items():
                self.assertIn("units", dataset.attrs, name)
                same_table = {len(item) for item in dataset.parent.values() if isinstance(item, h5py.Dataset)}
                self.assertEqual(same_table, {len(dataset)}, name)
                # The last output time is the end of the run: one row, not two.
                if name.endswith("/time"):
                    self.assertTrue((np.diff(dataset[:]) > 0).all(), name)
            self.assertAlmostEqual(file["energy/time"][-1], 0.02)
        info = self.tread("info", self.output / "timeseries.h5")
        self.assertIn("units = s", info.stdout)

    def check_snapshots(self):
        snapshots = self.output / "snapshots"
        series = json.loads((snapshots / "points.hdf.series").read_text())["files"]
        self.assertEqual([entry["name"] for entry in series], ["points_0000.hdf", "points_0001.hdf", "points_0002.hdf"])
        times = [entry["time"] for entry in series]
        self.assertTrue(times[0] < times[1] < times[2], times)
        for entry in series:
            reader = vtk.vtkHDFReader()
            reader.SetFileName(str(snapshots / entry["name"]))
            reader.Update()
            grid = reader.GetOutput()
            self.assertEqual(grid.GetNumberOfPoints(), 8 * 8 * 2 * 8)
            self.assertEqual(grid.GetNumberOfCells(), grid.GetNumberOfPoints())
            self.assertEqual(grid.GetPointData().GetArray("velocity").GetNumberOfComponents(), 3)
            self.assertEqual(grid.GetPointData().GetArray("stress").GetNumberOfComponents(), 6)
        with h5py.File(snapshots / "bodies_0000.h5", "r") as bodies, h5py.File(snapshots / "shapes.h5", "r") as shapes:
            self.assertEqual(bodies["orientation"].shape, (1, 4))
            self.assertEqual(bodies["material"][:].tolist(), [1])
            self.assertEqual(shapes[str(bodies["shape"][0])].attrs["name"], "roller")

    def check_resolved_scene_runs_to_the_same_result(self):
        again = self.directory / "again"
        result = self.tread("run", self.output / "scene.toml", "--output", again, "--backend", "cpu", "--quiet")
        self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)
        self.assertEqual((again / "scene.toml").read_text(), (self.output / "scene.toml").read_text())
        with h5py.File(self.output / "timeseries.h5", "r") as first, h5py.File(again / "timeseries.h5", "r") as second:
            ours, theirs = datasets(first), datasets(second)
            self.assertEqual(ours.keys(), theirs.keys())
            for name, dataset in ours.items():
                self.assertEqual(dataset[:].tobytes(), theirs[name][:].tobytes(), name)


if __name__ == "__main__":
    unittest.main()
