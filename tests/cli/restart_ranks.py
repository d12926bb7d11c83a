#!/usr/bin/env python3
"""Runs on several ranks that are stopped and go on, on as many or on fewer. Longer ones: restart_more_ranks.py."""

import unittest

from command import MPIRUN
from restart_test import BODIES, JOINTED, MIXED, RestartTest, lasting


class RestartOnRanks(RestartTest):
    def test_bodies_on_two_ranks_restarted_give_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(lasting(BODIES, 0.3), (*MPIRUN, "-n", "2"))

    def test_sand_and_jointed_bodies_on_three_ranks_restarted_give_the_same_bits(self):
        self.check_uninterrupted_is_stopped_and_restarted(lasting(JOINTED, 0.06), (*MPIRUN, "-n", "3"))

    def test_from_three_ranks_to_one_and_two_agrees_as_far_as_chaos_lets_it(self):
        self.check_other_number_of_ranks(MIXED, 3, 2)


if __name__ == "__main__":
    unittest.main()
