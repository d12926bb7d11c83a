#!/usr/bin/env python3
"""slip_curve.py OUTPUT [SLIP...]: runs the small wheel at some slips and prints pull and sinkage; with matplotlib it draws them."""

import importlib.util
import sys
from pathlib import Path

import tread
from small_wheel import driven, means


def curve(output, slips):
    """[(slip, pull in N, sinkage in m)]"""
    rows = []
    for slip in slips:
        run = tread.run(driven(slip), output / f"slip_{slip}", existing="overwrite")
        rows.append((slip, *means(run, "drawbar_pull", "sinkage")))
        print(f"slip {slip:5.2f}   pull {rows[-1][1]:7.2f} N   sinkage {1000 * rows[-1][2]:6.2f} mm", flush=True)
    return rows


def draw(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (above, below) = pyplot.subplots(2, sharex=True, figsize=(5, 5), layout="constrained")
    slips, pulls, sinkages = zip(*rows)
    above.plot(slips, pulls, "o-")
    above.set_ylabel("drawbar pull (N)")
    below.plot(slips, [1000 * sinkage for sinkage in sinkages], "o-")
    below.set(xlabel="slip", ylabel="sinkage (mm)")
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    table = curve(folder, [float(slip) for slip in sys.argv[2:]] or [-0.2, 0.0, 0.1, 0.2, 0.4, 0.6])
    if importlib.util.find_spec("matplotlib"):
        draw(table, folder / "slip_curve.png")
