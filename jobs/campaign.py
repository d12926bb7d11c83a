#!/usr/bin/env python3
"""Campaigns of many runs: docs/campaigns.md. Python 3.11 or later; `collect` also needs h5py and numpy.

    jobs/campaign.py expand  FILE.toml --output DIR     cases/0007/scene.toml for every case; refuses clashes; prints the cost
    jobs/campaign.py submit  FILE.toml --output DIR     expands where that is not done, then a SLURM array
    jobs/campaign.py local   FILE.toml --output DIR     the same without SLURM, a few cases at a time
    jobs/campaign.py status  FILE.toml --output DIR     done, running, failed and why, not started
    jobs/campaign.py retry   FILE.toml --output DIR     what failed, stopped or never began, as it was submitted
    jobs/campaign.py collect FILE.toml --output DIR     campaign.h5 and campaign.csv: axes and answers of all cases
"""

import argparse
import os
import shutil
import sys
import tempfile
from pathlib import Path

if sys.version_info < (3, 11):
    sys.exit("campaign: error: Python 3.11 or later is needed")

from tread_jobs import local, slurm
from tread_jobs.campaign_file import read_campaign
from tread_jobs.cases import make_cases
from tread_jobs.check import check_cases, cost_of
from tread_jobs.directory import CampaignDirectory
from tread_jobs.errors import CampaignError, MachineError
from tread_jobs.resources import read_site
from tread_jobs.status import FAILED, STALE, UNFINISHED, case_states, summary_text
from tread_jobs.submission import last_means, make_submission, past_submissions

SOME_FAILED = 3


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, function in COMMANDS.items():
        command = commands.add_parser(name, help=function.__doc__.partition("\n")[0])
        command.add_argument("file", type=Path, metavar="FILE.toml", help="campaign file")
        command.add_argument("--output", type=Path, required=True, metavar="DIR", help="directory of the campaign")
        command.add_argument("--dry-run", action="store_true", help="say what would be done, write and start nothing")
        if name in ("expand", "submit", "local", "retry"):
            command.add_argument("--tread", metavar="PROGRAM", help="default: the site's, or tread on PATH")
            command.add_argument("--site", default="", metavar="NAME|FILE", help="of jobs/sites: partition, account, modules, launcher")
            command.add_argument("--checks", type=positive, default=64, metavar="N",
                                 help="cases that `tread check` looks at, evenly spread; default 64")
        if name in ("local", "retry"):
            command.add_argument("--at-once", type=positive, metavar="N", help="tasks that run at the same time on this machine; default 1")
            command.add_argument("--gpus", type=positive, metavar="N", help="of this machine, assigned to the tasks; default: the cases' own")
        if name in ("status", "retry"):
            command.add_argument("--quiet-for", type=positive, default=900, metavar="S",
                                 help="a run elsewhere without a sign of life for so long is stale; default 900")
    return parser.parse_args()


def positive(text):
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("at least 1")
    return value


def expand(options):
    """Writes a directory for every case and prints what they will cost."""
    campaign, directory = read_campaign(options.file), CampaignDirectory(options.output)
    cases, site = make_cases(campaign), read_site(options.site)
    if directory.is_expanded:
        directory.refuse_another(campaign.digest)
        directory.refuse_edited()
        print(f"{directory.path}: {len(cases)} cases, expanded before")
        return campaign, directory
    with tempfile.TemporaryDirectory() as scratch:
        plans = check_cases(program_of(options, site), cases, options.checks, Path(scratch))
    cost = cost_of(plans, len(cases), campaign.resources, site)
    print(cost.text)
    if options.dry_run:
        for case in cases:
            print(f"  {case.name}  " + ", ".join(f"{name} {label}" for name, label in case.labels.items()))
        return campaign, directory
    with directory.locked():
        directory.write(campaign, cases, cost.table)
    print(f"{directory.path}: {len(cases)} cases")
    return campaign, directory


def submit(options):
    """Submits all cases to SLURM as one array."""
    campaign, directory = expand(options)
    if options.dry_run and not directory.is_expanded:
        print("would submit all of them; --dry-run again after expand shows the script")
        return 0
    refuse_submitted(directory)
    return start(options, campaign, directory, directory.entries(), {"means": "slurm", "site": options.site})


def run_local(options):
    """Runs all cases on this machine, a few at a time."""
    campaign, directory = expand(options)
    if options.dry_run and not directory.is_expanded:
        print(f"would run all of them, {options.at_once or 1} at a time")
        return 0
    refuse_submitted(directory)
    how = {"means": "local", "site": options.site, "at_once": options.at_once or 1, "gpus": options.gpus or 0}
    return start(options, campaign, directory, directory.entries(), how)


def retry(options):
    """Takes up what failed, stopped, is stale or never began, by the same means as last time."""
    campaign, directory = opened(options)
    states = case_states(directory, options.quiet_for)
    print(summary_text(states))
    entries = [entry for entry in directory.entries() if states[entry.name].state in UNFINISHED]
    past = past_submissions(directory)
    if not entries:
        return 0
    if not past:
        raise CampaignError(f"{directory.path}: nothing was submitted yet; submit or local begins")
    how = {name: value for name, value in last_means(directory).items() if name in ("means", "site", "at_once", "gpus")}
    if not how:
        raise CampaignError(f"{past[-1][0] / 'submission.json'}: cannot be read, and no other says how cases were run; "
                            f"without {directory.submissions}, submit or local takes up what is missing")
    options.site = options.site or how["site"]
    how |= {"site": options.site} | {name: value for name in ("at_once", "gpus") if (value := getattr(options, name))}
    return start(options, campaign, directory, entries, how)


def status(options):
    """Says how far every case is."""
    _, directory = opened(options)
    states = case_states(directory, options.quiet_for)
    entries = directory.entries()
    for entry in entries:
        case = states[entry.name]
        labels = ", ".join(f"{name} {label}" for name, label in entry.labels.items())
        print(f"{entry.name}  {case.state:<11}  {labels}" + (f"  ({case.reason})" if case.reason else ""))
        for line in case.tail.splitlines():
            print(f"      | {line}")
    print(summary_text(states))
    return SOME_FAILED if any(case.state in (FAILED, STALE) for case in states.values()) else 0


def collect(options):
    """Writes campaign.h5 and campaign.csv: axes and answers of all cases, with units."""
    _, directory = opened(options)
    from tread_jobs.collect import collect_campaign  # the one command that needs more than the standard library

    for line in collect_campaign(directory, case_states(directory, 900), options.dry_run):
        print(line)
    return 0


def opened(options):
    campaign, directory = read_campaign(options.file), CampaignDirectory(options.output)
    directory.refuse_another(campaign.digest)
    directory.refuse_edited()
    return campaign, directory


def refuse_submitted(directory):
    if past_submissions(directory):
        raise CampaignError(f"{directory.path}: was submitted before; retry takes up what failed or is missing")


def program_of(options, site):
    """The whole path of tread where it can be told here; modules of a job may bring it elsewhere."""
    program = options.tread or site.program
    found = shutil.which(program)
    if found:
        return os.path.abspath(found)
    if options.tread or not site.modules:
        raise MachineError(f"{program}: no such program; --tread names it")
    return program


def start(options, campaign, directory, entries, how):
    """One submission of `entries`, by SLURM or here. The exit code."""
    site = read_site(options.site)
    with directory.locked():
        submission = make_submission(directory, entries, campaign.resources, site, program_of(options, site))
        print(f"{len(entries)} cases in {len(submission.tasks)} tasks: {submission.folder}")
        if options.dry_run:
            print(submission.script)
            return 0
        submission.write()
        if how["means"] == "slurm":
            try:
                job = slurm.submit(submission)
            except MachineError:
                shutil.rmtree(submission.folder)
                raise
            submission.record({**how, "job": job})
            print(f"job {job}")
            return 0
        submission.record(how)
        codes = local.LocalTasks(submission, local.slots_of(how["at_once"], how["gpus"])).run()
    print(summary_text(case_states(directory, 900)))
    return 0 if len(codes) == len(submission.tasks) and not any(codes.values()) else SOME_FAILED


COMMANDS = {"expand": expand, "submit": submit, "local": run_local, "status": status, "retry": retry, "collect": collect}


def main():
    options = arguments()
    try:
        result = COMMANDS[options.command](options)
    except (CampaignError, MachineError) as error:
        print(f"campaign: error: {error}", file=sys.stderr)
        return error.exit_code
    return result if isinstance(result, int) else 0


if __name__ == "__main__":
    sys.exit(main())
