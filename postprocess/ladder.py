#!/usr/bin/env python3
"""Contact problems with known answers at several spacings: docs/ladder.md.

`run` makes the runs, one after the other, and wants the standard library alone; `report` makes table and figure of them with h5py, numpy and matplotlib:

    postprocess/ladder.py run --program build/cpu-release/bin/tread --output runs/ladder
    /usr/bin/python3 postprocess/ladder.py report --output runs/ladder
"""

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

from tread_ladder.problems import PROBLEMS, plate_mesh, settings_of


def counts_of(problem, options):
    return options.spacings or problem.counts


def folder_of(problem, count, options):
    return options.output / problem.name / f"{count:g}"


def is_done(folder):
    """Whether a run has finished there."""
    summary = folder / "summary.json"
    return summary.is_file() and json.loads(summary.read_text(encoding="utf-8")).get("status") == "finished"


def command_of(problem, count, options):
    """The command line of one run; writes the plate's mesh, which no scene can make."""
    folder, mesh = folder_of(problem, count, options), None
    if problem.body == "plate":
        mesh = (options.output / problem.name / f"plate_{count:g}.obj").resolve()
        mesh.parent.mkdir(parents=True, exist_ok=True)
        mesh.write_text(plate_mesh(problem, count), encoding="utf-8")
    command = [options.program, "run", str(problem.scene), "--output", str(folder), "--overwrite", "--quiet", "--backend", options.backend]
    if options.threads:
        command += ["--threads", str(options.threads)]
    for setting in settings_of(problem, count, mesh) + options.set:
        command += ["--set", setting]
    return command


def run(options):
    """Makes the runs that are missing; 1 if one failed."""
    failed = 0
    for problem in options.problems:
        for count in counts_of(problem, options):
            if is_done(folder_of(problem, count, options)):
                continue
            start = time.monotonic()
            command = command_of(problem, count, options)
            ended = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
            print(f"{problem.name} {count:g}: exit {ended.returncode}, {time.monotonic() - start:.1f} s", flush=True)
            if ended.returncode:
                print(f"  {' '.join(command)}\n{ended.stderr.strip()}", file=sys.stderr, flush=True)
                failed = 1
    return failed


def report(options):
    """Table, CSV and figure of the runs that are there."""
    from tread_ladder.answers import rows_of, table_of, write_csv
    from tread_ladder.picture import draw

    rows = [row for problem in options.problems
            for row in rows_of(problem, {count: folder_of(problem, count, options) for count in counts_of(problem, options)
                                         if is_done(folder_of(problem, count, options))})]
    if not rows:
        print(f"ladder: {options.output}: no finished run", file=sys.stderr)
        return 1
    text = table_of(rows)
    print(text)
    (options.output / "ladder.txt").write_text(text + "\n", encoding="utf-8")
    write_csv(options.output / "ladder.csv", rows)
    draw(options.output / "ladder.png", rows)
    return 0


def problems_of(text):
    names = text.split(",")
    unknown = [name for name in names if name not in PROBLEMS]
    if unknown:
        raise argparse.ArgumentTypeError(f"{', '.join(unknown)}: accepted: {', '.join(PROBLEMS)}")
    return [PROBLEMS[name] for name in names]


def parser():
    made = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    made.add_argument("what", choices=("run", "report"))
    made.add_argument("--output", type=Path, default=Path("runs/ladder"))
    made.add_argument("--problems", type=problems_of, default=list(PROBLEMS.values()), metavar="A,B,...")
    made.add_argument("--spacings", type=lambda text: [int(part) for part in text.split(",")], metavar="N,N,...",
                      help="cells across the radius or the plate, instead of each problem's own")
    made.add_argument("--program", default="tread")
    made.add_argument("--backend", default="auto", choices=("auto", "cpu", "cuda"))
    made.add_argument("--threads", type=int)
    made.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="for every run; use another --output for each variant")
    return made


def main():
    options = parser().parse_args()
    return (run if options.what == "run" else report)(options)


if __name__ == "__main__":
    sys.exit(main())
