#!/usr/bin/env python3
"""Text and numbers that no honest scene has: refused with place, figure and accepted range, before memory is taken."""

import os
import resource
import unittest

from command import BODY, SCENE, CommandTest, line_of

GIB = 1 << 30

ROCKS = """
[[shape]]
name      = "ball"
generate  = { kind = "sphere", nodes = 42 }
sdf_cells = 16

[[rocks]]
shape     = "ball"
material  = "steel"
count     = 5
diameter  = 0.02
placement = "grid"
region    = { box = [[0.0, 0.0, 0.15], [0.4, 0.4, 0.4]] }
"""


class HostileInput(CommandTest):
    """`check` and `run` under an address space of 4 GiB; what they refuse, both refuse, and write nothing."""

    memory = 4 * GIB

    def tread(self, *arguments):
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (self.memory, self.memory))
        return super().tread(*arguments, before=limit)

    def refuse(self, text, mentions, code=2, arguments=()):
        scene = self.write("scene.toml", text)
        before = self.files()
        for command in (("check", scene), ("run", scene, "--output", self.output)):
            result = self.tread(*command, *arguments)
            self.assertEqual(result.returncode, code, f"{result.stderr[:2000]}{result.stdout[:2000]}")
            for part in mentions:
                self.assertIn(part, result.stderr)
            self.assertLess(len(result.stderr), 2000)
            self.assertEqual(self.files(), before, "files were written")

    def refuse_value(self, old, new, mentions, text=SCENE, code=2):
        self.assertIn(old, text)
        spoiled = text.replace(old, new, 1)
        self.refuse(spoiled, [f"scene.toml:{line_of(spoiled, new)}: ", *mentions], code)


class HostileText(HostileInput):
    """What the parser calls itself for, or takes ages for."""

    def test_arrays_in_each_other(self):
        self.refuse(SCENE + "a = " + 10_000 * "[" + 10_000 * "]", ["scene.toml:44: values nested 33 deep", "at most 32"])

    def test_tables_in_each_other(self):
        self.refuse(SCENE + "a = " + 4_000 * "{a = ", ["scene.toml:44: values nested 33 deep", "at most 32"])

    def test_key_of_many_segments(self):
        self.refuse(SCENE + 10_000 * "a." + "a = 1\n", ["scene.toml:44: a key of 33 segments", "at most 32"])

    def test_missing_brace_on_a_long_line(self):
        line = "a = [" + 2_000 * "{ b = 1 }, " + "{ b = 1 ]\n"
        self.refuse(SCENE + line, ["scene.toml:44: malformed TOML"])
        self.refuse(SCENE + 2 * line.replace("\n", " ") + "\n", ["scene.toml:44: a line of ", "at most 32768 bytes"])

    def test_long_override(self):
        for length in (20_000, 32_000, 100_000):
            result = self.tread("check", self.write("scene.toml", SCENE), "--set", "grid.spacing=" + length * "x")
            self.assertEqual(result.returncode, 2, result.stderr[:2000])
            self.assertIn("--set grid.spacing=xxx", result.stderr)
            self.assertLess(len(result.stderr), 1000)


class HostileCounts(HostileInput):
    """What would be more than the memory is refused with figures before it is made."""

    def refuse_for_memory(self, text, mentions):
        self.refuse(text, ["out of host memory", "is free", *mentions], code=4)

    def test_points(self):
        text = SCENE.replace("spacing = 0.05", "spacing = 0.0002")
        self.refuse(text, [f"scene.toml:{line_of(text, '[[terrain]]')}: ", "1.6e+10 points", "at most 2147483647",
                           "coarsen [grid] spacing"])

    def test_points_that_fit_no_memory_are_checked_but_not_run(self):
        scene = self.write("scene.toml", SCENE.replace("spacing = 0.05", "spacing = 0.0016"))
        checked = self.tread("check", scene)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.assertIn("31250000 points", checked.stdout)
        run = self.tread("run", scene, "--output", self.output)
        self.assertEqual(run.returncode, 4, run.stderr)
        self.assertIn("out of host memory", run.stderr)
        self.assertFalse(self.output.exists())

    def test_columns_of_points(self):
        text = SCENE.replace("spacing = 0.05", "spacing = 2e-6")
        self.refuse_for_memory(text, ["[[terrain]] 0", "1.6e+11 columns of points"])

    def test_columns_of_the_surface(self):
        size = "size    = [0.4, 0.4, 0.4]"
        text = SCENE.replace(size, "size    = [400, 400, 0.4]").replace("spacing = 0.05", "spacing = 0.01") + BODY
        self.refuse_for_memory(text, [f"scene.toml:{line_of(text, '[grid]')}: ", "1.6e+09 columns of the domain"])

    def test_points_of_a_thin_layer_are_not_those_of_its_box(self):
        text = SCENE.replace("[0.4, 0.4, 0.1]] }", '[0.4, 0.4, 0.4]] }\nheight = "0.002"').replace("= 0.05", "= 0.002")
        result = self.tread("check", self.write("scene.toml", text))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("320000 points", result.stdout)

    def test_few_small_rocks_on_a_lattice(self):
        text = (SCENE + ROCKS).replace("diameter  = 0.02", "diameter  = 2e-4").replace("spacing = 0.05", "spacing = 0.002")
        text = text.replace("[[0.0, 0.0, 0.0], [0.4, 0.4, 0.1]]", "[[0.0, 0.0, 0.0], [0.04, 0.04, 0.04]]")
        text = text.replace('region    = { box = [[0.0, 0.0, 0.15]', 'region    = { box = [[0.0, 0.0, 0.05]')
        result = self.tread("check", self.write("scene.toml", text))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("(5 rocks)", result.stdout)

    def test_rocks_that_are_more_than_their_region(self):
        text = (SCENE + ROCKS).replace("count     = 5", "count     = 100_000_000").replace("= 0.02\n", "= 0.002\n")
        self.refuse(text, [f"scene.toml:{line_of(text, '[[rocks]]')}: ", "count = 100000000", "in a region of 0.04 m3",
                           "at most 9549296"])

    def test_more_rocks_than_memory(self):
        text = (SCENE + ROCKS).replace("count     = 5", "count     = 100_000_000").replace("= 0.02\n", "= 5e-4\n")
        self.refuse_for_memory(text, [f"scene.toml:{line_of(text, '[[rocks]]')}: ", "1e+08 rocks"])

    def test_small_body_beside_coarse_points(self):
        text = SCENE + ROCKS[: ROCKS.index("[[rocks]]")]
        text += BODY.replace('"roller"\nmaterial', '"ball"\ndiameter = 0.001\nmaterial')
        self.refuse(text, ["[[shape]] 'ball'", "a body of 0.0005 m radius", "0.0155 m", "at most 8 times"])

    def test_surface_nodes(self):
        text = SCENE.replace("node_spacing = 0.0075", "node_spacing = 1e-6") + BODY
        self.refuse(text, ["scene.toml:27: ", "surface nodes", "at most 1000000"])

    def sparse(self, name, size):
        with open(self.directory / name, "wb") as file:
            file.truncate(size)

    def test_large_rasters(self):
        for name in ("heights.csv", "heights.pgm"):
            low = ", low = 0.0, high = 0.1" if name.endswith("pgm") else ""
            text = SCENE.replace("[0.4, 0.4, 0.1]] }", f'[0.4, 0.4, 0.1]] }}\nheight = {{ file = "{name}"{low} }}')
            self.sparse(name, 5_000_000_000)
            self.refuse(text, [f"{name}: a file of 5.00 GB; accepted: at most 1.00 GB"])
            self.sparse(name, 900_000_000)
            self.refuse_for_memory(text, [f"{name}: its samples"])

    def test_inputs_that_would_be_waited_for(self):
        os.mkfifo(self.directory / "heights.csv")
        text = SCENE.replace("[0.4, 0.4, 0.1]] }", '[0.4, 0.4, 0.1]] }\nheight = { file = "heights.csv" }')
        self.refuse(text, ["heights.csv is no regular file; accepted: PGM or CSV"])
        os.mkfifo(self.directory / "mesh.stl")
        old = next(line for line in SCENE.splitlines() if line.startswith("generate"))
        self.refuse(SCENE.replace(old, 'file = "mesh.stl"') + BODY, ["mesh.stl is no regular file; accepted: STL or OBJ"])

    def test_large_mesh(self):
        self.sparse("mesh.stl", 5_000_000_000)
        old = next(line for line in SCENE.splitlines() if line.startswith("generate"))
        self.refuse_for_memory(SCENE.replace(old, 'file = "mesh.stl"') + BODY, ["mesh.stl: its triangles"])

    def test_large_scene(self):
        self.sparse("large.toml", 5_000_000_000)
        result = self.tread("check", self.directory / "large.toml")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("large.toml: a file of 5000000000 bytes; accepted: at most 1048576 bytes", result.stderr)


class HostileNumbers(HostileInput):
    """Numbers at the ends of their ranges give figures, not overflows."""

    def test_estimates_saturate(self):
        text = SCENE.replace("duration = 0.02", "duration = 1e7")
        text = text.replace("every           = 0.005", "every           = 1e-9").replace("= 0.01\n", "= 1e-9\n")
        result = self.tread("check", self.write("scene.toml", text + "[checkpoint]\nkeep = 10000\n[time]\ndt = 1e-12\n"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("disk at most over 1e6 TB", result.stdout)
        self.assertIn("1e+19 steps", result.stdout)
        self.assertNotRegex(result.stdout, r"\binf\b|\bnan\b|-[0-9.e]+ [kMGT]B")


if __name__ == "__main__":
    unittest.main()
