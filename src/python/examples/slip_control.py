#!/usr/bin/env python3
"""slip_control.py OUTPUT [SLIP]: a rope holds the small wheel back as much as keeps its slip at 0.2. The pull of the rope is what the
wheel can pull at that slip.

A controller with a proportional and an integral part, called every 10 ms of simulated time."""

import sys
from pathlib import Path

import tread
from small_wheel import means, pulling

SPAN = 0.01  # s, from one call to the next
PROPORTIONAL, INTEGRAL = 20.0, 500.0  # N, N/s for a slip that is wrong by one
SMOOTHING = 0.2  # share of the newest slip in the mean that is controlled


class SlipController:
    def __init__(self, wanted):
        self.wanted, self.slip, self.integral = wanted, 0.0, 0.0

    def __call__(self, state):
        if state.phase != "drive" or state.over:
            return
        wheel = state.body("wheel")
        if state.since_phase < 0.1:  # the axle starts
            return
        self.slip += SMOOTHING * (wheel.slip - self.slip)
        missing = self.wanted - self.slip
        self.integral = max(0.0, self.integral + INTEGRAL * missing * SPAN)
        pull = max(0.0, self.integral + PROPORTIONAL * missing)  # a rope does not push
        state.steer("wheel", force=(-pull, 0.0, 0.0))


def controlled(output, wanted=0.2):
    """Mean slip, and mean pull of the rope in N, over the second half of the drive."""
    run = tread.run(pulling(), output, existing="overwrite", on_span=SlipController(wanted), span=SPAN)
    return means(run, "slip", "drawbar_pull")


if __name__ == "__main__":
    goal = float(sys.argv[2]) if len(sys.argv) > 2 else 0.2
    slip, pull = controlled(Path(sys.argv[1]), goal)
    print(f"mean slip {slip:.3f}, wanted {goal}; mean pull {pull:.1f} N")
