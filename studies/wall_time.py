#!/usr/bin/python3
"""Wall time that `tread check` predicts beside the time that runs take.

    wall_time.py run LIST --backend cpu|cuda --output DIR     runs the scenes of a list, one after the other, alone on the machine
    wall_time.py table DIR                                    a row for each run

A line of a list is name|scene|settings, each setting --set key=value; studies/wall_time has two lists. On a CPU runs have one thread,
and what is compared is the processor time of the whole process, on a GPU the wall time of the whole process. Set-up is predicted by the
processor time of `check`, which spends most of it there.
"""

import argparse
import json
import os
import resource
import shlex
import statistics
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "jobs"))

from tread_jobs.check import plan_of, seconds_of  # noqa: E402
from tread_jobs.resources import Resources, Site  # noqa: E402

ONE_THREAD = {**os.environ, "OMP_NUM_THREADS": "1"}
ON = {"cpu": Resources(), "cuda": Resources(gpus=1)}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--tread", default="tread", help="the program; default: tread")
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser("run", help="run the scenes of a list that DIR lacks")
    run.add_argument("list", type=Path)
    run.add_argument("--backend", choices=sorted(ON), required=True)
    run.add_argument("--output", type=Path, required=True, metavar="DIR")
    run.add_argument("--only", nargs="*", metavar="NAME", help="these of them")
    table = commands.add_parser("table", help="print predicted and measured times")
    table.add_argument("runs", type=Path, metavar="DIR")
    return parser.parse_args()


def processor_time():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run_all(options):
    for line in options.list.read_text(encoding="utf-8").splitlines():
        name, scene, settings = line.split("|")
        output = options.output / name
        if (output / "measured.json").exists() or (options.only and name not in options.only):
            continue
        command = [options.tread, "run", str(ROOT / scene), *shlex.split(settings), "--backend", options.backend, "--threads", "1", "--quiet",
                   "--overwrite", "--output", str(output)]
        before, start = processor_time(), time.monotonic()
        subprocess.run(command, check=True)
        measured = {"wall": time.monotonic() - start, "processor": processor_time() - before}
        (output / "measured.json").write_text(json.dumps(measured), encoding="utf-8")


def row_of(tread, run):
    summary = json.loads((run / "summary.json").read_text(encoding="utf-8"))
    measured = json.loads((run / "measured.json").read_text(encoding="utf-8"))
    before = processor_time()
    said = subprocess.run([tread, "check", "--json", str(run / "scene.toml")], check=True, capture_output=True, text=True, env=ONE_THREAD).stdout
    plan = replace(plan_of(said, tread), set_up=processor_time() - before)
    seconds = measured["wall" if summary["backend"] == "cuda" else "processor"]
    predicted = seconds_of(plan, ON[summary["backend"]], Site())
    steps = max(plan.work["sand_steps"], plan.work["searches"])
    return summary, steps, predicted, seconds


def print_table(options):
    ratios = []
    print("| run | points | bodies | steps: predicted, taken | substeps a step | predicted, s | measured, s | ratio |\n|---|---|---|---|---|---|---|---|")
    for run in sorted(path.parent for path in options.runs.glob("*/measured.json")):
        summary, steps, predicted, seconds = row_of(options.tread, run)
        ratios.append(predicted / seconds)
        print(f"| {run.name} | {summary['points']} | {summary['bodies']} | {steps:.0f}, {summary['steps']} | {summary['substeps'] / summary['steps']:.1f} "
              f"| {predicted:.3g} | {seconds:.3g} | {ratios[-1]:.2f} |")
    within = sum(1 / 1.5 <= ratio <= 1.5 for ratio in ratios)
    print(f"\n{within} of {len(ratios)} within a factor of 1.5; ratios {min(ratios):.2f} to {max(ratios):.2f}, median {statistics.median(ratios):.2f}")


def main():
    options = arguments()
    if options.command == "run":
        run_all(options)
    else:
        print_table(options)


if __name__ == "__main__":
    main()
