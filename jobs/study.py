#!/usr/bin/python3
"""Error against run time of a scene: docs/study.md. `tread study SCENE.toml --vary KEY=A,B,C ...` calls it.

Runs the scene with every combination of the values (--design grid), or with each of them alone (star), compares all runs with the right answer that the
scene names ([reference]), else with the limit that the finest lead to, and writes study.csv, study.png and study.txt: what each setting costs, how wrong
it is, and which is the cheapest within a tolerance. The same command again goes on with what is missing. Python 3.11 or later with h5py, numpy and matplotlib.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

if sys.version_info < (3, 11):
    sys.exit("study: error: Python 3.11 or later is needed")

from tread_jobs import local
from tread_jobs.campaign_file import parse_campaign
from tread_jobs.cases import make_cases, without_repetition
from tread_jobs.check import check_cases, seconds_of
from tread_jobs.directory import CampaignDirectory
from tread_jobs.errors import CampaignError, MachineError
from tread_jobs.files import printable, write_text
from tread_jobs.resources import Site
from tread_jobs.status import DONE, FAILED, UNFINISHED, case_states, summary_text
from tread_jobs.study_plan import DESIGNS, campaign_text, default_repeats, read_scene, read_setting, read_variation
from tread_jobs.submission import make_submission

REPORT = Path(__file__).resolve().parents[1] / "postprocess" / "work_precision.py"
SOME_FAILED = 3


def arguments():
    parser = argparse.ArgumentParser(prog="tread study", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path, metavar="SCENE.toml")
    parser.add_argument("--vary", action="append", default=[], metavar="KEY=A,B,...", help="a key of the scene and its values, as often as needed")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="replace one value in all variants, as often as needed")
    parser.add_argument("--design", choices=DESIGNS, default="grid",
                        help="all combinations of the values (grid, the default), or each value alone around the scene as it is (star)")
    parser.add_argument("--quantities", default="", metavar="A,B,...", help="what is compared; default: the closed form's, or by the kind of scene")
    parser.add_argument("--within", type=share, default=0.05, metavar="P%", help="tolerance of the sentences; default 5%%")
    parser.add_argument("--reference", action="append", default=[], metavar="finest|QUANTITY=VALUE",
                        help="the finest variants although the scene names an answer; or what is right, in SI units")
    parser.add_argument("--repeats", type=count, metavar="N",
                        help="perturbed repeats of the scene as it is, for the spread of what is chaotic; default: 3 with rocks and a body, else 0")
    parser.add_argument("--perturb", choices=("position", "seed"), default="position",
                        help="what repeats change: the first body's x by 1e-9 m each (default), or the seeds of the rocks: another bed")
    parser.add_argument("--output", type=Path, metavar="DIR", help="default: studies/<name of the scene file>")
    parser.add_argument("--jobs", type=positive, default=1, metavar="N", help="runs at a time; their wall times are then those of a shared machine; default 1")
    parser.add_argument("--threads", type=positive, metavar="N", help="of a run; default: the machine's cores over --jobs")
    parser.add_argument("--backend", choices=("auto", "cpu", "cuda"), default="auto")
    parser.add_argument("--gpus", type=positive, default=1, metavar="N", help="of this machine, assigned to the runs; default 1")
    parser.add_argument("--dry-run", action="store_true", help="check and list the variants and what they will cost; write and start nothing")
    parser.add_argument("--tread", default="tread", metavar="PROGRAM", help="default: tread on PATH, or the one that was called")
    return parser.parse_args()


def positive(text):
    value = count(text)
    if value < 1:
        raise argparse.ArgumentTypeError("at least 1")
    return value


def count(text):
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text}: a whole number")
    return int(text)


def share(text):
    """0.05 of 5% or 0.05."""
    try:
        value = float(text.removesuffix("%")) * (0.01 if text.endswith("%") else 1.0)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text}: a share such as 5%% or 0.05") from error
    if not 0 < value < 1:
        raise argparse.ArgumentTypeError(f"{text}: over 0 and under 100%%")
    return value


def complete(options):
    """Options as the rest uses them. CampaignError for what cannot be."""
    if not options.vary:
        raise CampaignError("--vary KEY=A,B,... is missing: a study varies something")
    options.vary = [read_variation(text) for text in options.vary]
    options.set = dict(read_setting(text) for text in options.set)
    options.quantities = [name for name in options.quantities.split(",") if name]
    options.output = (options.output or Path("studies") / options.scene.stem).resolve()
    options.threads = options.threads or max(1, os.cpu_count() // options.jobs)
    options.finest, options.known = "finest" in options.reference, {}
    for text in options.reference:
        name, equals, value = text.partition("=")
        try:
            options.known |= {name: float(value)} if equals else {}
        except ValueError as error:
            raise CampaignError(f"--reference {text}: finest, or QUANTITY=VALUE with a number") from error
        if not equals and text != "finest":
            raise CampaignError(f"--reference {text}: finest, or QUANTITY=VALUE")


def campaign_of(options, scene, quantities):
    settings = dict(options.set)
    if any(quantity.reads_points for quantity in quantities.values()) and not scene.get("output", {}).get("snapshots_every"):
        settings.setdefault("output.snapshots_every", 1e9)  # the first and the last
    repeats = default_repeats(scene) if options.repeats is None else options.repeats
    resources = {"backend": options.backend, "threads": options.threads, "gpus": 1 if options.backend == "cuda" else 0}
    text = campaign_text(options.scene, options.vary, options.design, settings, (repeats, options.perturb), resources)
    return parse_campaign(options.output / "study.toml", text)


def checked_cases(campaign, program):
    """(cases, plans) of all variants; those that differ from an earlier one in nothing that counts are left out."""
    cases = make_cases(campaign)
    with tempfile.TemporaryDirectory() as scratch:
        plans = check_cases(program, cases, len(cases), Path(scratch))
    plan_of = {case.digest: plan for case, plan in zip(cases, plans)}
    cases = without_repetition(cases, lambda case: plan_of[case.digest].scene or case.digest)
    return cases, [plan_of[case.digest] for case in cases]


def print_variants(cases, plans, resources):
    times = [seconds_of(plan, resources, Site()) for plan in plans]
    machine = "a GPU" if resources.gpus else f"{resources.threads} cores"
    for case, plan, time in zip(cases, plans, times):
        print(f"{case.name}  {plan.points:>9} points {plan.bodies:>6} bodies {plan.steps:9.3g} steps {plan.memory / 1e6:8.3g} MB  about {time:7.3g} s  "
              f"{varied_text(case)}")
    print(f"{len(cases)} variants, about {sum(times):.3g} s on {machine} by the model, {sum(plan.disk for plan in plans) / 1e9:.2g} GB of disk at most", flush=True)
    return {"seconds": sum(times), "disk": sum(plan.disk for plan in plans)}


def varied_text(case):
    """What the variant sets; the rest is as the scene has it."""
    return ", ".join(f"{name} {case.labels[name]}" for name in case.varied) or "the scene as it is"


def run_missing(options, campaign, directory, program):
    """Runs what has not finished; the states of all."""
    with directory.locked():
        states = case_states(directory, 900)
        entries = [entry for entry in directory.entries() if states[entry.name].state in UNFINISHED]
        if not entries:
            return states
        submission = make_submission(directory, entries, campaign.resources, Site(), program)
        submission.write()
        submission.record({"means": "local", "site": "", "at_once": options.jobs, "gpus": options.gpus})
        local.LocalTasks(submission, local.slots_of(options.jobs, options.gpus if options.backend == "cuda" else 0)).run()
        return case_states(directory, 900)


def print_states(states):
    print(summary_text(states))
    for name, case in states.items():
        if case.state == FAILED:
            print(f"variant {name}: {printable(case.reason)}")


def study(options):
    complete(options)
    from tread_jobs.study_answers import RunError, chosen_quantities, write_table  # what a study needs beyond the standard library, before it runs

    scene = read_scene(options.scene)
    quantities = chosen_quantities(scene, options.quantities)
    for name in options.known:
        if name not in quantities:
            raise CampaignError(f"--reference {name}: is not compared; --quantities names it")
    campaign, directory = campaign_of(options, scene, quantities), CampaignDirectory(options.output / "variants")
    program = shutil.which(options.tread)
    if not program:
        raise MachineError(f"{options.tread}: no such program; --tread names it")
    if directory.is_expanded:
        directory.refuse_another(campaign.digest)
        directory.refuse_edited()
    if options.dry_run or not directory.is_expanded:
        cases, plans = checked_cases(campaign, program)
        cost = print_variants(cases, plans, campaign.resources)
        if options.dry_run:
            return 0
        with directory.locked():
            write_text(campaign.path, campaign.text)
            directory.write(campaign, cases, cost)
    states = run_missing(options, campaign, directory, os.path.abspath(program))
    try:
        states = write_table(options.output / "study.csv", directory, states, quantities, options)
    except RunError as error:
        print_states(states)
        print(f"study: error: {printable(error)}", file=sys.stderr)
        return SOME_FAILED
    print_states(states)
    report = [sys.executable, str(REPORT), str(options.output / "study.csv"), "--within", str(options.within)]
    done = subprocess.run(report, stdout=subprocess.PIPE, text=True, check=False)
    write_text(options.output / "study.txt", done.stdout)
    print(done.stdout, end="")
    return done.returncode or (0 if all(case.state == DONE for case in states.values()) else SOME_FAILED)


def main():
    options = arguments()
    try:
        return study(options)
    except (CampaignError, MachineError) as error:
        print(f"tread study: error: {error}", file=sys.stderr)
        return error.exit_code


if __name__ == "__main__":
    sys.exit(main())
