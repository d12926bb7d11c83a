"""A campaign on this machine from its checked cases to their states: what `tread study`, `tread validate` and `tread calibrate` share."""

import tempfile
from pathlib import Path

from tread_jobs import local
from tread_jobs.cases import make_cases
from tread_jobs.check import check_cases, seconds_of
from tread_jobs.files import printable, write_text
from tread_jobs.resources import Site
from tread_jobs.status import FAILED, UNFINISHED, case_states, summary_text
from tread_jobs.submission import make_submission


def all_checked(campaign, program):
    """(cases, plans) of a campaign; CampaignError with tread's words for the first case that is wrong."""
    cases = make_cases(campaign)
    with tempfile.TemporaryDirectory() as scratch:
        return cases, check_cases(program, cases, len(cases), Path(scratch))


def cost_of_plans(plans, resources):
    """{"seconds", "disk"}: what the cases take one after the other, by the model, and at most on disk."""
    return {"seconds": sum(seconds_of(plan, resources, Site()) for plan in plans), "disk": sum(plan.disk for plan in plans)}


def expand_into(directory, campaign, cases, cost):
    """Writes the cases of a campaign that was checked, and its file."""
    with directory.locked():
        write_text(campaign.path, campaign.text)
        directory.write(campaign, cases, cost)


def run_missing(directory, campaign, program, at_once, gpus):
    """Runs what has not finished, `at_once` at a time on `gpus` GPUs; the states of all cases."""
    with directory.locked():
        states = case_states(directory, 900)
        entries = [entry for entry in directory.entries() if states[entry.name].state in UNFINISHED]
        if not entries:
            return states
        submission = make_submission(directory, entries, campaign.resources, Site(), program)
        submission.write()
        submission.record({"means": "local", "site": "", "at_once": at_once, "gpus": gpus})
        local.LocalTasks(submission, local.slots_of(at_once, gpus)).run()
        return case_states(directory, 900)


def print_states(states, thing="case"):
    """Prints how many cases are in which state, and why those that failed did."""
    print(summary_text(states))
    for name, case in states.items():
        if case.state == FAILED:
            print(f"{thing} {name}: {printable(case.reason)}")
