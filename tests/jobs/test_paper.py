#!/usr/bin/python3
"""Thinned runs, and the paper's numbers and figures beside ours, from made-up runs. Needs what postprocess/ needs."""

import contextlib
import io
import json
import shutil
import subprocess
import sys
import tempfile
import tomllib
import types
import unittest
import unittest.mock
from pathlib import Path

import h5py
import numpy as np
from matplotlib.colors import to_rgba
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "postprocess"), str(ROOT / "studies")]

import head_on  # noqa: E402
import pack_docs  # noqa: E402
import paper  # noqa: E402
from made_up_run import DRIVEN, MORE, SCENE, SPEED, STARTS, colours_of, make_run, write_columns  # noqa: E402
from tread_paper import fields, sensitivity  # noqa: E402
from tread_paper.cases import FIGURES, SLIPS, last_of  # noqa: E402
from tread_paper.document import Document, put_into  # noqa: E402
from tread_paper.history import history_of, smoothed  # noqa: E402
from tread_paper.measures import Absent, Measures  # noqa: E402
from tread_paper.rolling import centres, rolled_over  # noqa: E402
from tread_post import Run, RunError  # noqa: E402
from tread_post.style import GREY, LEVELS, packed_png  # noqa: E402
from tread_post.thinned import put_together, thin  # noqa: E402

# Runs of the list that are made up, all alike.
RUNS = ("wheel_drop_sand", "wheel_drop_mixed", "rolling_sand", "slip_sand", "slip_mixed", "spirit", "curiosity_rock_coarse",
        "wheel_drop_substeps_2", "wheel_drop_substeps_100")
DOCS = ROOT / "docs"
CRITERIA = ROOT / "configs" / "paper" / "round2"
SUMMARY = """{"points": 1, "bodies": 2, "steps": 3, "substeps": 6, "time": 3.0, "wall_s": 1.0, "sim_per_wall": 3.0, "steps_per_s": 3.0,
 "peak_device_bytes": 1e6, "errors": {"energy": 1e-6}, "devices": ["NVIDIA H100"], "restarts": 1, "commit": "abcdef0123"}"""


def make_impact(path):
    """A head-on run that is Hertz's law itself, with as much energy as it has."""
    text = (ROOT / "configs/paper/head_on_27.toml").read_text(encoding="utf-8")
    time = np.linspace(0, 0.1, 401)
    law = head_on.hertz(tomllib.loads(text), 1, time)
    path.mkdir()
    (path / "scene.toml").write_text(text, encoding="utf-8")
    points_mass = 2 * law.points_kinetic[0] / law.points_velocity[0] ** 2
    (path / "summary.json").write_text(json.dumps(json.loads(SUMMARY) | {"terrain": [{"mass": points_mass}]}), encoding="utf-8")
    mass = 2 * law.body_kinetic[0] / law.body_velocity[0] ** 2
    zero = np.zeros_like(time)
    vector = lambda values: np.stack((values, zero, zero), axis=1)  # noqa: E731
    with h5py.File(path / "timeseries.h5", "w") as file:
        write_columns(file.create_group("wheel/ball"), {"time": (time, "s"), "velocity": (vector(law.body_velocity), "m/s"),
                                                        "force": (vector(-law.force), "N")})
        write_columns(file.create_group("energy"), {"time": (time, "s"), "kinetic_points": (law.points_kinetic, "J"), "half_step": (zero, "J"),
                                                    "strain": (law.elastic, "J"), "contact": (zero, "J")})
        write_columns(file.create_group("balance"), {"time": (time, "s"), "momentum": (vector(mass * law.body_velocity +
                                                                                             points_mass * law.points_velocity), "kg m/s")})


def grey_in(figure):
    """Whether something is drawn in the colour of what is not known."""
    drawn = [part for axis in figure.axes for part in axis.collections if part.get_array() is not None]
    return any((part.to_rgba(part.get_array().ravel()) == to_rgba(GREY)).all(axis=1).any() for part in drawn)


class PaperTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.runs = Path(cls.directory.name) / "runs"
        first = cls.runs / RUNS[0]
        make_run(first)
        (first / "scene.toml").write_text(SCENE.replace('shape = "drum"\n[[phase]]', f'shape = "drum"\n{MORE}[[phase]]', 1), encoding="utf-8")
        (first / "summary.json").write_text(SUMMARY, encoding="utf-8")
        for name in RUNS[1:]:
            shutil.copytree(first, cls.runs / name)
        for name in ("head_on_1", "head_on_8", "head_on_27"):
            make_impact(cls.runs / name)
        cls.measures = Measures(cls.runs)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def test_rows_put_together_keep_means(self):
        time = np.cumsum(np.array([0.0, 1, 1, 2, 1, 3]))
        force = np.array([9.0, 1, 2, 3, 4, 5])
        put = put_together({"time": time, "force": force, "slip": force}, 3, 0.0)
        self.assertEqual(list(put["time"]), [1, 4, 8])
        self.assertEqual(list(put["slip"]), [1, 3, 5])
        self.assertEqual(list(put["force"]), [1, (2 * 1 + 3 * 2) / 3, (4 * 1 + 5 * 3) / 4])
        whole = put_together({"time": time, "force": force}, 10, 2.0)
        self.assertEqual(list(whole["force"]), [2, 3, 4, 5])

    def test_a_thinned_run_is_a_run(self):
        run, folder = Run(self.runs / "slip_sand"), self.runs.parent / "thinned"
        thin(run, folder, 40, STARTS[2], [7])
        small = Run(folder)
        self.assertEqual(small.summary, run.summary)
        self.assertEqual([phase.start for phase in small.phases], list(STARTS))
        self.assertLessEqual(len(small.wheel("front wheel")["time"]), 41)
        whole, few = history_of(run), history_of(small)
        self.assertAlmostEqual(few.series("torque")[1:].mean(), whole.series("torque")[len(whole.time) % 3:].mean(), delta=1.0)
        self.assertEqual(small.snapshots, [7])
        self.assertLess(len(small.points(7).position), 0.3 * len(run.points(7).position))
        # The wheel comes first, and the section through it is whole.
        np.testing.assert_allclose(small.bodies(7).position[0], run.bodies(7).position[0], atol=1e-6)
        near = lambda points: np.sum(np.abs(points.position[:, 1] - 0.25) < 0.007)  # noqa: E731
        self.assertEqual(near(small.points(7)), near(run.points(7)))

    def test_rocks_of_a_run_that_went_on_elsewhere_have_no_displacement(self):
        folder = self.runs.parent / "went_on"
        shutil.copytree(self.runs / "slip_sand", folder / "run")
        for early in sorted((folder / "run" / "snapshots").glob("bodies_*.h5"))[:-1]:
            early.unlink()
        scene = (folder / "run" / "scene.toml").read_text(encoding="utf-8")
        for every, known in ((0.3, False), (3.0, True)):
            (folder / "run" / "scene.toml").write_text(f"{scene}\n[output]\nsnapshots_every = {every}\n", encoding="utf-8")
            thin(Run(folder / "run"), folder / f"thinned_{every}", 40, STARTS[2], [7])
            with h5py.File(folder / f"thinned_{every}" / "snapshots" / "bodies_0007.h5") as file:
                self.assertEqual("displacement" in file, known)
            self.assertEqual(grey_in(fields.figure_of("any", [("any", Run(folder / f"thinned_{every}"), 7)])), not known)

    def test_the_last_displacements_of_rocks_are_shown_with_their_time(self):
        folder = self.runs.parent / "last"
        shutil.copytree(self.runs / "slip_sand", folder / "run")
        for points in (folder / "run" / "snapshots").glob("points_*.hdf"):
            points.unlink()
        thin(Run(folder / "run"), folder / "thinned", 40, STARTS[2], Run(folder / "run").snapshots[-2:])
        small = Run(folder / "thinned")
        before, last = small.snapshots
        self.assertEqual(last_of("rocks", history_of(small)), ("rocks", small, last))
        with h5py.File(small.path / "snapshots" / f"bodies_{last:04}.h5", "a") as file:
            del file["displacement"]
        since = small.bodies(before).time - STARTS[2]
        self.assertEqual(last_of("rocks", history_of(small)), (f"rocks, at {since:.1f} s", small, before))
        (small.path / "snapshots" / f"bodies_{before:04}.h5").unlink()
        self.assertEqual(last_of("rocks", history_of(small))[2], last)

    def test_runs_are_packed_twice_without_a_loss(self):
        folder = self.runs.parent / "packed"
        shutil.copytree(self.runs / "head_on_27", folder / "head_on_27")
        for _ in range(2):
            pack_docs.pack_run(folder / "head_on_27" / "timeseries.h5")
        packed = Measures(folder)
        for name in ("force", "contact", "body_speed", "kinetic"):
            np.testing.assert_allclose(packed(f"head_on_27 impact {name}"), self.measures(f"head_on_27 impact {name}"), rtol=1e-3, atol=1e-3)
        self.assertNotIn(": ", (folder / "head_on_27" / "summary.json").read_text(encoding="utf-8"))

    def test_snapshots_are_packed(self):
        folder = self.runs.parent / "packed_snapshots"
        thin(Run(self.runs / "slip_sand"), folder, 40, STARTS[2], [7])
        before, bodies = Run(folder).points(7), Run(folder).bodies(7)
        pack_docs.pack_run(folder / "timeseries.h5")
        after = Run(folder).points(7)
        np.testing.assert_allclose(after.position, before.position, atol=1e-4)
        np.testing.assert_allclose(after.fields["displacement"], before.fields["displacement"], rtol=2e-3)
        np.testing.assert_allclose(Run(folder).bodies(7).position, bodies.position, atol=1e-4)
        self.assertEqual(len(Run(folder).shapes), len(Run(self.runs / "slip_sand").shapes))

    def test_the_command_thins(self):
        folder = self.runs.parent / "by_command"
        done = self.command("thin.py", self.runs / "slip_sand", folder, "--phase", "drive", "--times", "2.1", "--rows", "20")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(Run(folder).snapshots, [7])
        done = self.command("thin.py", self.runs / "slip_sand", folder, "--phase", "dance")
        self.assertEqual(done.returncode, 1)
        self.assertIn("no phase 'dance'", done.stderr)

    def command(self, name, *options):
        program = [sys.executable, str(ROOT / "postprocess" / name), *map(str, options)]
        return subprocess.run(program, capture_output=True, text=True, timeout=240, check=False)

    def test_measures(self):
        measure = self.measures
        self.assertAlmostEqual(measure("slip_sand mean speed 1 2"), SPEED, 6)
        self.assertAlmostEqual(measure("slip_sand mean speed_share 1 2"), 0.7, 6)
        self.assertAlmostEqual(measure("slip_sand last sinkage"), 0.03, 6)
        self.assertAlmostEqual(measure("slip_sand mean torque_share 1 2"), 45 / (0.3 * 635 * 0.2), 2)
        self.assertAlmostEqual(measure("slip_sand mean lift_share 1 2"), 1, 2)
        self.assertAlmostEqual(measure("slip_sand when way over 0.098"), 1.1, delta=0.03)  # half of the ramp is lost
        self.assertAlmostEqual(measure("slip_sand quiet way 0.5"), 1.1, delta=0.1)
        self.assertAlmostEqual(measure("slip_sand summary driven"), DRIVEN, 2)
        for text in ("slip_sand mean speed 2 5", "absent mean speed", "slip_sand when way over 9"):
            with self.assertRaises(Absent):
                measure(text)
        for text in ("slip_sand dance speed", "slip_sand mean beauty", "slip_sand"):
            with self.assertRaises(RunError):
                measure(text)

    def test_measures_of_an_impact_are_hertz(self):
        for name, expected, tolerance in (("force", 10019.6, 10), ("contact", 24.609e-3, 5e-4), ("body_speed", -1, 1e-3), ("points_speed", 1, 1e-3),
                                          ("kinetic", 0, 1e-3), ("total", 0, 1e-3), ("recovered", 1, 1e-3)):
            self.assertAlmostEqual(self.measures(f"head_on_27 impact {name}"), expected, delta=tolerance, msg=name)
        self.assertGreater(self.measures("head_on_27 impact both_elastic"), 0.5)

    def test_tables_take_their_place(self):
        self.assertEqual(put_into("a\n<!-- x -->\nold\n<!-- end of x -->\nb\n", "x", ["new"]), "a\n<!-- x -->\nnew\n<!-- end of x -->\nb\n")
        with self.assertRaises(RunError):
            put_into("a", "x", ["new"])

    def test_every_case_is_drawn(self):
        folder = self.runs.parent / "drawn"
        folder.mkdir()
        (folder / "spirit_coarse_fields.png").write_bytes(b"of a run that is gone")
        made_up = Document(CRITERIA, self.runs, ROOT)
        with contextlib.redirect_stdout(io.StringIO()):
            text = "\n".join(line for case in FIGURES for line in paper.drawn(case, made_up, folder))
        absent = {"spirit_coarse_fields", "curiosity_core_coarse_fields", "curiosity_core_fields", "curiosity_rock_fields"}  # no such runs were made up
        for name in {name for figures in FIGURES.values() for name in figures} - absent:
            self.assertGreater(colours_of(folder / f"{name}.png"), 8, name)
            self.assertIn(f"](drawn/{name}.png)", text)
        for name in absent:
            self.assertFalse((folder / f"{name}.png").exists(), name)
            self.assertIn(f"(No picture {name}: {name.removesuffix('_fields')} was not run.)", text)

    def test_the_command_fills_the_document(self):
        document = self.runs.parent / "filled.md"
        shutil.copyfile(DOCS / "paper.md", document)
        done = self.command("paper.py", "cost", "--runs", self.runs, "--output", self.runs.parent, "--document", document)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("| 3.4 sand | 4159; 127; 2600 | 1.0 in 2 parts (NVIDIA H100) | 3 | 3 | 2.0 | 1 | 1e-06 | no verdict | 60 | met |",
                      document.read_text(encoding="utf-8"))

    def test_the_surface_of_a_bed(self):
        run = Run(self.runs / "slip_sand")
        height, cell, base = fields._surface(run, 7)
        self.assertAlmostEqual(cell, 0.02)
        self.assertEqual(height.shape, (50, 25))
        points = run.points(7).position
        self.assertAlmostEqual(np.nanmax(height) + base, points[:, 2].max())
        figure = fields.surface_figure_of("any", [(label, Run(self.runs / name), 7) for name, label in SLIPS], (0.0, 0.2))
        self.assertEqual(len(figure.axes), 6)

    def test_sensitivity_is_mean_and_half_the_difference(self):
        class Table(dict):
            axes = [types.SimpleNamespace(name="input")]

        columns = {"labels/input": np.array(["a", "a", "b"]), "torque": np.array([50.0, 52.0, np.nan]), "drawbar_pull": np.array([-4.0, -6.0, 1.0]),
                   "sinkage": np.array([0.07, 0.08, 0.05])}
        with unittest.mock.patch.object(sensitivity, "CampaignTable", lambda _: Table(columns)):
            lines = sensitivity.lines_of([Path("any")])
        self.assertEqual(lines[2], "| any: input a | 51.0 ± 1.0 | -5.0 ± 1.0 | 75.0 ± 5.0 | 2 |")
        self.assertEqual(lines[3], "| any: input b | - | 1.0 | 50.0 | 0 |")

    def test_a_wheel_that_rolls_over_the_ripple(self):
        history = history_of(Run(self.runs / "curiosity_rock_coarse"))
        _, forward = rolled_over(history, "speed")
        _, upward = rolled_over(history, "vertical_speed")
        np.testing.assert_allclose(np.hypot(forward, upward), 0.7 * 0.2, rtol=1e-6)
        crest = centres(np.linspace(1.39, 1.41, 201), 0.2)[100]
        np.testing.assert_allclose(crest, (1.4, 0.2 + 0.2), atol=1e-6)

    def test_smoothing_keeps_a_line(self):
        time = np.linspace(0, 1, 101)
        np.testing.assert_allclose(smoothed(time, 3 * time, 0.095)[10:-10], 3 * time[10:-10], atol=1e-12)


class PackedPictures(unittest.TestCase):
    def packed(self, pixels):
        drawn = io.BytesIO()
        Image.fromarray(pixels).save(drawn, format="png")
        small = packed_png(drawn.getvalue())
        self.assertLessEqual(len(small), len(drawn.getvalue()))
        return np.asarray(Image.open(io.BytesIO(small)).convert("RGB")).astype(int)

    def test_few_colours_and_many_stay_near(self):
        across, down = np.meshgrid(np.arange(256), np.arange(256))
        few = np.stack((across // 64 * 80, down // 64 * 80, 0 * across), axis=2).astype(np.uint8)
        np.testing.assert_array_equal(self.packed(few), few)
        many = np.stack((across, down, (across + down) // 2), axis=2).astype(np.uint8)
        self.assertLessEqual(np.abs(self.packed(many) - many).max(), LEVELS)


if __name__ == "__main__":
    unittest.main()
