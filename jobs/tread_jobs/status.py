"""How far each case is, from what stands in its directory; SLURM is asked for what waits or runs, and needs no accounting database."""

import contextlib
import os
import re
import signal
import socket
import time
from dataclasses import dataclass

from tread_jobs.files import printable, read_object, read_text
from tread_jobs.slurm import queued_tasks
from tread_jobs.submission import past_submissions

DONE, RUNNING, QUEUED, STOPPED, FAILED, STALE, NOT_STARTED = STATES = (
    "done", "running", "queued", "stopped", "failed", "stale", "not started")
# What `retry` takes up again.
UNFINISHED = (STOPPED, FAILED, STALE, NOT_STARTED)
TAIL = 5  # lines
EARLY = 75
HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"


@dataclass(frozen=True)
class CaseState:
    state: str
    reason: str  # of a failure; else short
    tail: str  # last lines of the run's output, of a failed or stale one


@dataclass(frozen=True)
class Attempt:
    """A time that a case began, by its attempts.log."""

    job: str
    host: str
    pid: int
    code: int | None  # None: it has not ended, as far as its script could say


@dataclass(frozen=True)
class Queue:
    """What SLURM knows of a campaign."""

    cases: dict  # state, such as PENDING, by case name
    tasks: dict  # the same by "job_task"
    jobs: set  # that it answered for


def case_states(directory, quiet_for):
    """CaseState by case name. An attempt on another machine that SLURM does not know counts as stale after `quiet_for` s without a sign of life."""
    entries = directory.entries()
    queue = _queue(directory)
    states = {entry.name: _state(directory.cases / entry.name, queue, entry.name, quiet_for) for entry in entries}
    return {name: CaseState(one.state, printable(one.reason), printable(one.tail)) for name, one in states.items()}


def summary_text(states):
    counts = {state: sum(one.state == state for one in states.values()) for state in STATES}
    return ", ".join(f"{count} {state}" for state, count in counts.items() if count)


def read_summary(case):
    """A run's summary.json; None while there is none that can be read."""
    return read_object(case / "run" / "summary.json")


def _queue(directory):
    submissions = [(tasks, str(how["job"])) for _, tasks, how in past_submissions(directory) if "job" in how]
    tasks = queued_tasks({job for _, job in submissions})
    if tasks is None:
        return Queue({}, {}, set())
    cases = {}
    for lists, job in submissions:
        for number, names in enumerate(lists):
            if f"{job}_{number}" in tasks:
                cases |= {name: tasks[f"{job}_{number}"] for name in names}
    return Queue(cases, tasks, {job for _, job in submissions})


def _state(case, queue, name, quiet_for):
    attempts, slurm = _attempts(case / "attempts.log"), queue.cases.get(name)
    # Of two jobs with one case, the run's lock sends the later away while the earlier goes on.
    alive = [one for one in attempts if one.code is None and _is_alive(one, case, queue, quiet_for)]
    if alive:
        return CaseState(RUNNING, f"on {alive[-1].host}", "")
    attempt = attempts[-1] if attempts else None
    if attempt and attempt.code is None and slurm != "PENDING":
        return CaseState(STALE, f"began on {attempt.host} and never ended", _tail(case))
    summary = read_summary(case)
    if attempt and attempt.code == 0 and summary and summary.get("status") == "finished":
        if not holds_series(case):
            return CaseState(FAILED, "finished, but run/timeseries.h5 is no whole HDF5 file; without run/, retry repeats it", _tail(case))
        wall = summary.get("wall_s")
        return CaseState(DONE, f"{wall:.3g} s" if isinstance(wall, float) else "", "")
    # Beside others of its task that still run, a case that failed has failed.
    if slurm and (not attempt or attempt.code == EARLY or slurm == "PENDING"):
        return CaseState(QUEUED, slurm.lower(), "")
    if not attempt:
        return CaseState(NOT_STARTED, "", "")
    if attempt.code == EARLY:
        return CaseState(STOPPED, (summary or {}).get("reason", "before its first step"), "")
    return CaseState(FAILED, _reason(attempt, summary), _tail(case))


def _is_alive(attempt, case, queue, quiet_for):
    if attempt.job in queue.tasks:
        return queue.tasks[attempt.job] != "PENDING"
    if attempt.job.rpartition("_")[0] in queue.jobs:
        return False
    if attempt.host == socket.gethostname():
        return process_lives(attempt.pid)
    return time.time() - _last_touched(case) < quiet_for


def holds_series(case):
    """Whether the run's time series begins like an HDF5 file and is as long as that says: what is damaged further in is for those to find that
    have h5py."""
    try:
        with open(case / "run" / "timeseries.h5", "rb") as file:
            head, length = file.read(52), os.fstat(file.fileno()).st_size
    except OSError:
        return False
    end_at = {0: 40, 1: 44}.get(head[8], 28) if len(head) == 52 else 0  # of the file's end in its superblock, by the version of that
    return head.startswith(HDF5_SIGNATURE) and length >= int.from_bytes(head[end_at:end_at + 8], "little")


def process_lives(pid):
    """Whether this machine has the process."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def _last_touched(case):
    latest = 0.0
    for path in (case / "run", *case.glob("run/*"), case / "output.txt"):
        with contextlib.suppress(OSError):  # a run replaces its files as it goes on
            latest = max(latest, path.stat().st_mtime)
    return latest


def _attempts(path):
    """In the order in which they began, the last one to end last."""
    try:
        lines = read_text(path).splitlines()
    except OSError:
        return []
    attempts = {}
    for line in lines:
        found = re.search(r" (start|end) job (\S+) host (\S+) pid (\d{1,9})(?: code (\d{1,3}))?$", line)
        if found:
            who, code = (found[2], found[3], int(found[4])), found[5]
            attempts.pop(who, None)
            attempts[who] = Attempt(*who, int(code) if code else None)
    return list(attempts.values())


def _reason(attempt, summary):
    if summary and summary.get("exit_code"):
        return f"exit {attempt.code}: {summary.get('reason')}"
    if attempt.code > 128:
        number = attempt.code - 128
        name = signal.Signals(number).name if number in set(signal.Signals) else f"signal {number}"
        return f"killed by {name}"
    if attempt.code == 0 and summary is None:
        return "ended, but run/summary.json cannot be read"
    return f"exit {attempt.code}"


def _tail(case):
    """What the run said to the terminal, else its own log."""
    for path in (case / "output.txt", case / "run" / "log.txt"):
        try:
            lines = read_text(path).splitlines()
        except OSError:
            continue
        if lines:
            return "\n".join(lines[-TAIL:])
    return ""
