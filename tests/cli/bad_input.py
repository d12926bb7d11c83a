#!/usr/bin/env python3
"""Every way to ask for the impossible: exit code 2 or 4, a message that helps, and no file written."""

import re
import struct
import unittest

from command import BODY, SCENE, CommandTest, line_of


class GoodScene(CommandTest):
    """What the cases below spoil is right as it stands."""

    def test_base_is_valid(self):
        for text in (SCENE, SCENE + BODY):
            result = self.tread("check", self.write("scene.toml", text))
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_mesh_is_valid(self):
        (self.directory / "mesh.stl").write_bytes(binary_stl(cube(0.1)))
        result = self.tread("check", self.write("scene.toml", with_mesh("mesh.stl")))
        self.assertEqual(result.returncode, 0, result.stderr)


class RefusedScene(CommandTest):
    """Exit 2, a message, and nothing written."""

    def refuse(self, text, mentions, code=2):
        scene = self.write("scene.toml", text)
        before = self.files()
        result = self.tread("run", scene, "--output", self.output)
        self.assertEqual(result.returncode, code, result.stderr)
        for part in mentions:
            self.assertIn(part, result.stderr)
        self.assertEqual(self.files(), before, "files were written")
        return result.stderr


class BadScene(RefusedScene):
    """Each case spoils one line of a valid scene; the message names file, line and key."""

    def refuse_value(self, old, new, mentions, text=SCENE):
        self.assertIn(old, text)
        spoiled = text.replace(old, new, 1)
        return self.refuse(spoiled, [f"scene.toml:{line_of(spoiled, new)}", *mentions])

    def test_malformed_toml(self):
        self.refuse_value("spacing = 0.05", "spacing = = 0.05", [])

    def test_wrong_type(self):
        self.refuse_value("spacing = 0.05", 'spacing = "coarse"', ["spacing", "number"])

    def test_not_a_number(self):
        self.refuse_value("young              = 1.0e6", "young              = nan", ["young"])

    def test_negative_density(self):
        self.refuse_value("density            = 1600.0", "density            = -1600.0", ["density", ">= 0.001"])

    def refuse_walls(self, walls, mentions):
        old = "gravity = [0.0, 0.0, -9.81]\n"
        self.assertIn(old, SCENE)
        self.refuse(SCENE.replace(old, f"{old}walls = {{ {walls} }}\n", 1), mentions)

    def test_wall_friction_below_zero(self):
        self.refuse_walls('bottom = "frictional", friction = -0.1', ["friction", ">= 0"])

    def test_unknown_wall(self):
        self.refuse_walls('bottom = "sticky"', ["bottom", "frictional"])

    def test_incompressible(self):
        self.refuse_value("poisson            = 0.3", "poisson            = 0.5", ["poisson", "0.5"])

    def test_dilation_above_friction(self):
        self.refuse_value("dilation_angle_deg = 0.0", "dilation_angle_deg = 31.0", ["dilation_angle_deg", "30"])

    def test_cone_fit_of_a_hexagon(self):
        self.refuse_value("cohesion           = 0.0", 'drucker_prager_fit = "compression"', ["drucker_prager_fit"])

    def test_cone_without_a_fit(self):
        text = SCENE.replace('"mohr-coulomb"', '"drucker-prager"', 1)
        self.refuse(text, ["drucker_prager_fit: missing", "plane-strain"])

    def test_sleep(self):
        self.refuse(SCENE + "[sleep]\ndistance = 0.0\n", ["sleep", "distance", "> 0"])
        self.refuse(SCENE + "[sleep]\nspeed = 0.1\n", ["sleep", "speed", "distance given"])
        self.refuse(SCENE + "[sleep]\nrock_speed = 0.0\n", ["sleep", "rock_speed", ">= 1e-09"])
        self.refuse(SCENE + "[sleep]\nrock_load = 0.1\n", ["sleep", "rock_load", "rock_speed given"])

    def test_refined_grid(self):
        def refuse(boxes, mentions, more=""):
            line = "spacing = 0.05\nrefine = " + boxes
            self.refuse(SCENE.replace("spacing = 0.05", line, 1) + more, ["scene.toml:", "refine", *mentions])

        box = "[[0.1, 0.1, 0.1], [0.3, 0.3, 0.4]]"
        refuse("[[[0.3, 0.1, 0.1], [0.1, 0.3, 0.4]]]", ["empty"])
        refuse(f"[{box}, {box}, {box}, {box}]", ["at most 3 boxes"])
        refuse(f"[{box}]", ["box 0", "along x", "4 cells of 0.05 m inside the walls"])
        refuse(f"[{box}]", ["quadratic"], '[numerics]\nshape_functions = "linear"\n')
        refuse(f"[{box}]", ["sleep"], "[sleep]\ndistance = 0.3\n")

    def test_unknown_volume_strain(self):
        self.refuse(SCENE + '[numerics]\nvolume_strain = "nodes"\n', ["volume_strain", "cell-average"])

    def test_unknown_narrow_phase(self):
        self.refuse(SCENE + '[numerics]\nnarrow_phase = "ray"\n', ["narrow_phase", "sdf", "rays"])

    def test_refinement_below_a_negative_size(self):
        self.refuse(SCENE + "[numerics]\nrefine_below = -1\n", ["refine_below", ">= 0"])

    def test_misspelt_key(self):
        self.refuse_value("cohesion           = 0.0", "cohession          = 0.0", ["cohession", "cohesion"])

    def test_body_outside_the_domain(self):
        self.refuse_value("[0.2, 0.2, 0.3]", "[0.2, 0.2, 1.3]", ["position"], SCENE + BODY)

    def test_every_error_at_once(self):
        text = SCENE.replace("spacing = 0.05", "spacing = -1").replace("duration = 0.02", "duration = -2")
        self.refuse(text, ["spacing", "duration"])

    def test_override_names_itself(self):
        scene = self.write("scene.toml", SCENE)
        result = self.tread("run", scene, "--output", self.output, "--set", "material.sand.densitty=1")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("--set", result.stderr)
        self.assertIn("densitty", result.stderr)
        self.assertEqual(self.files(), ["scene.toml"])


class BadWorld(RefusedScene):
    """What only shows once the scene's world is built names the line of its table."""

    def refuse_table(self, header, old, new, mentions, text=SCENE + BODY):
        self.assertIn(old, text)
        self.refuse(text.replace(old, new, 1), [f"scene.toml:{line_of(text, header)}: ", *mentions])

    def test_terrain_without_a_point(self):
        self.refuse_table("[[terrain]]", "[0.4, 0.4, 0.1]]", "[0.4, 0.4, 1e-9]]", ["[[terrain]] 0", "no point"])

    def test_rocks_that_do_not_fit(self):
        rocks = """
[[rocks]]
shape    = "roller"
material = "steel"
count    = 99
diameter = 0.1
region   = { box = [[0.0, 0.0, 0.1], [0.4, 0.4, 0.4]] }
"""
        text = SCENE + rocks
        self.refuse(text, [f"scene.toml:{line_of(text, '[[rocks]]')}: [[rocks]] 0", "count = 99"])

    def test_shape_that_cannot_be_made(self):
        rock = 'kind = "rock", seed = 7, aspect = 0.5, sphericity = 0.99'
        wheel = 'kind = "wheel", radius = 0.06, width = 0.06, wall_thickness = 0.03, grousers = 0, grouser_height = 0.0'
        sized = (SCENE + BODY).replace("mass     = 1.0", "mass     = 1.0\ndiameter = 0.1")
        self.refuse_table("[[shape]]", wheel, rock, ["shape 'roller'", "sphericity"], sized)

    def test_body_in_the_sand(self):
        self.refuse_table("[[body]]", "[0.2, 0.2, 0.3]", "[0.2, 0.2, 0.1]", ["[[body]] 'roller'", "sand"])

    def test_body_in_a_wall(self):
        self.refuse_table("[[body]]", "[0.2, 0.2, 0.3]", "[0.399, 0.2, 0.3]", ["[[body]] 'roller'", "position", "wall"])

    def test_body_in_another(self):
        text = SCENE + BODY + BODY.replace('name     = "roller"', 'name     = "second"')
        second = text.rindex("[[body]]")
        self.refuse(text, [f"scene.toml:{text[:second].count(chr(10)) + 1}: [[body]] 'second'", "'roller'"])


class BadMesh(CommandTest):
    """Meshes are read before the run directory is made."""

    def refuse(self, mesh, mentions):
        (self.directory / "mesh.stl").write_bytes(mesh)
        scene = self.write("scene.toml", with_mesh("mesh.stl"))
        result = self.tread("run", scene, "--output", self.output)
        self.assertEqual(result.returncode, 2, result.stderr)
        for part in mentions:
            self.assertIn(part, result.stderr)
        self.assertEqual(self.files(), ["mesh.stl", "scene.toml"], "files were written")

    def test_no_triangles(self):
        self.refuse(binary_stl([]), ["mesh.stl", "no triangles"])

    def test_truncated(self):
        self.refuse(binary_stl(cube(0.1))[:-7], ["mesh.stl"])

    def test_open_surface(self):
        self.refuse(binary_stl(cube(0.1)[:-1]), ["roller", "not watertight", "open edges"])

    def test_millimetres_read_as_metres(self):
        self.refuse(binary_stl(cube(100.0)), ["roller", "unit"])

    def test_missing_mesh(self):
        scene = self.write("scene.toml", with_mesh("nowhere.stl"))
        result = self.tread("run", scene, "--output", self.output)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("nowhere.stl", result.stderr)
        self.assertEqual(self.files(), ["scene.toml"])


class BadBed(CommandTest):
    """Beds of rocks that are saved, and that other scenes start from."""

    BALLS = """
[[shape]]
name     = "ball"
generate = { kind = "sphere", nodes = 42 }
[[rocks]]
shape     = "ball"
material  = "steel"
count     = 2
diameter  = 0.05
placement = "rain"
region    = { box = [[0.0, 0.0, 0.2], [0.4, 0.4, 0.4]] }
"""
    FROM = BALLS[: BALLS.index("count")] + 'from     = "bed.h5"\n'
    NO_SAND = re.sub(r"\[\[terrain\]\]\n.*\n.*\n", "", SCENE)

    def refuse(self, text, mentions):
        scene = self.write("scene.toml", text)
        before = self.files()
        result = self.tread("run", scene, "--output", self.output)
        self.assertEqual(result.returncode, 2, result.stderr)
        for part in mentions:
            self.assertIn(part, result.stderr)
        self.assertEqual(self.files(), before, "files were written")

    def saving(self, text, phase):
        return text.replace("[output]", f'[output]\nbed_after = "{phase}"')

    def test_unknown_phase(self):
        self.refuse(self.saving(self.NO_SAND + self.BALLS, "reset"), ["bed_after", "reset", "rest"])

    def test_missing_bed_of_sand(self):
        sand = SCENE[: SCENE.index("region")] + 'from = "bed.h5"' + SCENE[SCENE.index("\n", SCENE.index("region")) :]
        self.refuse(sand, ["terrain[0]", "from", "bed.h5"])

    def test_bed_without_rocks(self):
        self.refuse(self.saving(self.NO_SAND + BODY, "rest"), ["bed_after", "rocks"])

    def test_missing_bed(self):
        self.refuse(SCENE + self.FROM, ["rocks[0]", "from", "bed.h5"])

    def test_no_bed(self):
        (self.directory / "bed.h5").write_text("no bed")
        self.refuse(SCENE + self.FROM, ["[[rocks]] 0", "from", "bed.h5", "accepted"])

    def test_drawn_and_from_a_bed(self):
        (self.directory / "bed.h5").write_text("no bed")
        self.refuse(SCENE + self.FROM + "count = 2\n", ["count", "`from`"])

    def test_rolling_friction(self):
        contact = '[[contact]]\nbetween = ["steel", "wall"]\nrolling_friction = 1.5\n'
        self.refuse(SCENE + contact, ["rolling_friction", "<= 1"])

    def test_saved_bed_starts_another_scene(self):
        result = self.tread("run", self.write("first.toml", self.saving(self.NO_SAND + self.BALLS, "rest")), "--output",
                            self.directory / "first", "--backend", "cpu")
        self.assertEqual(result.returncode, 0, result.stderr)
        again = (self.NO_SAND + self.FROM).replace("bed.h5", "first/bed.h5")
        result = self.tread("run", self.write("again.toml", again), "--output", self.output, "--backend", "cpu")
        self.assertEqual(result.returncode, 0, result.stderr)


class BadPlace(CommandTest):
    """The scene is right; where it should run is not."""

    def run_into(self, output, *more):
        scene = self.write("scene.toml", SCENE)
        return self.tread("run", scene, "--output", output, *more)

    def test_missing_scene(self):
        result = self.tread("run", self.directory / "nowhere.toml", "--output", self.output)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("nowhere.toml", result.stderr)
        self.assertEqual(self.files(), [])

    def test_output_below_a_file(self):
        (self.directory / "taken").write_text("a file\n")
        result = self.run_into(self.directory / "taken" / "run")
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("taken/run", result.stderr)
        self.assertEqual(self.files(), ["scene.toml", "taken"])

    def test_output_that_nobody_can_write(self):
        # /proc refuses new directories to root too, whom permissions do not stop
        result = self.run_into("/proc/tread/run")
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("/proc/tread", result.stderr)
        self.assertEqual(self.files(), ["scene.toml"])

    def test_run_that_is_there_already(self):
        self.output.mkdir()
        (self.output / "scene.toml").write_text("of an earlier run\n")
        result = self.run_into(self.output)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("--overwrite", result.stderr)
        self.assertIn(str(self.output), result.stderr)
        self.assertEqual((self.output / "scene.toml").read_text(), "of an earlier run\n")
        self.assertEqual(self.files(), ["run", "run/scene.toml", "scene.toml"])


class BadLaunch(CommandTest):
    """How the program was started."""

    def test_tasks_that_mpi_does_not_know(self):
        scene = self.write("scene.toml", SCENE)
        launcher = ("env", "SLURM_STEP_NUM_TASKS=4")
        result = self.tread("run", scene, "--output", self.output, launcher=launcher)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("--mpi=pmix", result.stderr)
        self.assertEqual(self.files(), ["scene.toml"])

    def test_arguments(self):
        for arguments in (["frobnicate"], ["run"], ["run", "a.toml", "--bogus"], ["run", "a.toml", "--backend", "tpu"],
                          ["run", "a.toml", "--threads", "0"], []):
            with self.subTest(arguments):
                result = self.tread(*arguments)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn("--help", result.stderr)
        self.assertEqual(self.files(), [])


def with_mesh(name):
    """The scene with a body whose shape is a mesh file."""
    return re.sub("^generate .*$", f'file = "{name}"', SCENE + BODY, flags=re.MULTILINE).replace("node_spacing = 0.0075\n", "")


def cube(edge):
    """Twelve triangles, counter-clockwise from outside."""
    corners = [(x * edge, y * edge, z * edge) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [tuple(corners[i] for i in triangle) for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]


def binary_stl(triangles):
    data = b" " * 80 + struct.pack("<I", len(triangles))
    for triangle in triangles:
        data += struct.pack("<12fH", 0, 0, 0, *(value for corner in triangle for value in corner), 0)
    return data


if __name__ == "__main__":
    unittest.main()
