#!/usr/bin/python3
"""Constants of a scene from measured curves: docs/calibration.md. `tread calibrate SCENE.toml --measured FILE.csv --fit KEY=LOW..HIGH ...` calls it.

Runs the scene in rounds of cases around the best constants so far, fits them by least squares on a quadratic of the runs' answers, and writes fitted values
with 95 % intervals and correlations, a picture of the residuals, and samples of what the data allow as a campaign file. The same command again goes on
with what is missing. Python 3.11 or later with h5py, numpy, scipy and matplotlib.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

if sys.version_info < (3, 11):
    sys.exit("calibrate: error: Python 3.11 or later is needed")

from tread_jobs.directory import CampaignDirectory
from tread_jobs.errors import CampaignError, MachineError
from tread_jobs.files import printable, write_text
from tread_jobs.local_campaign import all_checked, cost_of_plans, expand_into, print_states, run_missing
from tread_jobs.status import DONE
from tread_jobs.study_plan import read_setting

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "postprocess" / "calibration.py"
STOPPED = 3


def arguments():
    parser = argparse.ArgumentParser(prog="tread calibrate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path, metavar="SCENE.toml", help="of the test that was measured")
    parser.add_argument("--measured", action="append", default=[], type=Path, metavar="FILE.csv",
                        help="columns `name [unit]`: what is given, what was measured over it, and its standard deviation as NAME_spread, if known; repeatable")
    parser.add_argument("--fit", action="append", default=[], metavar="KEY=LOW..HIGH[:log]", help="a constant and its bounds, as often as needed")
    parser.add_argument("--phase", metavar="NAME", help="of the scene, that was measured; default: the last")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="replace one value in all runs, as often as needed")
    parser.add_argument("--rounds", type=positive, default=6, metavar="N", help="at most; default 6")
    parser.add_argument("--samples", type=positive, default=32, metavar="N", help="of the constants that the data allow; default 32")
    parser.add_argument("--output", type=Path, metavar="DIR", help="default: runs/calibration/<name of the scene file>")
    parser.add_argument("--jobs", type=positive, default=1, metavar="N", help="runs at a time; default 1")
    parser.add_argument("--threads", type=positive, metavar="N", help="of a run; default: the machine's cores over --jobs")
    parser.add_argument("--backend", choices=("auto", "cpu", "cuda"), default="auto")
    parser.add_argument("--gpus", type=positive, default=1, metavar="N", help="of this machine, assigned to the runs in turn with --backend cuda; default 1")
    parser.add_argument("--dry-run", action="store_true", help="check the runs of the first round and say what they will cost; write and start nothing")
    parser.add_argument("--tread", default="tread", metavar="PROGRAM", help="default: tread on PATH, or the one that was called")
    return parser.parse_args()


def positive(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}: a whole number of at least 1")
    return int(text)


class Rounds:
    """Runs the rounds of a calibration, each a campaign of its own directory, and reads their curves."""

    def __init__(self, options, parameters, curves):
        self.options, self.parameters, self.curves = options, parameters, curves

    def campaign(self, number, points):
        from tread_jobs.calibration_plan import round_campaign

        options = self.options
        resources = {"backend": options.backend, "threads": options.threads, "gpus": 1 if options.backend == "cuda" else 0}
        folder = options.output / f"round_{number:02}"
        campaign = round_campaign(folder / "round.toml", f"Calibration of {options.scene.stem}, round {number}", options.scene.resolve(),
                                  options.settings, self.parameters, points, resources)
        return campaign, CampaignDirectory(folder / "runs")

    def points(self, unknowns):
        return [[parameter.value(unknown) for parameter, unknown in zip(self.parameters, row)] for row in unknowns]

    def expand(self, number, unknowns):
        """The directory of a round, its cases checked and written where they are not."""
        campaign, directory = self.campaign(number, self.points(unknowns))
        if directory.is_expanded:
            directory.refuse_another(campaign.digest)
            directory.refuse_edited()
            return campaign, directory
        cases, plans = all_checked(campaign, self.options.program)
        cost = cost_of_plans(plans, campaign.resources)
        print(f"round {number}: {len(cases)} runs, about {cost['seconds']:.3g} s by the model, {cost['disk'] / 1e9:.2g} GB of disk at most", flush=True)
        if not self.options.dry_run:
            expand_into(directory, campaign, cases, cost)
        return campaign, directory

    def __call__(self, number, unknowns):
        """Values of the measured curves [n, m], NaN in rows of runs that failed or fall short."""
        import numpy as np

        from tread_jobs.run_answers import curve_values

        options = self.options
        campaign, directory = self.expand(number, unknowns)
        states = run_missing(directory, campaign, options.program, options.jobs, options.gpus if options.backend == "cuda" else 0)
        print(f"round {number}: ", end="")
        print_states(states, "run")
        values = np.full((len(unknowns), sum(len(curve.places) for curve in self.curves)), np.nan)
        for entry in directory.entries():
            if states[entry.name].state == DONE:
                found, reason = curve_values(directory.cases / entry.name / "run", self.curves, options.phase)
                if reason:
                    print(f"run {entry.name}: left out: {printable(reason)}")
                else:
                    values[entry.number] = found
        return values


def prepared(options):
    """(parameters, curves) of the options. CampaignError before anything is written."""
    from tread_jobs.calibration_plan import read_parameter, read_scene
    from tread_jobs.run_answers import read_curves

    scene = read_scene(options.scene)
    if not options.fit or not options.measured:
        raise CampaignError("--fit KEY=LOW..HIGH and --measured FILE.csv are missing: what is fitted, and to what")
    parameters = tuple(read_parameter(text, scene) for text in options.fit)
    keys = [parameter.key for parameter in parameters]
    if len(set(keys)) < len(keys):
        raise CampaignError(f"--fit {max(keys, key=keys.count)}: given twice")
    options.settings = dict(read_setting(text) for text in options.set)
    options.output = (options.output or Path("runs/calibration") / options.scene.stem).resolve()
    options.threads = options.threads or max(1, os.cpu_count() // options.jobs)
    program = shutil.which(options.tread)
    if not program:
        raise MachineError(f"{options.tread}: no such program; --tread names it")
    options.program = os.path.abspath(program)
    return parameters, read_curves(options.measured)


def calibrate(options):
    try:
        import matplotlib  # noqa: F401  what the picture needs, before anything runs
        import numpy as np

        from tread_jobs.fit import FitError, Problem, fitted, posterior, round_places
    except ImportError as missing:
        raise MachineError(f"calibrate needs numpy, scipy and matplotlib ({missing}): on Debian /usr/bin/python3 with python3-scipy and python3-matplotlib") from missing
    from tread_jobs.calibration_report import report_of, report_text, samples_text

    parameters, curves = prepared(options)
    rounds = Rounds(options, parameters, curves)
    if options.dry_run:
        rounds.expand(0, round_places(np.full(len(parameters), 0.5), 0.5, 0))
        return 0
    problem = Problem(parameters, np.concatenate([curve.values for curve in curves]), np.concatenate([curve.deviations for curve in curves]), rounds)
    try:
        fit = fitted(problem, options.rounds)
    except FitError as error:
        print(f"calibrate: error: {error}", file=sys.stderr)
        return STOPPED
    report = report_of(fit, parameters, curves, options.scene)
    write_text(options.output / "calibration.json", json.dumps(report, indent=1))
    write_text(options.output / "calibration.txt", report_text(report))
    write_text(options.output / "samples.toml", samples_text(options, parameters, posterior(problem, fit, options.samples)))
    print(report_text(report), end="", flush=True)
    return subprocess.run([sys.executable, str(PICTURE), str(options.output / "calibration.json")], check=False).returncode


def main():
    options = arguments()
    try:
        return calibrate(options)
    except (CampaignError, MachineError) as error:
        print(f"tread calibrate: error: {error}", file=sys.stderr)
        return error.exit_code


if __name__ == "__main__":
    sys.exit(main())
