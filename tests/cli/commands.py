#!/usr/bin/env python3
"""The commands that run nothing: --version, --help, check, sdf, info."""

import json
import pathlib
import re
import shutil
import subprocess
import unittest

from bad_input import binary_stl, cube
from command import BODY, SCENE, TREAD, CommandTest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Commands(CommandTest):
    def test_version_is_that_of_the_build(self):
        result = self.tread("--version")
        wanted = re.search(r"project\(tread VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stdout.split("\n")[0], f"tread {wanted}")

    def test_help_names_every_command(self):
        result = self.tread("--help")
        self.assertEqual(result.returncode, 0)
        for command in ("run", "check", "study", "validate", "calibrate", "watch", "post", "sdf", "info", "soils"):
            self.assertIn(f"  {command} ", result.stdout)
            self.assertEqual(self.tread(command, "--help").returncode, 0)

    def test_a_misspelt_command_is_refused_with_the_nearest(self):
        for word, said in (("chekc", 'did you mean "check"?'), ("xyzxyz", "accepted: run, check")):
            refused = self.tread(word, "scene.toml")
            self.assertEqual((refused.returncode, refused.stdout), (2, ""))
            self.assertIn(f'there is no command "{word}"', refused.stderr)
            self.assertIn(said, refused.stderr)

    def test_a_misspelt_option_is_refused_with_the_nearest(self):
        for words, said in ((("run", "scene.toml", "--overwirte"), 'not expected: --overwirte; did you mean "--overwrite"? (tread run --help)'),
                            (("check", "scene.toml", "--xyzxyz"), "not expected: --xyzxyz (tread check --help)"), (("run",), "scene is required (tread run --help)"),
                            (("run", "scene.toml", "--x\x1b"), "not expected: --x\\x1b (")):
            refused = self.tread(*words)
            self.assertEqual((refused.returncode, refused.stdout), (2, ""))
            self.assertIn(said, refused.stderr)
            self.assertTrue(refused.stderr.startswith("tread: error: "), refused.stderr)

    def test_runs_limit_the_spinning_of_threads_unless_told_otherwise(self):
        """GNU's OpenMP says what it goes by, once for each start of the program."""
        def spins(**environment):
            shown = self.tread("run", "--help", environment={"OMP_DISPLAY_ENV": "verbose", "OMP_NUM_THREADS": "2", **environment})
            self.assertEqual(shown.returncode, 0, shown.stderr)
            return re.findall(r"GOMP_SPINCOUNT = '(.*)'", shown.stderr)
        self.assertEqual(spins()[1:], ["10000"])
        self.assertEqual(spins(GOMP_SPINCOUNT="77"), ["77"])
        self.assertEqual(len(spins(OMP_WAIT_POLICY="active")), 1)

    def test_soils_are_listed_and_a_check_shows_what_was_taken(self):
        listed = self.tread("soils")
        self.assertEqual((listed.returncode, listed.stderr), (0, ""))
        for soil in ("GRC-1", "HIT"):
            self.assertIn(f"\n{soil}: ", "\n" + listed.stdout)
        sand = SCENE[SCENE.index("model "):SCENE.index("\n[[material]]\nname    = \"steel\"")]
        scene = self.write("scene.toml", SCENE.replace(sand, 'soil = "GRC-1"\ndensity = 1747\n'))
        checked = self.tread("check", scene, "--set", "material.sand.young=2e6")
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.assertIn("[material.sand] takes 8 values from soil GRC-1:\n", checked.stdout)
        self.assertIn("  void_ratio_max = 0.6125 (Oravec et al. 2010", checked.stdout)
        self.assertNotIn("  young = ", checked.stdout)

    def test_study_is_its_script_with_this_program(self):
        help_text = self.tread("study", "--help").stdout
        self.assertIn("--vary", help_text)
        scene = self.write("scene.toml", SCENE)
        done = self.tread("study", scene, "--vary", "grid.spacing=0.05,0.1", "--dry-run")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 variants", done.stdout)
        self.assertEqual(self.files(), ["scene.toml"])

    def test_validate_calibrate_and_watch_are_their_scripts_with_this_program(self):
        listed = self.tread("validate", "--list")
        self.assertEqual(listed.returncode, 0, listed.stderr)
        self.assertIn("cmu", listed.stdout)
        planned = self.tread("validate", "ding", "--quick", "--dry-run")
        self.assertEqual(planned.returncode, 0, planned.stderr)
        self.assertIn("2 runs", planned.stdout)
        self.assertIn("--fit", self.tread("calibrate", "--help").stdout)
        self.assertEqual(self.tread("calibrate", self.write("scene.toml", SCENE)).returncode, 2)
        self.assertIn("--no-browser", self.tread("watch", "--help").stdout)
        nothing = self.tread("watch", self.output)
        self.assertEqual((nothing.returncode, nothing.stdout), (2, ""))
        self.assertIn("is no run (it has no scene.toml) and no campaign", nothing.stderr)
        self.assertEqual(self.files(), ["scene.toml"])

    def test_study_needs_python(self):
        done = self.tread("study", "scene.toml", environment={"TREAD_PYTHON": "/nowhere/python3"})
        self.assertEqual(done.returncode, 4)
        self.assertIn("/nowhere/python3: No such file", done.stderr)
        self.assertIn("TREAD_PYTHON", done.stderr)

    def test_study_takes_no_script_from_the_folders_above(self):
        bin_folder = self.directory / "prefix" / "bin"
        bin_folder.mkdir(parents=True)
        shutil.copy(TREAD, bin_folder / "tread")

        def answer():
            done = subprocess.run([bin_folder / "tread", "study", "--help"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout

        def put(folder, says):
            (folder / "jobs").mkdir(parents=True)
            (folder / "jobs" / "study.py").write_text(f"print('{says}')\n")

        for folder in (bin_folder, bin_folder.parent, self.directory, self.directory / "share" / "tread"):
            put(folder, "a stranger")
        self.assertIn("--vary", answer())
        put(bin_folder.parent / "share" / "tread", "the installed one")
        self.assertEqual(answer(), "the installed one\n")

    def test_check_writes_nothing(self):
        scene = self.write("scene.toml", SCENE + BODY)
        result = self.tread("check", scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("points", result.stdout)
        self.assertEqual(self.files(), ["scene.toml"])

    def test_a_title_does_not_command_the_terminal(self):
        scene = self.write("scene.toml", SCENE.replace("a small", "\\u001b]0;mine\\u0007 small"))
        for arguments in (("check", scene), ("run", scene, "--output", self.output, "--backend", "cpu"),
                          ("info", self.output / "timeseries.h5"), ("run", self.directory / "\x1b.toml")):
            result = self.tread(*arguments)
            said = result.stdout + result.stderr
            self.assertNotRegex(said, "[\x07\x1b]")
            if arguments[0] != "info":
                self.assertIn("\\x1b", said)
        self.assertNotIn("\x1b", (self.output / "log.txt").read_text())

    def test_check_puts_first_what_a_user_asks(self):
        page = self.tread("check", self.write("scene.toml", SCENE.replace("[0.0, 0.0, -9.81]", "[-1.0, 0.0, -9.81]") + BODY)).stdout
        parts = ["a small block of sand", "points, 1 bodies", "wall time about 0:00:0", "dt ", "memory about", "a slope of 5.82 degrees that rises along [1, 0]",
                 "roller: weight 9.861 N, ", "cells and", "resolution of the contact: under-resolved; marginal from grid.spacing = ", "terrain 0 of sand", "shapes at scale 1",
                 "partition: one rank"]
        places = [page.find(part) for part in parts]
        self.assertNotIn(-1, places, page)
        self.assertEqual(places, sorted(places), page)
        self.assertNotIn("stages of a step:", page)
        self.assertLess(len(page.splitlines()), 40, page)

    def test_check_lists_phases_with_what_moves(self):
        drive = ('[[phase]]\nname = "drive"\nduration = 0.5\ndamping = 0.1\n'
                 'drive = { body = "roller", angular_velocity = 1.0, ramp = 0.1, slip = 0.25 }\n')
        scene = self.write("scene.toml", SCENE + BODY + drive)
        page, said = self.tread("check", scene).stdout, json.loads(self.tread("check", "--json", scene).stdout)
        phase = said["phases"][-1]
        self.assertAlmostEqual(phase["way"], 0.75 * 0.06 * (0.5 - 0.05), delta=1e-6)  # a ramp counts half
        self.assertEqual((phase["drives"], phase["slip"], phase["at_most"]), ("roller", 0.25, 0.5))
        self.assertIn(f"drive  0.5 s; 'roller' turns at 1 rad/s, slip 0.25: {phase['way']:.3g} m of {phase['way_to_end']:.3g} m there are; damping 0.1",
                      page)

    def test_check_says_the_same_to_programs(self):
        scene = self.write("scene.toml", SCENE + BODY)
        page, said = self.tread("check", scene).stdout, json.loads(self.tread("check", "--json", scene).stdout)
        self.assertIn(f"{said['points']} points, {said['bodies']} bodies ({said['rocks']} rocks)", page)
        self.assertIn(f"scene {said['scene']}\n", page)
        self.assertIn(f"dt {said['dt']:.4g} s at the start (limit: {said['dt_limit']}), at most {said['time']:.4g} s simulated: {said['steps']:.3g} steps", page)
        roller, = said["named_bodies"]
        self.assertIn(f"roller: weight {roller['weight']:.4g} N", page)
        self.assertIn(f"resolution of the contact: {roller['at_rest']['verdict']}", page)
        both = self.tread("check", "--json", "--stages", scene)
        self.assertEqual((both.returncode, "--stages" in both.stderr), (2, True), both.stderr)

    def test_check_reports_the_slope_that_a_scene_gives(self):
        slope = "gravity_size = 3.71\nslope_deg = 12\nslope_direction_deg = 90"
        scene = self.write("scene.toml", SCENE.replace("gravity = [0.0, 0.0, -9.81]", slope))
        self.assertIn("gravity 3.71 m/s2, a slope of 12 degrees that rises along [0, 1]", self.tread("check", scene).stdout)

    def test_check_shows_how_a_scene_falls_to_ranks(self):
        scene = self.write("scene.toml", SCENE + BODY)
        self.assertIn("partition: one rank", self.tread("check", scene).stdout)
        result = self.tread("check", scene, "--ranks", "3")
        self.assertEqual(result.returncode, 0, result.stderr)
        share = re.search(r"each of 3 ranks: .*; set-up of the sand [\d.]+ .B on the host, .* its (\d+) points", result.stdout)
        points = int(re.search(r"(\d+) points, 1 bodies", result.stdout)[1])
        self.assertEqual(int(share[1]), -(-points // 3))
        pages = int(re.search(r"partition of (\d+) pages into 3 ranks:", result.stdout)[1])
        self.assertGreaterEqual(pages, 3)
        for partitioner in ("METIS", "Morton"):
            found = re.search(rf"{partitioner} +largest load ([\d.]+) of the mean, (\d+) nodes shared", result.stdout)
            self.assertGreaterEqual(float(found[1]), 1)
            self.assertGreater(int(found[2]), 0)
        self.assertNotIn("without pages", result.stdout)
        refused = self.tread("check", scene, "--ranks", "0")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--ranks", refused.stderr)

    def test_sdf_of_a_cube(self):
        (self.directory / "cube.stl").write_bytes(binary_stl(cube(20.0)))
        result = self.tread("sdf", "cube.stl", "--unit", "mm", "--cells", "32", "--write-stl", "metres.stl")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"volume +8e-06 m3")
        self.assertRegex(result.stdout, r"area +0.0024 m2")
        self.assertRegex(result.stdout, r"inertia \(1\) +5.33333e-10 ")  # V a^2 / 6
        again = self.tread("sdf", "metres.stl", "--cells", "32")
        self.assertRegex(again.stdout, r"volume +8e-06 m3")

    def test_sdf_of_a_cube_with_a_hole(self):
        (self.directory / "open.stl").write_bytes(binary_stl(cube(20.0)[:-1]))
        refused = self.tread("sdf", "open.stl", "--unit", "mm")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("open.stl", refused.stderr)
        self.assertIn("repair = true", refused.stderr)
        mended = self.tread("sdf", "open.stl", "--unit", "mm", "--cells", "32", "--repair")
        self.assertEqual(mended.returncode, 0, mended.stderr)
        self.assertIn("repair: 1 holes closed", mended.stdout)
        self.assertRegex(mended.stdout, r"volume +8e-06 m3")

    def test_sdf_of_a_built_in_wheel(self):
        result = self.tread("sdf", "perseverance")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("watertight      yes", result.stdout)

    def test_sdf_of_a_name_that_is_none(self):
        unknown = self.tread("sdf", "perseverence")
        self.assertEqual(unknown.returncode, 2, unknown.stderr)
        self.assertIn("'perseverence' is unknown; did you mean \"perseverance\"?; known are ", unknown.stderr)
        for name in ("perseverance", "curiosity", "spirit", "viper"):
            self.assertIn(name, unknown.stderr.partition("known are")[2])
        self.assertIn("ends in .stl or .obj", unknown.stderr)

    def test_sdf_of_a_shape_in_a_scene(self):
        scene = self.write("scene.toml", SCENE + BODY)
        only = self.tread("sdf", scene)
        self.assertEqual(only.returncode, 0, only.stderr)
        self.assertRegex(only.stdout, r"shape +roller\n")
        self.assertIn("sdf_cells = 24:", only.stdout)
        self.assertRegex(self.tread("sdf", scene, "--shape", "roller").stdout, r"shape +roller\n")
        absent = self.tread("sdf", scene, "--shape", "rolle")
        self.assertEqual(absent.returncode, 2)
        self.assertIn("shape 'rolle' is unknown", absent.stderr)
        two = self.write("two.toml", SCENE + '[[shape]]\nname = "ball"\ngenerate = { kind = "sphere" }\n' + BODY)
        self.assertEqual(self.tread("sdf", two).returncode, 2)
        self.assertIn("has 2 [[shape]] tables: --shape NAME says which", self.tread("sdf", two).stderr)
        self.assertRegex(self.tread("sdf", two, "--shape", "ball").stdout, r"shape +ball\n")
        self.assertEqual(self.tread("sdf", "perseverance", "--shape", "ball").returncode, 2)

    def test_sdf_of_tools_and_of_what_is_assembled_of_them(self):
        pin = SCENE + """
[[shape]]
name = "pin"
generate = { kind = "cylinder", radius = 0.01, length = 0.1 }
[[shape]]
name = "cross"
sdf_cells = 64
assemble = [ { shape = "pin" }, { shape = "pin", axis = [1, 0, 0], angle_deg = 90 } ]
"""
        scene = self.write("pins.toml", pin)
        one, two = (self.tread("sdf", scene, "--shape", name) for name in ("pin", "cross"))
        self.assertRegex(one.stdout, r"watertight +yes: \d+ vertices")
        self.assertRegex(two.stdout, r"watertight +each part, of whose union this is the boundary: \d+ vertices")
        self.assertIn("union of 2 solids", two.stdout)
        volumes = [float(re.search(r"volume +(\S+) m3", text.stdout)[1]) for text in (one, two)]
        # Steinmetz's solid, 16/3 r^3, counts once; it is 9 % of the volume and sampled to 2 %.
        self.assertAlmostEqual(volumes[1] / (2 * volumes[0] - 16 / 3 * 1e-6), 1, delta=2e-3)
        alone = re.sub(r"generate +=.*", 'assemble = [ { shape = "spirit", scale = 0.5 } ]', SCENE)
        self.assertIn("union of 1 solids", self.tread("sdf", self.write("alone.toml", alone)).stdout)

    def test_sdf_warns_of_a_lost_volume(self):
        result = self.tread("sdf", "perseverance", "--cells", "60")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, r"warning: its SDF of sdf_cells = 60 encloses [78]\d\.\d % .* = 1\d\d would be")
        scene = self.write("scene.toml", SCENE.replace("sdf_cells = 24", "sdf_cells = 8") + BODY)
        self.assertRegex(self.tread("check", scene).stdout, r"roller: warning: its SDF of sdf_cells = 8 encloses")

    def test_sdf_reports_its_convergence(self):
        (self.directory / "cube.stl").write_bytes(binary_stl(cube(20.0)))
        result = self.tread("sdf", "cube.stl", "--unit", "mm", "--report", "report.h5")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = [line.split()[0] for line in result.stdout.partition("|phi|/extent")[2].splitlines()[1:]]
        self.assertEqual(rows, ["10", "15", "20", "30", "40", "60", "80", "100", "150", "200"])
        self.assertIn("volume_ratio", self.tread("info", "report.h5").stdout)
        printed = self.tread("sdf", "cube.stl", "--report")
        self.assertEqual(printed.returncode, 0, printed.stderr)
        self.assertIn("|phi|/extent", printed.stdout)

    def test_info_needs_an_hdf5_file(self):
        scene = self.write("scene.toml", SCENE)
        self.assertEqual(self.tread("info", scene).returncode, 2)
        self.assertEqual(self.tread("info", "nowhere.h5").returncode, 2)


if __name__ == "__main__":
    unittest.main()
