#!/usr/bin/python3
"""Draws the curves of soil tests and fits Bekker's and Janosi's constants to them.

Runs of one kind of test are fitted together: plates of several widths to k_c, k_phi and n; shear under several loads to c, phi and K. The kind is the
scene's [reference] form: docs/soil_tests.md. Writes soil_test.png, soil_test.csv (the curves) and soil_test.json (the constants) into the output
directory, and prints the constants with 95 % intervals. Needs Debian's python3-h5py, python3-numpy, python3-scipy and python3-matplotlib.

    postprocess/soil_test.py runs/plate --output runs/plate/report
    postprocess/soil_test.py runs/shear_10kPa runs/shear_20kPa runs/shear_40kPa --output runs/shear
"""

import argparse
import sys
from pathlib import Path

from tread_post import Run, RunError
from tread_post.soil_curves import READERS, curves_of
from tread_post.soil_fits import FitError
from tread_post.soil_report import constants_of, figure_of, text_of, write_csv, write_json
from tread_post.style import write


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("runs", type=Path, nargs="+", metavar="RUN", help=f"output directories, of one kind of test: {', '.join(READERS)}")
    parser.add_argument("--void-ratio", type=float, metavar="E0", help="void ratio at the start, of an oedometer: draws e against log p")
    parser.add_argument("--output", type=Path, required=True, metavar="DIR", help="for soil_test.png, .csv and .json; is made if it is not there")
    options = parser.parse_args()
    if options.void_ratio is not None and not 0 < options.void_ratio < 10:
        parser.error(f"--void-ratio {options.void_ratio:g}: accepted: a number over 0 and below 10")
    return options


def main():
    options = arguments()
    runs = [Run(path) for path in options.runs]
    curves = [(run, curve) for run in runs for curve in curves_of(run)]
    kinds = sorted({curve.test for _, curve in curves})
    if len(kinds) > 1:
        raise RunError(f"runs of different tests: {', '.join(kinds)}; give those of one")
    constants = constants_of(curves, options.void_ratio)
    options.output.mkdir(parents=True, exist_ok=True)
    write(figure_of(curves, constants, options.void_ratio), options.output / "soil_test.png")
    write_csv(options.output / "soil_test.csv", curves)
    write_json(options.output / "soil_test.json", curves, constants)
    print(text_of(kinds[0], constants))


if __name__ == "__main__":
    try:
        main()
    except (RunError, FitError) as error:
        sys.exit(f"soil_test: {error}")
