#!/usr/bin/env python3
"""Scenes that nobody can mean, and what `tread check` says of each: a warning with the value that seems meant, or a refusal (exit code 2).

No scene of configs/ warns: paper_checks.py."""

import json
import re
import unittest

from command import CommandTest

# A driven wheel on a bed; sensible as it stands.
BASE = """\
title = "a wheel on a bed"

[domain]
size    = [1.0, 0.6, 0.6]
gravity = [0.0, 0.0, -9.81]

[grid]
spacing = 0.04

[time]
dt = "auto"

[[material]]
name               = "sand"
model              = "mohr-coulomb"
density            = 1600.0
young              = 1.0e6
poisson            = 0.3
friction_angle_deg = 32.0
dilation_angle_deg = 0.0
cohesion           = 0.0

[[material]]
name   = "steel"
model  = "rigid"
young  = 1.0e9

[[contact]]
between  = ["steel", "sand"]
friction = 0.4

[[shape]]
name      = "wheel"
generate  = { kind = "wheel", radius = 0.15, width = 0.15, wall_thickness = 0.04, grousers = 0, grouser_height = 0.0 }
sdf_cells = 24
node_spacing = 0.02

[[terrain]]
material = "sand"
region   = { box = [[0.0, 0.0, 0.0], [1.0, 0.6, 0.16]] }

[[body]]
name     = "wheel"
shape    = "wheel"
material = "steel"
mass     = 20.0
position = [0.3, 0.3, 0.33]

[[phase]]
name         = "drop"
until        = "equilibrium"
max_duration = 0.5

[[phase]]
name     = "drive"
duration = 2.0
drive    = { body = "wheel", angular_velocity = 0.7, ramp = 0.2, slip = 0.3 }
"""

# What is set, the words of the warning, and the table whose line it names.
WARNED = {
    "gravity upwards": (["domain.gravity=[0,0,9.81]"], ["points upwards", "z = -9.81"], "[domain]"),
    "gravity in cm/s2": (["domain.gravity=[0,0,-981]"], ["9.81 (given in cm/s2?)"], "[domain]"),
    "a bed steeper than its sand stands": (["domain.gravity=[-8,0,-5]"], ["58 degrees", "32 degrees", "slides"], "[domain]"),
    "density in g/cm3": (["material.sand.density=1.6"], ["1600 seems meant (given in g/cm3?)"], 'name               = "sand"'),
    "modulus in kPa": (["material.sand.young=1000"], ["too soft", "1e+06 seems meant"], 'name               = "sand"'),
    "modulus in MPa": (["material.sand.young=10"], ["too soft", "1e+07 seems meant"], 'name               = "sand"'),
    "modulus of the grains": (["material.sand.young=5e10"], ["too stiff", "5e+07 seems meant"], 'name               = "sand"'),
    "friction angle in radians": (["material.sand.friction_angle_deg=0.5585"], ["32 seems meant (given in radians?)"], 'name               = "sand"'),
    "dilation angle in radians": (["material.sand.dilation_angle_deg=0.1"], ["5.73 seems meant (given in radians?)"], 'name               = "sand"'),
    "cohesion of a rock": (["material.sand.cohesion=5e6"], ["cohesion", "5000 seems meant"], 'name               = "sand"'),
    "contact friction in degrees": (["contact[0].friction=30"], ["0.577 seems meant", "30 degrees"], "between  = "),
    "a ramp longer than its phase": (["phase.drive.drive.ramp=5"], ["drive.ramp = 5 s", "never reaches its speed"], 'name     = "drive"'),
    "mass in grams": (["body.wheel.mass=20000"], ["times as dense as 'sand'", "20 kg (196.2 N) seem meant"], "mass     = 20.0"),
    "mass in tonnes": (["body.wheel.mass=0.02"], ["times as dense as 'sand'", "20 kg (196.2 N) seem meant"], "mass     = 20.0"),
    "a wheel that its bed cannot bear": (["body.wheel.mass=3000"], ["up to its axle"], "mass     = 20.0"),
    "a wheel beside the side wall": (["body.wheel.position=[0.3,0.1,0.33]"], ["0.025 m of bed lie beside", "0.075 m would keep"], "mass     = 20.0"),
    "a wheel beside the sand": (["terrain[0].region.box=[[0.6,0,0],[1,0.6,0.16]]"], ["no sand lies under it", "x 0.61 to 0.99 m"], "mass     = 20.0"),
    "a bed too shallow": (["terrain[0].region.box=[[0,0,0],[1,0.6,0.04]]", "body.wheel.position=[0.3,0.3,0.21]"],
                          ["0.04 m deep", "stands on the floor"], "mass     = 20.0"),
    "rolling radius in cm": (["body.wheel.rolling_radius=15"], ["rolling_radius = 15 m", "0.15 seems meant"], "mass     = 20.0"),
    "a wheel high above the bed": (["domain.size=[1,0.6,6]", "body.wheel.position=[0.3,0.3,3]"], ["hangs 2.69 m above", "position[2] = 0.315"], "mass     = 20.0"),
    "a wheel in mm": (["domain.size=[400,240,200]", "grid.spacing=16", "shape.wheel.generate.radius=60", "shape.wheel.generate.width=60",
                       "shape.wheel.generate.wall_thickness=16", "shape.wheel.node_spacing=8",
                       "terrain[0].region.box=[[0,0,0],[400,240,64]]", "body.wheel.position=[120,120,140]"],
                      ["60 m radius", "0.06 m seems meant (given in mm?)"], "mass     = 20.0"),
    "spin in degrees per second": (["phase.drive.drive.angular_velocity=400"], ["rim at 60 m/s", "6.98"], 'name     = "drive"'),
    "a grid that does not see the wheel": (["grid.spacing=0.2", "body.wheel.position=[0.3,0.3,0.45]"], ["0.56 cells across", "would have 6"], "mass     = 20.0"),
    "lowered in mm/s": (["phase.drop.until=lowered", "phase.drop.lower={body='wheel',speed=5,share=1}"],
                        ["lower.speed = 5 m/s", "0.005 seems meant"], 'name         = "drop"'),
    "a step over the automatic one": (["time.dt=1e-3"], ["times the automatic step"], "[time]"),
    "a step that no sand bears": (["time.dt=1e-2"], ["times the automatic step", "will stop at once"], "[time]"),
    "a step of a picosecond": (["time.dt=1e-12"], ["the run takes 2.5e+12 steps"], "[time]"),
    "a drive of thirty years": (["phase.drive.duration=1e9"], ["years of wall time even on one GPU"], "[time]"),
    "a snapshot each microsecond": (["output.snapshots_every=1e-6"], ["2.5e+06 snapshots", "0.025 would give a hundred"], None),
    "a row each nanosecond": (["output.every=1e-9"], ["2.5e+09 rows"], None),
}

# Where one mistake has several consequences that are each worth a warning.
MORE = {"a wheel in mm", "mass in tonnes", "a step of a picosecond", "a drive of thirty years", "a row each nanosecond", "rolling radius in cm", "spin in degrees per second"}

# What is set, and words of the refusal.
REFUSED = {
    "slip in percent": (["phase.drive.drive.slip=30"], ["slip", "-1"]),
    "an incompressible sand": (["material.sand.poisson=0.5"], ["poisson", "0.499"]),
    "more dilation than friction": (["material.sand.dilation_angle_deg=35"], ["dilation_angle_deg", "32"]),
    "a wheel wider than its bed": (["shape.wheel.generate.width=0.7"], ["'wheel'", "wall"]),
    "a wheel in the sand": (["body.wheel.position=[0.3,0.3,0.2]"], ["'wheel'", "stand inside it"]),
    "a wheel outside": (["body.wheel.position=[3,0.3,0.33]"], ["position"]),
    "time that goes back": (["phase.drive.duration=-2"], ["duration"]),
    "sand of no mass": (["material.sand.density=0"], ["density", ">= 0.001"]),
}


class NonsenseScenes(CommandTest):
    def check(self, overrides):
        scene = self.write("scene.toml", BASE)
        return self.tread("check", scene, *[part for one in overrides for part in ("--set", one)])

    def warnings(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stdout.splitlines()
        told = [line for line in lines if line.startswith("warning: ")]
        self.assertEqual(told, lines[:len(told)], "warnings are not the first lines")
        return told

    def test_the_base_warns_of_nothing(self):
        self.assertEqual(self.warnings(self.check([])), [])

    def test_thirty_scenes_and_more(self):
        self.assertGreaterEqual(len(WARNED) + len(REFUSED), 30)

    def test_what_is_warned_of(self):
        for name, (overrides, words, table) in WARNED.items():
            with self.subTest(name):
                told = self.warnings(self.check(overrides))
                print(f"{name}: {' '.join(overrides)}\n    " + "\n    ".join(told))
                found = [line for line in told if all(word in line for word in words)]
                self.assertEqual(len(found), 1, f"{words} in {told}")
                self.assertTrue(name in MORE or len(told) == 1, f"more than one warning: {told}")
                if table is not None:
                    header = BASE[:BASE.index(table)].splitlines() if not table.startswith("[") else BASE[:BASE.index(table) + 1].splitlines()
                    line = max(number for number, text in enumerate(header, 1) if text.startswith("["))
                    self.assertIn(f"scene.toml:{line}: ", found[0])

    def test_what_is_refused(self):
        for name, (overrides, words) in REFUSED.items():
            with self.subTest(name):
                result = self.check(overrides)
                print(f"{name}: {' '.join(overrides)}\n    {result.stderr.strip()}")
                self.assertEqual(result.returncode, 2, result.stdout)
                for word in words:
                    self.assertIn(word, result.stderr)

    def test_a_run_warns_too_and_its_exit_code_does_not_change(self):
        scene = self.write("scene.toml", BASE)
        short = ["--set", "phase.drop.max_duration=0.002", "--set", "phase.drive.duration=0.002", "--set", "contact[0].friction=30"]
        result = self.tread("run", scene, "--output", self.output, "--backend", "cpu", *short)
        self.assertEqual(result.returncode, 0, result.stderr)
        told = json.loads((self.output / "summary.json").read_text())["warnings"]
        self.assertEqual(len([line for line in told if "0.577 seems meant" in line]), 1, told)
        self.assertEqual(len([line for line in told if "drive.ramp" in line]), 1, told)
        log = (self.output / "log.txt").read_text()
        for line in told:
            self.assertIn(f"warning: {line}\n", log)

    def test_a_run_that_fails_is_under_resolved_in_log_and_summary(self):
        scene = self.write("scene.toml", BASE)
        result = self.tread("run", scene, "--output", self.output, "--backend", "cpu", "--set", "time.dt=1e-2")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertEqual(json.loads((self.output / "summary.json").read_text())["resolution"]["verdict"], "under-resolved")
        verdicts = re.findall(r"^resolution: ([a-z-]+)", (self.output / "log.txt").read_text(), re.MULTILINE)
        self.assertEqual(verdicts, ["under-resolved"])


if __name__ == "__main__":
    unittest.main()
