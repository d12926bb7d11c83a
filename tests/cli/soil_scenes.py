#!/usr/bin/env python3
"""Every soil test of configs/soil has a twin; the quickest twins run, and measure what their soil is made of: docs/soil_tests.md."""

import tomllib
import unittest

from soil_case import SOIL, SoilCase
from tread_post.closed_forms import FORMS


class SoilScenes(SoilCase):
    def test_every_scene_has_a_twin_and_a_closed_form(self):
        scenes, twins = ({path.name: path for path in folder.glob("*.toml")} for folder in (SOIL, SOIL / "reduced"))
        self.assertEqual(set(scenes), set(twins))
        for path in [*scenes.values(), *twins.values()]:
            scene = tomllib.loads(path.read_text(encoding="utf-8"))
            self.assertEqual(FORMS[scene["reference"]["form"]].needs(scene), "", path)

    def test_oedometer(self):
        run = self.run_twin("oedometer")
        self.compare(run, "modulus", 0.02 * 1.346e7, "2 %: the error falls from 7 % on four cells to 1 % on eight")

    def test_collapse(self):
        self.compare(self.run_twin("collapse"), "run_out", 0.15 * 1.2, "the two laboratories are 15 % apart")


if __name__ == "__main__":
    unittest.main()
