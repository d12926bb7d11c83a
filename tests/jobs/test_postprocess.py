#!/usr/bin/python3
"""The pictures of postprocess/, from a made-up run. Needs what postprocess/ needs."""

import shutil
import subprocess
import sys
import tempfile
import threading
import tomllib
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import head_on  # noqa: E402
from made_up_run import SCENE, STARTS, colours_of, make_run  # noqa: E402
from tread_post import Run, RunError  # noqa: E402


class PostprocessTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.run_path = Path(cls.directory.name) / "run"
        make_run(cls.run_path)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def command(self, name, *options):
        room = "studies" if (ROOT / "studies" / name).is_file() else "postprocess"
        program = [sys.executable, str(ROOT / room / name), *map(str, options)]
        return subprocess.run(program, capture_output=True, text=True, timeout=240, check=False)

    def picture(self, name, *options):
        output = self.run_path.parent / f"{name}.png"
        done = self.command(name, self.run_path, "--output", output, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.strip(), str(output))
        self.assertGreater(colours_of(output), 40, "a picture of something")

    def test_run_reads_everything(self):
        run = Run(self.run_path)
        self.assertEqual(run.title, "Wheel at slip 0.3 on sand with rocks")
        self.assertEqual(run.summary["status"], "finished")
        self.assertEqual(run.wheels, ["front wheel"])
        self.assertEqual([(phase.name, phase.start) for phase in run.phases],
                         list(zip(("settle", "drop", "drive"), STARTS)))
        wheel = run.wheel("front wheel")
        self.assertEqual(wheel["force"].shape, (151, 3))
        self.assertEqual(wheel.units["torque"], "N m")
        self.assertEqual(run.energy.units["total"], "J")
        self.assertEqual(run.snapshots, [0, 7])
        self.assertEqual(run.points(7).time, 3.0)
        self.assertEqual(run.points(7).fields["displacement"].shape, (50 * 100 * 15, 3))
        self.assertEqual(run.bodies(7).orientation.shape, (61, 4))
        self.assertEqual([shape.name for shape in run.shapes], ["drum", "clast"])
        self.assertIsNone(run.points(3))

    def test_snapshots_open_in_vtk(self):
        import vtk

        reader = vtk.vtkHDFReader()
        reader.SetFileName(str(self.run_path / "snapshots" / "points_0007.hdf"))
        reader.Update()
        self.assertEqual(reader.GetOutput().GetNumberOfPoints(), 50 * 100 * 15)

    def test_wheel_history(self):
        self.picture("wheel_history.py")

    def test_balance(self):
        self.picture("balance.py")

    def test_sdf_convergence(self):
        cells = np.array([10.0, 15, 20, 30, 40, 60, 80, 100, 150, 200])
        report = self.run_path.parent / "report.h5"
        with h5py.File(report, "w") as file:
            file.attrs["shape"] = "clast"
            for name, power in (("cells", -1), ("mean_surface", 2), ("worst_surface", 1.5), ("mean_normal", 1),
                                ("worst_normal", 0.5), ("seconds", -2.5), ("bytes", -3)):
                file[name] = cells**-power
            file["volume_ratio"] = 1 - 5 / cells**2
        output = report.with_suffix(".png")
        done = self.command("sdf_convergence.py", report, report, "--output", output)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(colours_of(output), 40, "a picture of something")

    def test_head_on_knows_hertz(self):
        scene = tomllib.loads((ROOT / "configs/paper/head_on_1.toml").read_text(encoding="utf-8"))
        time = np.linspace(0, 0.1, 4001)
        for elastic_spheres, force, contact in ((1, 10019.6, 24.609e-3), (2, 7593.4, 32.472e-3)):  # closed forms
            history = head_on.hertz(scene, elastic_spheres, time)
            self.assertLess(abs(history.force.max() / force - 1), 1e-4)
            self.assertLess(abs(np.ptp(time[history.force > 0]) - contact), 2 * time[1])
            self.assertLess(np.max(np.abs(history.total / history.total[0] - 1)), 1e-4)
            self.assertAlmostEqual(history.body_velocity[-1], -1, 4)

    def test_point_motions(self):
        table = self.run_path.parent / "motions.csv"
        table.write_text("case,points_per_cell,motion,substeps,spring,creep_m_s,pull,jitter\n"
                         '"held at 0.15 W, elastic",1,supported,1,0.1,1e-5,0.15,1e-4\n'
                         '"drawn at 0.1 m/s, elastic",1,ballistic,100,0.1,0.1,0.27,1e-4\n'
                         '"at rest",64,frozen,100,2.0,0,0,1e-3\n"at rest",64,frozen,100,,,,\n', encoding="utf-8")
        output = table.with_suffix(".png")
        done = self.command("point_motions.py", table, "--output", output)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(colours_of(output), 24, "a picture of something")

    def test_stability_map(self):
        table = self.run_path.parent / "stability.csv"
        table.write_text("name,map,x,y,x_label,y_label,backend,outcome,expected,reason\n"
                         'a,speeds,"[0.0, 0.0, -1.0]",0.1,speed,cells,cpu,stable,yes,\n'
                         'b,speeds,"[0.0, 0.0, -9.0]",0.1,speed,cells,cpu,stopped,yes,too deep\n'
                         'c,speeds,"[0.0, 0.0, -1.0]",0.2,speed,cells,cpu,told,no,\nd,,,,,,cpu,wrong,no,\n', encoding="utf-8")
        output = table.with_suffix(".png")
        done = self.command("stability_map.py", table, "--output", output)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(colours_of(output), 24, "a picture of something")

    def asleep_from(self, name, distance, begins, factor):
        """The drive again, from `begins` on with `factor` times the torque."""
        path = self.run_path.parent / name
        path.mkdir()
        (path / "scene.toml").write_text(SCENE + f"[sleep]\ndistance = {distance}\n", encoding="utf-8")
        shutil.copy(self.run_path / "timeseries.h5", path)
        with h5py.File(path / "timeseries.h5", "r+") as file:
            wheel = file["wheel/front wheel"]
            torque = wheel["torque"][:]
            torque[wheel["time"][:] > begins] *= factor
            wheel["torque"][...] = torque
        return path

    def test_sleep_pairs(self):
        awake = self.asleep_from("awake", 20.0, 9.0, 1.0)
        branches = [self.asleep_from(f"branch{i}", 0.35, begins, factor) for i, (begins, factor) in enumerate(((1.5, 1.01), (2.1, 1.03)))]
        branches.append(self.asleep_from("moved", 20.0, 1.5, 1.1))
        output, table = awake.with_suffix(".png"), awake.with_suffix(".csv")
        done = self.command("sleep_pairs.py", awake, *branches, "--output", output, "--table", table)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("torque: +2.000 % +- 1.000 %, 2 branches asleep", done.stdout)
        self.assertIn("sinkage: +0.000 % +- 0.000 %", done.stdout)
        rows = table.read_text(encoding="utf-8").splitlines()
        self.assertAlmostEqual(float(rows[2].split(",")[2]), 2.1, delta=0.021)
        self.assertGreater(colours_of(output), 40, "a picture of something")

    def test_render(self):
        self.picture("render.py")
        small = ("--size", "480", "300")
        self.picture("render.py", "--snapshot", "0", *small)
        self.picture("render.py", "--colour", "rank", *small)

    def test_shapes(self):
        mesh = self.run_path.parent / "spindle.obj"
        angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
        corners = [(0, 0, -0.5), (0, 0, 0.5), *((np.cos(a), np.sin(a), 0) for a in angles)]
        sides = [(3 + i, 3 + (i + 1) % 24) for i in range(24)]
        faces = [(one, other, 2) for one, other in sides] + [(other, one, 1) for one, other in sides]
        lines = ["v {} {} {}".format(*c) for c in corners] + ["f {} {} {}".format(*f) for f in faces]
        mesh.write_text("\n".join(lines) + "\n", encoding="utf-8")
        output = self.run_path.parent / "shapes.png"
        done = self.command("shapes.py", mesh, mesh, "--output", output)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.strip(), str(output))
        # Letters alone are at most 16 greys.
        self.assertGreater(colours_of(output), 24, "a picture of something")

    def test_triaxial(self):
        output = self.run_path.parent / "triaxial.png"
        done = self.command("triaxial.py", "--output", output)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"\| karlsruhe \| 25 \| [+-]0\.\d\d, ")
        self.assertGreater(colours_of(output), 24, "a picture of something")
        kept = (ROOT / "docs" / "validation" / "triaxial.csv").read_text(encoding="utf-8").splitlines(keepends=True)
        law = self.run_path.parent / "law.csv"
        law.write_text("".join(kept[:-1]), encoding="utf-8")
        done = self.command("triaxial.py", "--law", law, "--output", output)
        self.assertEqual(done.returncode, 1)
        self.assertIn("law.csv: other tests than", done.stderr)

    def test_the_front_lists_every_command_and_runs_one(self):
        listed = self.command("post.py", "--help")
        self.assertEqual(listed.returncode, 0, listed.stderr)
        for path in (ROOT / "postprocess").glob("*.py"):
            if path.name != "post.py":
                self.assertRegex(listed.stdout, rf"(?m)^  {path.stem} +\w.*\.$")
        direct, through = self.command("thin.py", "--help"), self.command("post.py", "thin", "--help")
        self.assertEqual((through.returncode, through.stdout), (0, direct.stdout))
        unknown = self.command("post.py", "thinn")
        self.assertEqual(unknown.returncode, 2)
        self.assertIn("no command 'thinn'", unknown.stderr)

    def test_packed_tables_are_read_as_they_are(self):
        sys.path.insert(0, str(ROOT / "postprocess"))
        from tread_post.study_table import read_study
        kept = sorted((ROOT / "docs" / "studies").glob("study_*.csv.gz"))
        self.assertTrue(kept)
        for path in kept:
            self.assertGreater(len(read_study(path).rows), 0, path)

    def test_errors_name_what_is_wrong(self):
        absent = self.run_path.parent / "absent.stl"
        for name, options, words in (
            ("shapes.py", (absent, "--output", absent.with_suffix(".png")), "absent.stl: no such file"),
            ("shapes.py", (self.run_path, "--output", absent.with_suffix(".png")), "accepted are .stl, .obj"),
            ("render.py", (self.run_path / "absent",), "no scene.toml"),
            ("render.py", (self.run_path, "--snapshot", "3"), "this run has 0 to 7"),
            ("wheel_history.py", (self.run_path, "--wheel", "rear"), "/wheel/rear"),
            ("sdf_convergence.py", (self.run_path / "timeseries.h5",), "no report of tread sdf"),
            ("work_precision.py", (self.run_path / "scene.toml",), "no table of a study"),
            ("point_motions.py", (self.run_path / "scene.toml",), "no table of bench_point_motions"),
            ("stability_map.py", (self.run_path / "scene.toml",), "no table of run_matrix.py"),
            ("head_on.py", (self.run_path / "absent",), "no scene.toml"),
        ):
            done = self.command(name, *options)
            self.assertEqual(done.returncode, 1)
            self.assertIn(words, done.stderr)
            self.assertNotIn("Traceback", done.stderr)

    def test_a_damaged_file_is_an_error_of_the_run(self):
        with tempfile.TemporaryDirectory() as directory:
            path = Path(directory)
            (path / "scene.toml").write_text(SCENE, encoding="utf-8")
            (path / "timeseries.h5").write_bytes(b"not HDF5")
            with self.assertRaisesRegex(RunError, "timeseries.h5"):
                Run(path).wheels
            with h5py.File(path / "timeseries.h5", "w") as file:
                file.attrs["schema_version"] = [2, 0]
            with self.assertRaisesRegex(RunError, "timeseries.h5: schema version 2.0; read here is 1.x"):
                Run(path).wheels

    def test_a_file_that_is_being_written_is_read_once_it_is(self):
        whole = (self.run_path / "timeseries.h5").read_bytes()
        with tempfile.TemporaryDirectory() as directory:
            path = Path(directory)
            (path / "scene.toml").write_text(SCENE, encoding="utf-8")
            (path / "timeseries.h5").write_bytes(whole[: len(whole) // 2])
            writer = threading.Timer(0.5, (path / "timeseries.h5").write_bytes, (whole,))
            writer.start()
            self.addCleanup(writer.join)
            self.assertEqual(len(Run(path).wheel("front wheel")["time"]), 151)


if __name__ == "__main__":
    unittest.main()
