"""Numbers of runs, by what a row of docs/paper/*.toml asks for.

    RUN mean|min|max|spread QUANTITY [FROM TO]      over a time of the last phase, s; all of it
    RUN last QUANTITY                               in the last row
    RUN when QUANTITY over|under VALUE              first time of the last phase, s
    RUN quiet QUANTITY SHARE                        time from which on it stays within this share of its last value, s
    RUN summary NAME                                of summary.json, or substeps_a_step, mean_dt, memory_mb, simulated, driven
    RUN impact NAME                                 of head_on.py: force (N), contact (s), body_speed, points_speed (m/s), recovered,
                                                    ringing (J), and the largest errors total, kinetic, elastic, both_elastic
"""

import numpy as np

import head_on
from tread_paper.history import history_of
from tread_post.run import Run, RunError


class Absent(Exception):
    """The run that a row asks for is not there, or did not get that far."""


class Measures:
    """Measures of the runs in a directory, each in a directory of its own name."""

    def __init__(self, folder):
        self.folder = folder
        self._runs = {}

    def run(self, name):
        if name not in self._runs:
            if not (self.folder / name / "timeseries.h5").is_file():
                raise Absent(f"{name} was not run")
            self._runs[name] = Run(self.folder / name)
        return self._runs[name]

    def __call__(self, text):
        """The number that `text` asks for. Absent where there is none yet; RunError where the question is none."""
        words = text.split()
        if len(words) < 3:
            raise RunError(f"'{text}': expected RUN WHAT ...")
        name, what, *rest = words
        ways = {"mean": _statistic, "min": _statistic, "max": _statistic, "spread": _statistic, "last": _statistic, "when": _when, "quiet": _quiet,
                "summary": _summary, "impact": _impact}
        if what not in ways:
            raise RunError(f"'{text}': '{what}' is none of {', '.join(ways)}")
        return float(ways[what](self.run(name), what, rest))


def _statistic(run, what, words):
    history = history_of(run)
    time, values = history.time, history.series(words[0])
    rows = np.isfinite(values)
    if len(words) == 3:
        begin, end = map(float, words[1:])
        if not len(time) or time[-1] < end - 0.02 * (end - begin) - 0.05:
            raise Absent(f"{run.path.name} ends after {time[-1] if len(time) else 0:.1f} s")
        rows &= (time >= begin) & (time <= end)
    if not rows.any():
        raise Absent(f"{run.path.name} has no {words[0]} there")
    known = values[rows]
    return {"mean": np.mean, "min": np.min, "max": np.max, "spread": np.std, "last": lambda these: these[-1]}[what](known)


def _when(run, _, words):
    history = history_of(run)
    values, limit = history.series(words[0]), float(words[2])
    hit = values > limit if words[1] == "over" else values < limit
    if not hit.any():
        raise Absent(f"never within {history.time[-1]:.1f} s")
    return history.time[np.argmax(hit)]


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
