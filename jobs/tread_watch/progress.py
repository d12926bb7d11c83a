"""How far a run is, from its log, its summary and its lock."""

import contextlib
import os
import re
import socket
import time
from dataclasses import dataclass

from tread_jobs.files import printable, read_object
from tread_jobs.status import DONE, FAILED, RUNNING, STALE, STOPPED, process_lives

TAIL_BYTES, TAIL_LINES, LINE = 32768, 40, 1000  # of the log; letters of a line
QUIET_FOR = 900  # s without a sign of life after which a run on another machine counts as stale
# A line of the log as src/io/progress.cpp writes it.
PROGRESS = re.compile(r"(?P<phase>.*)  t (?P<time>\S+) / (?P<end>\S+) s  (?P<steps>\d+) steps  (?P<speed>\S+) steps/s  ETA (?P<eta>\S+)  "
                      r"dt (?P<dt>\S+) s \((?P<limit>[^()]*)\)(?:  pull (?P<pull>\S+) N)?(?:  sinkage (?P<sinkage>\S+) m)?")


@dataclass(frozen=True)
class Progress:
    share: float  # of the simulated time, 0 to 1
    text: str
    left: str  # of wall time, h:mm:ss

    @property
    def percent(self):
        """Whole percents: 100 at the end only."""
        return f"{int(100 * self.share)} %"


@dataclass(frozen=True)
class RunState:
    state: str  # of tread_jobs.status
    reason: str
    summary: dict | None  # of a run that has ended
    progress: Progress | None  # None before the first line of it
    lines: tuple  # the last ones of the log


def state_of(folder):
    """RunState of a run directory."""
    lines = log_lines(folder)
    state, reason, summary = _ending(folder)
    found = (PROGRESS.fullmatch(line) for line in reversed(lines))
    progress = next((_progress(match) for match in found if match), None)
    return RunState(state, printable(reason), summary, progress, lines)


def inside(folder, name):
    """Path of a regular file of a folder; None where there is none, or where it leads out of the folder."""
    try:
        path, home = (folder / name).resolve(), folder.resolve()
    except (OSError, RuntimeError):  # a loop of links
        return None
    return path if path.is_relative_to(home) and path.is_file() else None


def log_lines(folder, name="log.txt"):
    """The last lines of a text file of a folder, without what is not printable."""
    path = inside(folder, name)
    if path is None:
        return ()
    with open(path, "rb") as file:
        start = max(0, file.seek(0, os.SEEK_END) - TAIL_BYTES)
        file.seek(start)
        lines = file.read(TAIL_BYTES).decode("utf-8", "replace").split("\n")
    lines = lines[1:] if start > 0 else lines
    return tuple(printable(line[:LINE]) for line in lines if line)[-TAIL_LINES:]


def _progress(match):
    done, end = _number(match["time"]), _number(match["end"])
    share = min(max(done / end, 0.0), 1.0) if end > 0 else 0.0
    parts = [f"phase {match['phase']}", f"{match['time']} of {match['end']} s", f"{match['steps']} steps", f"{match['speed']} steps/s",
             f"dt {match['dt']} s, limited by {match['limit']}"]
    parts += [f"{name} {match[name]} {unit} so far" for name, unit in (("pull", "N"), ("sinkage", "m")) if match[name]]
    return Progress(share, " · ".join(parts), match["eta"])


def _number(text):
    try:
        return float(text)
    except ValueError:
        return 0.0


def _ending(folder):
    """(state, reason, summary)"""
    if (path := inside(folder, "summary.json")) is not None:
        summary = read_object(path)
        if summary is None:
            return FAILED, "summary.json cannot be read", None
        return {"finished": DONE, "stopped": STOPPED}.get(str(summary.get("status")), FAILED), str(summary.get("reason", "")), summary
    holder = _holder(folder)
    if holder and holder[1] == socket.gethostname():
        return (RUNNING, "", None) if process_lives(holder[0]) else (STALE, f"process {holder[0]} is gone and left no summary", None)
    quiet = time.time() - _last_touched(folder)
    return (RUNNING, "", None) if quiet < QUIET_FOR else (STALE, f"no sign of life for {quiet:.0f} s", None)


def _holder(folder):
    """(process, host) of the run that had the lock last; None where that is not known."""
    path = inside(folder, ".lock")
    if path is None:
        return None
    with open(path, "rb") as file:
        found = re.fullmatch(rb"process (\d{1,9}) on (\S{1,255})\s*", file.read(512))
    return (int(found[1]), found[2].decode("utf-8", "replace")) if found else None


def _last_touched(folder):
    latest = 0.0
    for path in (folder, *folder.glob("*")):
        with contextlib.suppress(OSError):  # a run replaces its files as it goes on
            latest = max(latest, path.lstat().st_mtime)
    return latest
