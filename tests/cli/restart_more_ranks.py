#!/usr/bin/env python3
"""What restart_ranks.py has of sand, joints and changes of the number of ranks, for ci/full."""

import re
import unittest

from command import MPIRUN, SCENE
from restart_test import ASLEEP, JOINTED, MIXED, STREWN, WITH_ROCK, RestartTest, datasets, lasting

# Rocks that rain from a column six times as high as what they come to rest in.
FALLING = lasting(re.sub(r"\[\[terrain\]\].*?\n\n", "", WITH_ROCK, flags=re.S), 0.5).replace("[0.4, 0.4, 0.4]", "[0.2, 0.1, 1.0]") + """
[[rocks]]
shape     = "roller"
material  = "steel"
count     = 150
diameter  = 0.03
region    = { box = [[0.0, 0.0, 0.0], [0.2, 0.1, 1.0]] }
placement = "rain"
seed      = 1
"""

# Rocks on sand that sleep with it, and one in it.
STREWN_ASLEEP = ASLEEP + "rock_speed = 1.0\nrock_rest = 0.001\n" + STREWN.partition(MIXED)[2].replace(
    "[[0.0, 0.0, 0.105], [0.4, 0.14, 0.19]]", "[[0.0, 0.0, 0.105], [1.0, 0.2, 0.15]]") + """
[[rocks]]
shape     = "roller"
material  = "steel"
count     = 1
diameter  = 0.06
region    = { box = [[0.8, 0.0, 0.02], [1.0, 0.2, 0.1]] }
placement = "replace"
"""


class RestartOnMoreRanks(RestartTest):
    def test_sand_on_three_ranks_restarted_gives_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(lasting(SCENE, 0.1), (*MPIRUN, "-n", "3"))

    def test_from_one_rank_to_three_agrees_as_far_as_chaos_lets_it(self):
        self.check_other_number_of_ranks(MIXED, 1, 3)

    def test_strewn_sand_from_three_ranks_to_five_and_on_to_two_agrees_as_far_as_chaos_lets_it(self):
        text = lasting(STREWN, 0.06)
        three, five, two = ((*MPIRUN, "-n", str(ranks)) for ranks in (3, 5, 2))
        checkpoint = self.stop_after_a_checkpoint(text, self.directory / "on3", launcher=three)
        self.check_agreement(text, checkpoint, {"5 ranks": {"launcher": five}})
        later = self.stop_after_a_checkpoint(text, self.directory / "on5", "--restart", checkpoint, launcher=five)
        self.assertGreater(later.name, checkpoint.name)
        self.check_agreement(text, later, {"2 ranks": {"launcher": two}})

    def test_jointed_bodies_from_two_ranks_to_three_agree_as_far_as_chaos_lets_them(self):
        self.check_other_number_of_ranks(JOINTED, 2, 3)

    def test_fallen_rocks_are_shared_out_by_where_they_are(self):
        self.run_scene(FALLING, self.output, "--set=checkpoint.every_steps=100")
        self.run_scene(FALLING, self.directory / "on2", "--restart", self.checkpoints()[-1], launcher=(*MPIRUN, "-n", "2"))
        rows = datasets(self.directory / "on2" / "timeseries.h5")
        imbalance = rows["ranks/imbalance"][-1]
        print(f"  imbalance: {imbalance:.3f}; expected: 1.15 at most, the threshold of [balance]")
        self.assertEqual(rows["ranks/repartitions"][-1], 1)
        self.assertLess(imbalance, 1.15)

    def test_sleeping_sand_on_two_ranks_restarted_gives_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(ASLEEP, (*MPIRUN, "-n", "2"))
        self.assertGreater(self.summary()["asleep"], 0.1)

    def test_rocks_asleep_in_sand_on_two_ranks_restarted_give_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(STREWN_ASLEEP, (*MPIRUN, "-n", "2"))
        self.assertGreater(self.summary()["asleep"], 0.1)
        self.assertGreater(self.summary()["rocks_asleep"], 0.1)

    def test_sleeping_sand_goes_on_awake_on_another_number_of_ranks(self):
        self.check_sleepers_go_on_awake(ASLEEP, ("asleep",))

    def test_rocks_asleep_in_sand_go_on_awake_on_another_number_of_ranks(self):
        self.check_sleepers_go_on_awake(STREWN_ASLEEP, ("asleep", "rocks_asleep"))

    def check_sleepers_go_on_awake(self, text, shares):
        """They fall asleep again; chaos is no measure, as what wakes moves."""
        checkpoint = self.stop_after_a_checkpoint(text, self.directory / "on2", launcher=(*MPIRUN, "-n", "2"))
        whole = self.directory / "whole"
        self.run_scene(text, whole)
        points, energy = self.summary(whole)["points"], self.summary(whole)["errors"]["energy"]
        for launcher in ((), (*MPIRUN, "-n", "3")):
            output = self.directory / f"on{launcher[-1] if launcher else 1}"
            self.run_scene(text, output, "--restart", checkpoint, launcher=launcher)
            ended = self.summary(output)
            self.assertEqual((ended["status"], ended["points"]), ("finished", points))
            for share in shares:
                self.assertGreater(ended[share], 0.1)
            self.assertAlmostEqual(ended["errors"]["energy"], energy, delta=1e-3)


if __name__ == "__main__":
    unittest.main()
