#!/usr/bin/env python3
"""Contact problems with known answers at several spacings: docs/ladder.md.

`run` makes the runs, one after the other, and wants the standard library alone; `report` makes table and figure of them with h5py, numpy and matplotlib:

    postprocess/ladder.py run --program build/cpu-release/bin/tread --output runs/ladder
    /usr/bin/python3 postprocess/ladder.py report --output runs/ladder
"""

import argparse
import shutil
import subprocess
import sys
import time
from pathlib import Path

from tread_ladder.arguments import LadderError, changes_of, common_arguments, is_done, refuse_other_arguments, text_of, write_arguments
from tread_ladder.problems import PROBLEMS, plate_mesh, settings_of


def counts_of(problem, options):
    return options.spacings or problem.counts


def folder_of(problem, count, options):
    return options.output / problem.name / f"{count:g}"


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


def refuse_wrong_options(options):
    """Raises a LadderError for options that would spoil runs or make none."""
    if options.output.exists() and not options.output.is_dir():
        raise LadderError(f"--output {options.output}: is not a directory")
    if shutil.which(options.program) is None:
        raise LadderError(f"--program {options.program}: not found, or not executable")
    own = {key for problem in options.problems for key in changes_of(settings_of(problem, problem.counts[0]))}
    for key in changes_of(options.set):
        if key in own:
            raise LadderError(f"--set {key}: the ladder sets this key itself, by --spacings")
    refuse_other_arguments(options.output, options.set)


def run(options):
    """Makes the runs that are missing; 1 if one failed."""
    refuse_wrong_options(options)
    failed = 0
    for problem in options.problems:
        for count in counts_of(problem, options):
            if is_done(folder_of(problem, count, options)):
                continue
            write_arguments(folder_of(problem, count, options), options.set)
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
    from tread_post import RunError

    if options.set:
        raise LadderError("--set changes runs: `report` takes none")
    changes = common_arguments(options.output)
    try:
        rows = [row for problem in options.problems
                for row in rows_of(problem, {count: folder_of(problem, count, options) for count in counts_of(problem, options)
                                             if is_done(folder_of(problem, count, options))})]
    except RunError as error:
        raise LadderError(error) from error
    if not rows:
        print(f"ladder: {options.output}: no finished run", file=sys.stderr)
        return 1
    text = (f"Runs with {text_of(changes)}\n" if changes else "") + table_of(rows)
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
    return [PROBLEMS[name] for name in dict.fromkeys(names)]


def counts_from(text):
    """Even numbers: with odd ones the plate's edge and the surface of the elastic layer would lie between nodes."""
    parts = [part.strip() for part in text.split(",")]
    if not all(part.isdecimal() and int(part) > 0 and int(part) % 2 == 0 for part in parts):
        raise argparse.ArgumentTypeError(f"'{text}': accepted: even numbers above 0, such as 12,20,28")
    return list(dict.fromkeys(int(part) for part in parts))


def threads_from(text):
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"'{text}': accepted: whole numbers above 0")
    return int(text)


def setting_from(text):
    key, equals, value = text.partition("=")
    if not (key.strip() and equals and value.strip()):
        raise argparse.ArgumentTypeError(f"'{text}': accepted: KEY=VALUE")
    return text


def parser():
    made = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    made.add_argument("what", choices=("run", "report"))
    made.add_argument("--output", type=Path, default=Path("runs/ladder"))
    made.add_argument("--problems", type=problems_of, default=list(PROBLEMS.values()), metavar="A,B,...")
    made.add_argument("--spacings", type=counts_from, metavar="N,N,...",
                      help="cells across the radius or the plate, instead of each problem's own")
    made.add_argument("--program", default="tread")
    made.add_argument("--backend", default="auto", choices=("auto", "cpu", "cuda"))
    made.add_argument("--threads", type=threads_from)
    made.add_argument("--set", action="append", type=setting_from, default=[], metavar="KEY=VALUE", help="for every run; each variant wants its own --output")
    return made


def main():
    options = parser().parse_args()
    try:
        return (run if options.what == "run" else report)(options)
    except LadderError as error:
        print(f"ladder: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
