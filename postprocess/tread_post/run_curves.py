"""One quantity of a run's body over another, at given places: what a measured curve is compared with."""

import numpy as np

from tread_post.quantities import body_name
from tread_post.run import RunError

# Of a body's history; time counts from the start of the phase.
COLUMNS = ("time", "sinkage", "force", "torque", "drawbar_pull", "slip")


def run_curve(run, x, y, places, phase=None):
    """Values of column `y` where column `x` has the values `places` [n], of a phase of the run, its last by default: of the first passage, where x goes
    back and forth. RunError where the run does not reach a place."""
    history, rows = run.wheel(body_name(run.scene)), _rows_of(run, phase)
    across, along = _column(history, x)[rows], _column(history, y)[rows]
    if x == "time":
        across = across - _start(run, phase)
    known = np.isfinite(across) & np.isfinite(along)
    across, along = across[known], along[known]
    first = across > np.concatenate(([-np.inf], np.maximum.accumulate(across)[:-1]))
    across, along = across[first], along[first]
    if len(across) < 2 or places.min() < across[0] or places.max() > across[-1]:
        span = f"{across[0]:.4g} to {across[-1]:.4g}" if len(across) else "nothing"
        raise RunError(f"{run.path}: {x} covers {span}; measured are {places.min():.4g} to {places.max():.4g}")
    return np.interp(places, across, along)


def _column(history, name):
    values = history.columns[name]
    if name == "force":
        return values[:, 2]
    return -values[:, 1] if name == "torque" else values


def _start(run, phase):
    begun = run.phases
    found = [entry.start for entry in begun if entry.name == phase] if phase else [entry.start for entry in begun[-1:]]
    if not found:
        raise RunError(f"{run.path}: phase '{phase}' never began; the run has {', '.join(entry.name for entry in begun)}")
    return found[-1]


def _rows_of(run, phase):
    start, time = _start(run, phase), run.wheel(body_name(run.scene))["time"]
    later = [entry.start for entry in run.phases if entry.start > start]
    return (time >= start) & (time <= min(later, default=np.inf))
