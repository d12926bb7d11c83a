#!/usr/bin/python3
"""Measured wheels beside tread: docs/validation.md. `tread validate [SET ...]` calls it.

Runs the campaigns of the sets, stores the answers of each in SET.csv and writes validation.md with tables and figures: what was measured, tread with the
error of its grid and the band of what the source does not give, resistive force theory, and Wong and Reece's formulas. The same command again goes on
with what is missing. Python 3.11 or later with h5py, numpy and matplotlib.
"""

import argparse
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

if sys.version_info < (3, 11):
    sys.exit("validate: error: Python 3.11 or later is needed")

from tread_jobs.campaign_file import Campaign
from tread_jobs.check import seconds_of
from tread_jobs.directory import CampaignDirectory
from tread_jobs.errors import CampaignError, MachineError
from tread_jobs.local_campaign import all_checked, cost_of_plans, expand_into, print_states, run_missing
from tread_jobs.resources import Site
from tread_jobs.status import DONE
from tread_jobs.study_plan import read_setting
from tread_jobs.validation_plan import SetEntry, campaign_of, chosen_entries, read_entries

REPORT = Path(__file__).resolve().parents[1] / "postprocess" / "validation.py"
SOME_FAILED = 3


def arguments():
    parser = argparse.ArgumentParser(prog="tread validate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sets", nargs="*", metavar="SET", help="of measured wheels; default: all. --list names them")
    parser.add_argument("--list", action="store_true", help="name the sets with their sources, and run nothing")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--quick", action="store_const", const="quick", dest="form", help="two coarse runs a set: whether everything works, not what tread computes")
    form.add_argument("--nominal", action="store_const", const="nominal", dest="form", help="only the values that the scenes assume: no band, a sixth of the runs")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="replace one value in all runs, as often as needed")
    parser.add_argument("--output", type=Path, default=Path("runs/validation"), metavar="DIR", help="default: runs/validation")
    parser.add_argument("--jobs", type=positive, default=1, metavar="N", help="runs at a time; default 1")
    parser.add_argument("--threads", type=positive, metavar="N", help="of a run; default: the machine's cores over --jobs")
    parser.add_argument("--backend", choices=("auto", "cpu", "cuda"), default="auto")
    parser.add_argument("--gpus", type=positive, default=1, metavar="N", help="of this machine, assigned to the runs in turn with --backend cuda; default 1")
    parser.add_argument("--dry-run", action="store_true", help="check and list the runs and what they will cost; write and start nothing")
    parser.add_argument("--tread", default="tread", metavar="PROGRAM", help="default: tread on PATH, or the one that was called")
    parser.set_defaults(form="full")
    return parser.parse_intermixed_args()


def positive(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}: a whole number of at least 1")
    return int(text)


def folder_of(entry, options):
    """Each form has its own directory: a campaign cannot become another."""
    return options.output / (entry.name if options.form == "full" else f"{entry.name}_{options.form}")


@dataclass(frozen=True)
class Prepared:
    """A set's campaign and its directory; cases and plans are None where they were expanded before."""

    entry: SetEntry
    campaign: Campaign
    directory: CampaignDirectory
    cases: list | None
    plans: list | None


def prepared(entry, options, program):
    """The Prepared of a set, all of its cases checked. Writes nothing."""
    resources = {"backend": options.backend, "threads": options.threads, "gpus": 1 if options.backend == "cuda" else 0}
    folder = folder_of(entry, options)
    campaign = campaign_of(entry, options.form, options.settings, resources, folder / f"{entry.name}.toml")
    directory = CampaignDirectory(folder / "runs")
    if directory.is_expanded:
        directory.refuse_another(campaign.digest)
        directory.refuse_edited()
        if not options.dry_run:
            return Prepared(entry, campaign, directory, None, None)
    cases, plans = all_checked(campaign, program)
    print_plans(entry, cases, plans, campaign.resources)
    return Prepared(entry, campaign, directory, cases, plans)


def expand(made):
    if made.cases is not None:
        expand_into(made.directory, made.campaign, made.cases, cost_of_plans(made.plans, made.campaign.resources))


def print_plans(entry, cases, plans, resources):
    times = [seconds_of(plan, resources, Site()) for plan in plans]
    print(f"{entry.name}: {entry.title}")
    for case, plan, time in zip(cases, plans, times):
        labels = ", ".join(f"{name} {label}" for name, label in case.labels.items())
        print(f"  {case.name}  {plan.points:>9} points {plan.steps:9.3g} steps  about {time:7.3g} s  {labels}")
    machine = "a GPU" if resources.gpus else f"{resources.threads} cores"
    print(f"  {len(cases)} runs, about {sum(times):.3g} s on {machine} by the model", flush=True)


def run_set(made, options, program):
    """Runs what is missing of a set and stores the rows; whether all runs are done and stored."""
    states = run_missing(made.directory, made.campaign, program, options.jobs, options.gpus if options.backend == "cuda" else 0)
    print(f"{made.entry.name}: ", end="")
    print_states(states)
    sys.stdout.flush()
    rows = [sys.executable, str(REPORT), "rows", made.entry.name, str(made.directory.cases),
            "--output", str(rows_folder(options) / f"{made.entry.name}.csv")]
    stored = subprocess.run(rows, check=False).returncode == 0
    return stored and all(case.state == DONE for case in states.values())


def rows_folder(options):
    return options.output / ("rows" if options.form == "full" else f"rows_{options.form}")


def page_of(options):
    return options.output / ("validation.md" if options.form == "full" else f"validation_{options.form}.md")


def refuse_without_packages():
    """MachineError before anything runs where the report could not be written."""
    try:
        import h5py, matplotlib, numpy  # noqa: E401, F401
    except ImportError as missing:
        raise MachineError(f"validate needs h5py, numpy and matplotlib ({missing}): on Debian /usr/bin/python3 with python3-h5py and python3-matplotlib") from missing


def print_list():
    for entry in read_entries().values():
        print(f"{entry.name:8} {entry.title}\n         {entry.source}\n         {entry.campaign}")


def validate(options):
    if options.list:
        print_list()
        return 0
    entries = chosen_entries(options.sets)
    refuse_without_packages()
    options.settings = dict(read_setting(text) for text in options.set)
    options.output, options.threads = options.output.resolve(), options.threads or max(1, os.cpu_count() // options.jobs)
    program = shutil.which(options.tread)
    if not program:
        raise MachineError(f"{options.tread}: no such program; --tread names it")
    program = os.path.abspath(program)
    sets = [prepared(entry, options, program) for entry in entries]
    if options.dry_run:
        return 0
    for made in sets:
        expand(made)
    whole = [run_set(made, options, program) for made in sets]
    page = [sys.executable, str(REPORT), "page", "--rows", str(rows_folder(options)), "--page", str(page_of(options)),
            "--sets", *(entry.name for entry in entries)]
    code = subprocess.run(page, check=False).returncode
    return code or (0 if all(whole) else SOME_FAILED)


def main():
    options = arguments()
    try:
        return validate(options)
    except (CampaignError, MachineError) as error:
        print(f"tread validate: error: {error}", file=sys.stderr)
        return error.exit_code


if __name__ == "__main__":
    sys.exit(main())
