"""SLURM, as far as campaigns ask it."""

import re
import shlex
import subprocess

from tread_jobs.errors import MachineError

SBATCH = ("sbatch", "--parsable")


def submit(submission):
    """Hands the script to sbatch and returns the job's number."""
    try:
        done = subprocess.run([*SBATCH, "campaign.sbatch"], cwd=submission.folder, capture_output=True, text=True, check=False)
    except OSError as error:
        raise MachineError(f"sbatch: {error.strerror}; `local` runs without SLURM") from error
    if done.returncode:
        raise MachineError(f"{shlex.join(SBATCH)} (in {submission.folder}): {done.stderr.strip()}")
    return done.stdout.strip().partition(";")[0]


def queued_tasks(jobs):
    """State, such as PENDING, by "job_task", of those of `jobs` that wait or run; not of those that SLURM only tidies up after.
    None where SLURM does not answer."""
    if not jobs:
        return {}
    try:
        done = subprocess.run(["squeue", "--noheader", "--array", "--me", "--format=%i %T"], capture_output=True, text=True, check=False)
    except OSError:
        return None
    if done.returncode:
        return None
    found = re.findall(r"^(\d+)_(\d+) (\S+)", done.stdout, re.MULTILINE)
    return {f"{job}_{task}": state for job, task, state in found if job in jobs and state != "COMPLETING"}
