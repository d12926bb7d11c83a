"""Runs a scene many times with other settings, for tables of what each run cost and told."""

import csv
import resource
import subprocess

from tread_post.run import Run, RunError

STOPPED = 3  # exit code of a run that ended with a diagnosis


def run_scene(options, scene, settings, folder, ends=(0,)):
    """Runs `scene` with KEY=VALUE settings into `folder` by options.tread, .backend and .threads, and returns the exit code, which has to be
    one of `ends`, and the Run."""
    command = [options.tread, "run", str(scene), "--output", str(folder), "--quiet", "--backend", options.backend, "--threads",
               str(options.threads)]
    for setting in settings:
        command += ["--set", setting]
    ended = subprocess.run(command, capture_output=True, text=True)
    if ended.returncode not in ends:
        raise RunError(f"{' '.join(command)}: exit {ended.returncode}: {ended.stderr.strip()}")
    return ended.returncode, Run(folder)


def processor_time():
    """Processor time (s) of all programs that ended, which other work on the machine changes least."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def write_table(path, fields, rows):
    """A CSV of rows by field name."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fields, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
