#!/usr/bin/env python3
"""Scenes from Python: files, texts and dicts mean the same, and errors name the key."""

import copy
import json
import pathlib
import subprocess
import tomllib
import unittest

import numpy

import tread
from package import BALL, BODY, SCENE, TREAD, PackageTest, keys_of


DOCS = pathlib.Path(__file__).parents[2] / "docs"


class Readers(PackageTest):
    def test_runs_and_studies_are_read(self):
        self.run_scene(BALL)
        run = tread.Run(self.directory / "run")
        self.assertEqual((run.summary["status"], run.wheels), ("finished", ["ball"]))
        self.assertEqual(len(run.wheel("ball")["drawbar_pull"]), 11)  # 0.1 s by rows of 0.01 s, and the start
        study = tread.read_study(DOCS / "studies" / "study_column.csv")
        self.assertTrue(study.quantities and all(isinstance(row.measured, float) for row in study.rows))
        with self.assertRaisesRegex(tread.RunError, "no campaign.h5"):
            tread.CampaignTable(self.directory)


class Scenes(PackageTest):
    def refused(self, keys):
        with self.assertRaises(tread.SceneError) as caught:
            tread.Scene(keys).check()
        return str(caught.exception)

    def changed(self, change):
        keys = copy.deepcopy(keys_of(SCENE + BODY))
        change(keys)
        return keys

    def test_file_text_and_dicts_are_one_scene(self):
        path = self.write("scene.toml", SCENE + BODY)
        of_file = tread.Scene.from_file(path).resolved
        self.assertEqual(tread.Scene.from_text(SCENE + BODY).resolved, of_file)
        self.assertEqual(tread.Scene(keys_of(SCENE + BODY)).resolved, of_file)
        numpy_keys = self.changed(lambda keys: keys["domain"].update(size=numpy.array([0.4, 0.4, 0.4]), gravity=(0, 0, numpy.float64(-9.81))))
        self.assertEqual(tread.Scene(numpy_keys).resolved, of_file)
        self.assertEqual(tread.Scene(keys_of(of_file)).resolved, of_file)

    def test_errors_name_the_key(self):
        self.assertIn("[grid] spacing", self.refused(self.changed(lambda keys: keys["grid"].update(spacing=-1))))
        self.assertIn("[grid] spacing", self.refused(self.changed(lambda keys: keys["grid"].update(spacing="fine"))))
        message = self.refused(self.changed(lambda keys: keys["material"][0].update(yuong=1e6)))
        self.assertIn("[material.sand] yuong", message)
        self.assertIn("young", message)
        for value in (None, {1, 2}, object()):
            self.assertIn("material[0].young: a value of type", self.refused(self.changed(lambda keys: keys["material"][0].update(young=value))))
        self.assertIn("malformed TOML", self.text_refused("[grid\n"))

    def text_refused(self, text):
        with self.assertRaises(tread.SceneError) as caught:
            tread.Scene.from_text(text).check()
        return str(caught.exception)

    def test_values_as_by_set(self):
        path = self.write("scene.toml", SCENE + BODY)
        values = {"material.sand.young": 2e6, "phase[0].hold": ["roller"], "title": "another"}
        changed = tread.Scene.from_file(path).with_values({"grid.spacing": 0.04}).with_values(values)
        self.assertEqual((changed.keys["grid"]["spacing"], changed.keys["material"][0]["young"]), (0.04, 2e6))
        self.assertEqual((changed.keys["phase"][0]["hold"], changed.keys["title"]), (["roller"], "another"))
        with self.assertRaisesRegex(tread.SceneError, "material.sand.yuong"):
            changed.with_values({"material.sand.yuong": 1}).check()

    def test_check_is_that_of_the_program(self):
        path = self.write("scene.toml", SCENE + BODY)
        shown = json.loads(subprocess.run([TREAD, "check", path, "--json"], check=True, capture_output=True, text=True).stdout)
        checked = tread.Scene.from_file(path).check()
        self.assertEqual(checked.keys(), shown.keys())
        self.assertEqual((checked["points"], checked["phases"]), (shown["points"], shown["phases"]))
        scene = tread.Scene.from_file(path)
        self.assertNotIn("stages of a step", scene.report())
        self.assertIn("stages of a step", scene.report("shown"))

    def test_files_are_relative_to_the_directory(self):
        text = SCENE.replace('generate  = { kind = "wheel", radius = 0.06, width = 0.06, wall_thickness = 0.03, grousers = 0, grouser_height = 0.0 }',
                             'file = "meshes/tetrahedron.obj"') + BODY
        self.assertIn("there is no file", self.text_refused(text))
        (self.directory / "meshes").mkdir()
        self.write("meshes/tetrahedron.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        self.assertEqual(tread.Scene.from_text(text, self.directory).check()["bodies"], 1)
        self.assertEqual(tread.Scene(keys_of(text), pathlib.Path(self.directory)).check()["bodies"], 1)

    def test_features_and_soils(self):
        self.assertIn("\nbackends: cpu", tread.features())
        project = tomllib.loads((DOCS.parent / "pyproject.toml").read_text())["project"]
        self.assertEqual(tread.features().splitlines()[0], f"tread {project['version']}")
        self.assertIn("GRC-1", tread.soils())


if __name__ == "__main__":
    unittest.main()
