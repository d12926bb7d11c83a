#!/usr/bin/python3
"""Prints `name|seconds|command` for each run of the list of docs/paper.md, in the order in which they should be made.

    studies/paper_queue.py --stages 1 2 --tread build/cuda-release/bin/tread
    studies/paper_queue.py --check --tread build/bin/tread       # `tread check` of every scene with its settings instead
"""

import argparse
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "postprocess"))

from tread_paper.runs import Plan
from tread_post import RunError


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--list", type=Path, default=ROOT / "configs" / "paper" / "round2" / "runs.toml", metavar="FILE.toml")
    parser.add_argument("--stages", type=int, nargs="+", metavar="N", help="default: all")
    parser.add_argument("--tread", default="tread", metavar="PROGRAM")
    parser.add_argument("--output", default="runs", metavar="DIR", help="where the runs go; default: runs")
    parser.add_argument("--check", action="store_true", help="check scenes and settings, run nothing")
    return parser.parse_args()


def refused(run, program):
    """What `tread check` says against a run; empty where nothing."""
    settings = [word for setting in run.set for word in ("--set", setting)]
    done = subprocess.run([program, "check", run.scene, *settings, "--json"], cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stderr.strip() if done.returncode else ""


def main():
    options = arguments()
    queue = Plan(options.list).queue(options.stages)
    failed = 0
    for run in queue:
        if options.check:
            words = refused(run, options.tread)
            failed += bool(words)
            print(f"{run.name}: {words or 'valid'}", flush=True)
        else:
            print(f"{run.name}|{run.seconds:g}|{run.command(options.tread, options.output)}")
    print(f"{len(queue)} runs, {sum(run.seconds for run in queue):g} s of a GPU", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except RunError as error:
        sys.exit(f"error: {error}")
