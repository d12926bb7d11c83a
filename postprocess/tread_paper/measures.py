"""Numbers of runs, by what a row of the criteria requests.

    RUN mean|min|max|spread QUANTITY [FROM TO]      over a time of the last phase, s; all of it, where it has ended
    RUN first|last QUANTITY                         in the first or last row of the last phase, where it has ended
    RUN kink QUANTITY FROM TO                       time at which two straight lines, fitted to it there, meet, s
    RUN scene KEY                                   number of the resolved scene: domain.gravity.2, material.sand.young, rocks.0.count
    RUN weight                                      of the first body, N
    RUN settled PHASE                               1 where the phase `until = "equilibrium"` found rest, else 0
    RUN when QUANTITY over|under VALUE              first time of the last phase, s
    RUN quiet QUANTITY SHARE                        time from which on it stays within this share of its last value, s
    RUN summary NAME                                of summary.json, or substeps_a_step, mean_dt, memory_mb, simulated, driven
    RUN impact NAME                                 of head_on.py: force (N), contact (s), body_speed, points_speed (m/s), recovered,
                                                    ringing (J), and the largest errors total, kinetic, elastic, both_elastic

FROM and TO are seconds since the last phase began, `end` of it, `touch` (first time with a twentieth of the weight on the wheel), or `way:M` (first time
with M metres of way), each with +SECONDS or -SECONDS if need be: touch+1, end-0.3.
"""

import re

import numpy as np

import head_on
from tread_paper.history import history_of
from tread_post.run import Run, RunError

OF_WHOLE_RUNS = {"wall_s", "steps", "substeps", "time"}  # a run that was stopped has no such number to compare


class Absent(Exception):
    """The run that a row asks for is not there, or did not get that far."""


class Measures:
    """Measures of the runs in a directory, each in a directory of its own name."""

    def __init__(self, folder):
        self.folder = folder
        self._runs = {}

    def run(self, name):
        if name not in self._runs:
            if not self.has(name):
                raise Absent(f"{name} was not run")
            self._runs[name] = Run(self.folder / name)
        return self._runs[name]

    def has(self, name):
        return (self.folder / name / "timeseries.h5").is_file()

    def __call__(self, text):
        """The number that `text` asks for. Absent where there is none yet; RunError where the question is none."""
        words = text.split()
        if words[1:] == ["weight"]:
            return float(history_of(self.run(words[0])).weight)
        if len(words) < 3:
            raise RunError(f"'{text}': expected RUN WHAT ...")
        name, what, *rest = words
        ways = {"mean": _statistic, "min": _statistic, "max": _statistic, "spread": _statistic, "first": _statistic, "last": _statistic, "when": _when,
                "quiet": _quiet, "kink": _kink, "scene": _scene, "settled": _settled, "summary": _summary, "impact": _impact}
        if what not in ways:
            raise RunError(f"'{text}': '{what}' is none of {', '.join(ways)}")
        return float(ways[what](self.run(name), what, rest))

    def tells(self, text):
        """Whether there is the number that `text` asks for."""
        try:
            self(text)
        except Absent:
            return False
        return True


def _statistic(run, what, words):
    history = history_of(run)
    time, values = history.time, history.series(words[0])
    rows = np.isfinite(values)
    if len(words) == 3:
        rows &= _within(run, history, words[1:])
    else:
        _require_whole(run, history)
    if not rows.any():
        raise Absent(f"{run.path.name} has no {words[0]} there")
    known = values[rows]
    return {"mean": np.mean, "min": np.min, "max": np.max, "spread": np.std, "first": lambda these: these[0], "last": lambda these: these[-1]}[what](known)


def _within(run, history, bounds):
    """Rows of the time between two bounds. Absent where the run does not get there."""
    time = history.time
    begin, end = (_time_of(run, history, bound) for bound in bounds)
    if not len(time) or time[-1] < end - 0.02 * (end - begin) - 0.05:
        raise Absent(f"{run.path.name} ends after {time[-1] if len(time) else 0:.1f} s")
    return (time >= begin) & (time <= end)


def was_stopped(run):
    """Whether a run ended before its phases had."""
    return (run.summary or {}).get("status", "finished") != "finished"


def _require_whole(run, history):
    """Absent where a run was stopped: what is asked of all of it, or of its end, it does not tell."""
    if was_stopped(run):
        raise Absent(f"{run.path.name} ends after {history.time[-1] if len(history.time) else 0:.1f} s")


def _time_of(run, history, bound):
    """Time (s) since the last phase began of a bound of a window."""
    found = re.fullmatch(r"(end|touch|way:([\d.]+))?([+-]?[\d.]+)?", bound)
    if not bound or not found:
        raise RunError(f"'{bound}': a time is a number, end, touch or way:M, with +S or -S")
    event, way, offset = found.groups()
    if event is None:
        return float(offset)
    if event == "end":
        _require_whole(run, history)
        when = history.time[-1]
    elif event == "touch":
        when = _first(history, history.series("lift") > 0.05 * history.weight)
    else:
        when = _first(history, history.series("way") > float(way))
    return when + float(offset or 0.0)


def _first(history, hit):
    """Time (s) of the first row that is hit. Absent where none is."""
    if not hit.any():
        raise Absent(f"never within {history.time[-1]:.1f} s")
    return history.time[np.argmax(hit)]


def _kink(run, _, words):
    history = history_of(run)
    rows = _within(run, history, words[1:])
    time, values = history.time[rows], history.series(words[0])[rows]
    if len(time) < 10:
        raise Absent(f"{run.path.name} has {len(time)} rows there")
    left = {}
    for place in np.linspace(time[0], time[-1], 101)[5:-5]:
        columns = np.stack((np.ones_like(time), time, np.clip(time - place, 0, None)), axis=1)
        fitted, *_ = np.linalg.lstsq(columns, values, rcond=None)
        left[place] = np.sum((columns @ fitted - values) ** 2)
    return min(left, key=left.get)


def in_scene(scene, key):
    """What stands in a scene under a key such as material.sand.young or domain.size.2. RunError where nothing does."""
    found = scene
    for word in key.split("."):
        try:
            if isinstance(found, list) and not word.isdigit():
                found = next(item for item in found if item.get("name") == word)
            else:
                found = found[int(word) if isinstance(found, list) else word]
        except (KeyError, IndexError, StopIteration, TypeError) as missing:
            raise RunError(f"the scene has no {key}") from missing
    return found


def _scene(run, _, words):
    value = in_scene(run.scene, words[0])
    if isinstance(value, str):
        raise Absent(f"{words[0]} is {value}")
    return value


def _settled(run, _, words):
    for phase in (run.summary or {}).get("phases", []):
        if phase["name"] == words[0] and phase.get("settled") is not None:
            return phase["settled"]
    raise Absent(f"{run.path.name} does not say whether {words[0]} found rest")


def _when(run, _, words):
    history = history_of(run)
    values, limit = history.series(words[0]), float(words[2])
    return _first(history, values > limit if words[1] == "over" else values < limit)


def _quiet(run, _, words):
    history = history_of(run)
    values = history.series(words[0])
    end = values[-max(5, len(values) // 20):].mean()
    off = np.flatnonzero(np.abs(values - end) > float(words[1]) * abs(end))
    return history.time[off[-1]] if len(off) else 0.0


def _summary(run, _, words):
    summary = run.summary
    if summary is None:
        raise Absent(f"{run.path.name} has no summary")
    if words[0] in OF_WHOLE_RUNS:
        _require_whole(run, history_of(run))
    made_up = {
        "substeps_a_step": lambda: summary["substeps"] / max(summary["steps"], 1),
        "mean_dt": lambda: summary["time"] / max(summary["steps"], 1),
        "memory_mb": lambda: summary["peak_device_bytes"] / 1e6,
        "simulated": lambda: summary["time"],
        "driven": lambda: history_of(run).time[-1],
        "energy_error": lambda: summary["errors"]["energy"],
    }
    try:
        return made_up[words[0]]() if words[0] in made_up else summary[words[0]]
    except KeyError as missing:
        raise Absent(f"the summary of {run.path.name} has no {missing}") from missing


def _impact(run, _, words):
    history = head_on.history_of(run)
    time = np.linspace(0, history.time[-1], 2001)
    rigid, elastic = (head_on.errors_of(history, head_on.hertz(run.scene, spheres, time)) for spheres in (1, 2))
    push = np.flatnonzero(history.force > 1)
    return {
        "force": lambda: history.force.max(),
        "contact": lambda: history.time[push[-1]] - history.time[push[0]],
        "body_speed": lambda: history.body_velocity[-1],
        "points_speed": lambda: history.points_velocity[-1],
        "recovered": lambda: history.body_kinetic[-1] / history.body_kinetic[0],
        "ringing": lambda: history.elastic[history.time > 0.09].mean(),
        "total": lambda: np.abs(rigid["total"]).max(),
        "kinetic": lambda: np.abs(rigid["kinetic"]).max(),
        "elastic": lambda: np.abs(rigid["elastic"]).max(),
        "both_elastic": lambda: np.abs(elastic["kinetic"]).max(),
    }[words[0]]()
