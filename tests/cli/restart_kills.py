#!/usr/bin/env python3
"""A hundred kills at random moments: nothing older than the last checkpoint is lost, and no bit differs in the end."""

import unittest

from command import SCENE
from restart_test import BODIES, MIXED, RestartTest, lasting


class Kills(RestartTest):
    def test_sand(self):
        self.check_killed_runs(lasting(SCENE, 0.3), 35, seed=1)

    def test_bodies(self):
        self.check_killed_runs(lasting(BODIES, 0.3), 30, seed=2)

    def test_sand_and_a_body(self):
        self.check_killed_runs(lasting(MIXED, 0.2), 35, seed=3)


if __name__ == "__main__":
    unittest.main()
