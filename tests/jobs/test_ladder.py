#!/usr/bin/python3
"""postprocess/ladder.py: its settings, the limits of made-up runs, and which directories and options it refuses."""

import csv
import json
import math
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py
import numpy as np

from campaign_fixture import ROOT, TREAD
from made_up_run import colours_of, write_columns

sys.path.insert(0, str(ROOT / "postprocess"))

from tread_ladder.answers import PRANDTL, cylinder_load  # noqa: E402
from tread_ladder.arguments import changes_of, write_arguments  # noqa: E402
from tread_ladder.problems import PROBLEMS, SCENES, layers_of, plate_mesh, settings_of  # noqa: E402

LADDER = ROOT / "postprocess" / "ladder.py"
PLATE, CYLINDER, ELASTIC, SAND = (PROBLEMS[name] for name in ("plate_clay", "cylinder_clay", "drum_elastic", "drum_sand"))
COHESION = 1000.0  # Pa
SPIN, SLIP, RAMP, END = 2.0, 0.4, 0.1, 1.3  # rad/s; s

# Stands in for tread: takes down each start, and finishes unless a setting says otherwise.
PROGRAM = f"""#!{sys.executable}
import json, pathlib, sys
folder = pathlib.Path(sys.argv[sys.argv.index("--output") + 1])
with open(pathlib.Path(sys.argv[0]).parent / "starts.txt", "a") as file:
    file.write(" ".join(sys.argv[1:]) + "\\n")
if "title=fail" in sys.argv:
    sys.exit("no such soil")
folder.mkdir(parents=True, exist_ok=True)
(folder / "summary.json").write_text(json.dumps({{"status": "finished"}}))
"""


def value_at(scene, path):
    """The value of a --set key in a parsed scene: `terrain[0].region.box`, `body.NAME.position`."""
    for name, index in re.findall(r"([^.\[]+)(?:\[(\d+)\])?", path):
        scene = scene[name] if isinstance(scene, dict) else next(one for one in scene if one["name"] == name)
        scene = scene[int(index)] if index else scene
    return scene


def columns_of(time, force, sinkage=0.0, torque=0.0, speed=0.0, pull=0.0):
    """The time series of a body, with units."""
    zero = np.zeros_like(time)
    speed = speed + zero
    way = np.concatenate(([0.0], np.cumsum(speed[1:] * np.diff(time))))
    return {
        "time": (time, "s"), "position": (np.stack((way, zero, zero), axis=1), "m"), "velocity": (np.stack((speed, zero, zero), axis=1), "m/s"),
        "angular_velocity": (np.stack((zero, SPIN + zero, zero), axis=1), "rad/s"), "force": (np.stack((zero, zero, force + zero), axis=1), "N"),
        "torque": (np.stack((zero, -torque + zero, zero), axis=1), "N m"), "sinkage": (sinkage + zero, "m"), "slip": (SLIP + zero, "1"),
        "drawbar_pull": (pull + zero, "N"), "power": (zero, "W"),
    }


def width_of(problem, count):
    """m, of the slab."""
    h = problem.length / count
    return layers_of(problem, h) * h


def make_run(output, problem, count, columns, settings=()):
    """A finished run of a problem with `count` cells, as `ladder.py run` leaves it."""
    folder = output / problem.name / str(count)
    folder.mkdir(parents=True)
    write_arguments(folder, settings)
    drive = f"\ndrive = {{ body = '{problem.body}', angular_velocity = {SPIN}, ramp = {RAMP} }}" if problem.body == "drum" else ""
    (folder / "scene.toml").write_text(f"[domain]\nsize = [1.0, {width_of(problem, count)!r}, 1.0]\n[[material]]\nname = 'soil'\ncohesion = {COHESION}\n"
                                       f"[[body]]\nname = '{problem.body}'\n[[phase]]\nname = 'only'{drive}\n")
    (folder / "summary.json").write_text(json.dumps({"status": "finished"}))
    with h5py.File(folder / "timeseries.h5", "w") as file:
        write_columns(file.create_group(f"wheel/{problem.body}"), columns)
        write_columns(file.create_group("phases"), {"index": (np.zeros(1), "1"), "start": (np.zeros(1), "s")})


class LadderTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tread-ladder-")
        self.addCleanup(directory.cleanup)
        self.folder = Path(directory.name)
        self.output = self.folder / "runs"

    def ladder(self, *arguments, code=0):
        done = subprocess.run([sys.executable, str(LADDER), *(str(one) for one in arguments)], capture_output=True, text=True, timeout=240, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        return done

    def rows(self, problem, counts, quantity):
        """The report's rows of a quantity."""
        self.ladder("report", "--output", self.output, "--problems", problem.name, "--spacings", ",".join(str(count) for count in counts))
        with open(self.output / "ladder.csv", encoding="utf-8") as file:
            return [row for row in csv.DictReader(file) if row["quantity"] == quantity]


class SceneTest(LadderTest):
    """What the ladder sets is what the scenes' own files say."""

    def test_no_drum_is_too_narrow_for_tread(self):
        for count in (12, 20, 34, 38, 40, 50, 100):
            settings = changes_of(settings_of(SAND, count))
            width, across = float(settings["shape.drum.generate.width"]), json.loads(settings["domain.size"])[1]
            self.assertGreaterEqual(width, SAND.length / 20)
            self.assertLess(width, across)
            self.assertLessEqual(width, max(2 * SAND.length / count, SAND.length / 20 + SAND.length / count))

    def test_settings_of_the_first_count_are_the_scenes_own(self):
        for problem in PROBLEMS.values():
            scene = tomllib.loads(problem.scene.read_text(encoding="utf-8"))
            for key, text in changes_of(settings_of(problem, problem.counts[0], "plate.obj")).items():
                with self.subTest(problem=problem.name, key=key):
                    self.assertEqual(value_at(scene, key), json.loads(text))

    def test_the_plate_in_configs_is_that_of_the_first_count(self):
        self.assertEqual((SCENES / "plate.obj").read_text(encoding="utf-8"), plate_mesh(PLATE, PLATE.counts[0]))

    def test_tread_accepts_the_finest_settings(self):
        def check(problem):
            mesh = self.folder / "plate.obj"
            if problem is PLATE:
                mesh.write_text(plate_mesh(problem, problem.counts[-1]), encoding="utf-8")
            settings = [f"--set={setting}" for setting in settings_of(problem, problem.counts[-1], mesh)]
            return subprocess.run([TREAD, "check", str(problem.scene), *settings], capture_output=True, text=True, timeout=240, check=False)

        with ThreadPoolExecutor(2) as pool:
            for problem, done in zip(PROBLEMS.values(), pool.map(check, PROBLEMS.values())):
                self.assertEqual(done.returncode, 0, f"{problem.name}: {done.stderr}")


class ReferenceTest(unittest.TestCase):
    def test_cylinder_load_is_the_integral_of_its_pressure(self):
        """2 R times the integral of c (2 + pi - 2 theta) cos(theta), by the midpoint rule."""
        radius, cohesion, depth = 0.24, 5000.0, 0.02
        step = math.acos(1 - depth / radius) / 20000
        angles = (np.arange(20000) + 0.5) * step
        expected = 2 * radius * step * float(np.sum(cohesion * (PRANDTL - 2 * angles) * np.cos(angles)))
        measured = cylinder_load(radius, cohesion, depth)
        print(f"cylinder: {measured:.6f} N/m, expected {expected:.6f}, tolerance 1e-8 of it: the rule's error is of the order step^2 / 24 = {step**2 / 24:.1e}")
        self.assertLess(abs(measured / expected - 1), 1e-8)

    def test_a_shallow_cylinder_is_a_strip(self):
        """Prandtl's load on the chord, less a share of the order of half the edge's angle."""
        radius, cohesion, depth = 0.24, 5000.0, 1e-8
        edge = math.acos(1 - depth / radius)
        measured, expected = cylinder_load(radius, cohesion, depth), PRANDTL * cohesion * 2 * radius * math.sin(edge)
        print(f"shallow cylinder: {measured:.6f} N/m, expected {expected:.6f}, tolerance {edge:.1e} of it, the angle at the edge")
        self.assertLess(abs(measured / expected - 1), edge)


class ReportTest(LadderTest):
    def check(self, what, measured, expected, tolerance, why):
        print(f"{what}: {measured:.10g}, expected {expected:.10g}, tolerance {tolerance:.2g}: {why}")
        self.assertLess(abs(measured - expected), tolerance)

    def test_order_and_limit_of_plates_come_back(self):
        limit, slope, order, counts = 5.1, 40.0, 0.94, (10, 20, 32)
        for count in counts:
            h = PLATE.length / count
            time = np.linspace(0, 0.075, 201)
            load = (limit + slope * h**order) * 0.5 * PLATE.length * COHESION * width_of(PLATE, count)
            # Before the last quarter the plate carries something else.
            make_run(self.output, PLATE, count, columns_of(time, np.where(time < 0.056, 0.3 * load, load), sinkage=0.02 * time))
        rows = self.rows(PLATE, counts, "load_over_c")
        self.assertEqual([float(row["count"]) for row in rows], list(counts))
        for row in rows:
            self.check("load/c", float(row["value"]), limit + slope * float(row["spacing"])**order, 1e-9, "rounding")
            self.check("limit", float(row["limit"]), limit, 1e-6, "rounding, which the extrapolation magnifies")
            self.check("order", float(row["order"]), order, 1e-6, "the same")
            self.assertEqual((float(row["reference"]), row["kind"]), (PRANDTL, "exact"))
        self.assertGreater(colours_of(self.output / "ladder.png"), 20)
        self.assertIn("order 0.94", (self.output / "ladder.txt").read_text())

    def test_noise_of_a_drive_becomes_a_range_of_the_order(self):
        limit, slope, order, sigma, counts = -100.0, 30000.0, 1.0, 5.0, (12, 20, 34, 50)
        random, time = np.random.default_rng(5), np.arange(0, END + 1e-9, 0.005)
        for count in counts:
            h, width = SAND.length / count, width_of(SAND, count)
            pull = (limit + slope * h**order + random.normal(0, sigma, len(time))) * width
            make_run(self.output, SAND, count, columns_of(time, SAND.load * width, torque=500 * width, speed=0.6 * SPIN * SAND.length, pull=pull))
        rows = self.rows(SAND, counts, "pull")
        window = int(0.5 * (END - RAMP) / 0.005)
        for row in rows:
            self.check("standard error / (sigma / sqrt n)", float(row["noise"]) / (sigma / math.sqrt(window)), 1.0, 0.75,
                       "three standard deviations of one from eight parts, 1 / sqrt(2 x 7) each, less the line taken out")
        found = re.search(r"order ([\d.]+) \(([\d.]+) to ([\d.]+)\)", rows[0]["text"])
        self.assertIsNotNone(found, rows[0]["text"])
        value, low, high = (float(part) for part in found.groups())
        print(f"order {value} ({low} to {high}), expected {order} within the stated range, which must not be empty")
        self.assertTrue(low <= order <= high and low < high)
        force = self.rows(SAND, counts, "force")
        self.assertTrue(all(abs(float(row["value"]) - SAND.load) < 1e-9 * SAND.load for row in force))

    def test_a_ringing_push_states_no_exact_limit(self):
        counts, time = (10, 20, 32), np.linspace(0, 0.075, 401)
        for count in counts:
            scale, ringing = 0.5 * PLATE.length * COHESION * width_of(PLATE, count), 0.3 * np.sin(2 * np.pi * time / 0.0075)
            make_run(self.output, PLATE, count, columns_of(time, (5.1 + 4.0 / count + ringing) * scale))
        rows = self.rows(PLATE, counts, "load_over_c")
        self.assertTrue(all(float(row["noise"]) > 0.01 for row in rows), rows)
        self.assertNotRegex(rows[0]["text"], r"^extrapolated, order [\d.]+$")

    def test_cylinders_and_rolling_drums_are_held_against_their_references(self):
        time = np.linspace(0, 0.4, 401)
        depth = 0.05 * time
        force = np.array([1.1 * cylinder_load(CYLINDER.length, COHESION, one) for one in depth]) * width_of(CYLINDER, 12)
        make_run(self.output, CYLINDER, 12, columns_of(time, force, sinkage=depth))
        (row,) = self.rows(CYLINDER, (12,), "load_over_level_soil")
        self.check("cylinder over level soil", float(row["value"]), 1.1, 1e-12, "rounding")
        self.assertEqual((row["kind"], row["limit"], row["text"]), ("at least", "nan", "one value"))
        time = np.arange(0, 0.8, 0.005)
        # Faster in the first half of the drive, which must not count.
        speed = SPIN * ELASTIC.length * np.where(time < 0.4, 1.5, 1.002)
        make_run(self.output, ELASTIC, 12, columns_of(time, ELASTIC.load * width_of(ELASTIC, 12), speed=speed))
        (row,) = self.rows(ELASTIC, (12,), "speed_over_rim_speed")
        self.check("speed over rim speed", float(row["value"]), 1.002, 1e-9, "rounding")

    def test_mixed_runs_are_refused(self):
        for count, settings in ((10, ()), (20, ("material[0].young=2e6",))):
            make_run(self.output, PLATE, count, columns_of(np.linspace(0, 0.075, 201), 1.0), settings)
        done = self.ladder("report", "--output", self.output, code=2)
        for part in ("plate_clay/10 was made with no --set", "plate_clay/20 with --set material[0].young=2e6"):
            self.assertIn(part, done.stderr)
        self.assertFalse((self.output / "ladder.csv").exists())

    def test_shared_settings_head_the_table(self):
        make_run(self.output, PLATE, 10, columns_of(np.linspace(0, 0.075, 201), 1.0), ("material[0].young=2e6",))
        self.assertTrue(self.ladder("report", "--output", self.output).stdout.startswith("Runs with --set material[0].young=2e6\n"))

    def test_without_runs_or_arguments(self):
        self.assertIn("no finished run", self.ladder("report", "--output", self.output, code=1).stderr)
        make_run(self.output, PLATE, 10, columns_of(np.linspace(0, 0.075, 201), 1.0))
        self.assertIn("--set changes runs", self.ladder("report", "--output", self.output, "--set", "a=1", code=2).stderr)
        (self.output / "plate_clay" / "10" / "timeseries.h5").unlink()
        self.assertIn("timeseries.h5", self.ladder("report", "--output", self.output, code=2).stderr)
        for wrong in ("{", "[]", '{"set": 3}', "{}"):
            (self.output / "plate_clay" / "10.json").write_text(wrong)
            self.assertIn("does not say with which --set", self.ladder("report", "--output", self.output, code=2).stderr)


class RunTest(LadderTest):
    def setUp(self):
        super().setUp()
        self.program = self.folder / "tread"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)

    def run_ladder(self, *arguments, code=0):
        return self.ladder("run", "--program", self.program, "--output", self.output, "--problems", "plate_clay,drum_sand", "--spacings", "12,20", *arguments,
                           code=code)

    def starts(self):
        path = self.folder / "starts.txt"
        return path.read_text().splitlines() if path.exists() else []

    def test_finished_runs_are_kept(self):
        self.run_ladder("--set", "a=1", "--set", "b=2", "--threads", "1")
        self.assertEqual(len(self.starts()), 4)
        self.assertTrue(all("--set a=1 --set b=2" in start and "--threads 1" in start for start in self.starts()))
        self.assertEqual(json.loads((self.output / "drum_sand" / "20.json").read_text()), {"set": {"a": "1", "b": "2"}})
        # The order does not matter, and the last of a key counts.
        self.run_ladder("--set", "b=3", "--set", "b=2", "--set", "a=1")
        self.assertEqual(len(self.starts()), 4)

    def test_another_set_is_refused(self):
        self.run_ladder("--set", "a=1")
        for arguments, text in ((("--set", "a=2"), "--set a=2"), ((), "no --set"), (("--set", "a=1", "--set", "b=1"), "--set a=1 --set b=1")):
            done = self.run_ladder(*arguments, code=2)
            self.assertRegex(done.stderr, r"/12 was made with --set a=1, this command has " + re.escape(text) + ": use another --output")
        # Also where none of the runs asked for is there yet.
        self.ladder("run", "--program", self.program, "--output", self.output, "--problems", "drum_elastic", "--spacings", "12", code=2)
        self.assertEqual(len(self.starts()), 4)

    def test_finished_runs_of_unknown_settings_are_refused(self):
        self.run_ladder()
        (self.output / "plate_clay" / "12.json").unlink()
        self.assertIn("does not say with which --set", self.run_ladder(code=2).stderr)

    def test_a_run_that_fails_is_made_again_with_any_settings(self):
        done = self.run_ladder("--set", "title=fail", code=1)
        self.assertIn("no such soil", done.stderr)
        self.assertIn("plate_clay 12: exit 1", done.stdout)
        self.run_ladder()
        self.assertEqual(len(self.starts()), 8)

    def test_bad_values_are_named(self):
        for arguments, message in ((("--spacings", "12,x"), "'12,x': accepted: even numbers above 0"), (("--spacings", "0"), "even numbers"),
                                   (("--spacings", "33"), "'33': accepted: even numbers"), (("--spacings", ""), "even numbers"),
                                   (("--spacings=-4",), "even numbers"), (("--problems", "plate_clay,mud"), "mud: accepted: plate_clay, cylinder_clay"),
                                   (("--threads", "0"), "'0': accepted: whole numbers"), (("--threads", "two"), "'two': accepted"),
                                   (("--set", "young"), "'young': accepted: KEY=VALUE"), (("--set", "=3"), "KEY=VALUE"), (("--set", "a="), "KEY=VALUE"),
                                   (("--backend", "gpu"), "'gpu'"), (("--set", "grid.spacing=0.01"), "grid.spacing: the ladder sets this key itself"),
                                   (("--set", "body.drum.load=9"), "body.drum.load: the ladder sets"),
                                   (("--program", self.folder / "nothing"), "not found, or not executable")):
            with self.subTest(arguments=arguments):
                self.assertIn(message, self.run_ladder(*arguments, code=2).stderr)
        self.output.write_text("a file")
        self.assertIn("is not a directory", self.run_ladder(code=2).stderr)
        self.assertEqual(self.starts(), [])


if __name__ == "__main__":
    unittest.main()
