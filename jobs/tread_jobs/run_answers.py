"""Measured curves and those of runs, read with postprocess/tread_post. Needs h5py and numpy."""

import sys
from dataclasses import dataclass
from pathlib import Path

from tread_jobs.errors import CampaignError, MachineError

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "postprocess"))
try:
    import numpy as np

    from tread_post.measured import read_measured
    from tread_post.run import DAMAGE, Run, RunError, words_of
    from tread_post.run_curves import COLUMNS, run_curve
except ImportError as missing:
    raise MachineError(f"calibrate needs h5py and numpy ({missing}): on Debian /usr/bin/python3 with python3-h5py") from missing


@dataclass(frozen=True)
class MeasuredCurve:
    path: Path
    x: str  # of COLUMNS
    y: str
    places: np.ndarray  # [n]
    values: np.ndarray  # [n]
    deviations: np.ndarray  # [n], NaN where none are given


def read_curves(paths):
    """The MeasuredCurves of files. CampaignError names file and column; deviations are given for all curves or for none."""
    curves = [_curve(path) for path in paths]
    given = [bool(np.isfinite(curve.deviations).all()) for curve in curves]
    if any(given) and not all(given):
        raise CampaignError(f"{curves[given.index(False)].path}: no column of standard deviations, and {curves[given.index(True)].path} has one: all or none")
    return curves


def _curve(path):
    try:
        columns = read_measured(path).columns
    except RunError as error:
        raise CampaignError(str(error)) from error
    x, *others = columns
    ys = [name for name in others if not name.endswith("_spread")]
    if len(ys) != 1 or not {x, ys[0]} <= set(COLUMNS):
        raise CampaignError(f"{path}: columns {', '.join(columns)}: accepted: two of {', '.join(COLUMNS)}, and the second's _spread")
    spread = columns.get(f"{ys[0]}_spread", np.full(len(columns[x]), np.nan))
    if not np.isfinite(columns[x]).all() or not np.isfinite(columns[ys[0]]).all():
        raise CampaignError(f"{path}: an empty cell of {x} or {ys[0]}")
    if np.isfinite(spread).any() and not (spread > 0).all():
        raise CampaignError(f"{path}: {ys[0]}_spread: accepted: numbers over 0 in all rows, or no such column")
    return MeasuredCurve(Path(path), x, ys[0], columns[x], columns[ys[0]], spread)


def curve_values(run_path, curves, phase):
    """(values of all curves at their places, "") of a run, or (None, why there are none)."""
    try:
        run = Run(run_path)
        return np.concatenate([run_curve(run, curve.x, curve.y, curve.places, phase) for curve in curves]), ""
    except DAMAGE as error:
        return None, words_of(error)
