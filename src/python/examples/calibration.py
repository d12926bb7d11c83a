#!/usr/bin/env python3
"""calibration.py OUTPUT: finds the friction angle of a sand from pull and sinkage of the small wheel at slip 0.3, by the fit of `tread calibrate`.

The measurement is made by a run with an angle that the fit does not see; put measured values in its place. Needs scipy."""

import sys
from pathlib import Path

import numpy as np
import tread
from small_wheel import driven, means
from tread_jobs.fit import Parameter, Problem, fitted

TRUE_ANGLE = 34.0  # degrees
ANGLE = Parameter("material.sand.friction_angle_deg", 26.0, 40.0)


def answers(angle, output):
    """[pull in N, sinkage in mm]"""
    scene = tread.Scene(driven(0.3)).with_values({ANGLE.key: angle})
    pull, sinkage = means(tread.run(scene, output, existing="overwrite"), "drawbar_pull", "sinkage")
    return [pull, 1000 * sinkage]


def calibrate(output):
    """Angle in degrees, and its interval of 95 %."""
    measured = np.array(answers(TRUE_ANGLE, output / "measured"))
    deviation = 0.02 * np.abs(measured)  # of the measurement, assumed

    def evaluate(number, places):
        values = []
        for place, in places:
            values.append(answers(ANGLE.value(place), output / f"round_{number}"))
            print(f"round {number}: {ANGLE.value(place):.3f} degrees -> pull {values[-1][0]:.2f} N, sinkage {values[-1][1]:.2f} mm", flush=True)
        return np.array(values)

    fit = fitted(Problem((ANGLE,), measured, deviation, evaluate))
    low, high = fit.interval()
    return [float(ANGLE.value(place)) for place in (fit.unknowns[0], low[0], high[0])]


if __name__ == "__main__":
    found, least, most = calibrate(Path(sys.argv[1]))
    print(f"friction angle {found:.2f} degrees ({least:.2f} to {most:.2f}); the measured run had {TRUE_ANGLE}")
