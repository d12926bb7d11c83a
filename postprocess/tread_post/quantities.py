"""What a study asks of a run: a number, or a curve, for each name."""

from dataclasses import dataclass
from typing import Callable

import numpy as np

from tread_post.answers import last_drive
from tread_post.geometry import point_spacing
from tread_post.run import RunError
from tread_post.steady import INDEPENDENT, error_of_mean

# Of the last phase of a scene that drives no wheel, over which means are taken: its end.
LAST_PART = 0.1
BINS = 24  # of a profile


@dataclass(frozen=True)
class Quantity:
    unit: str
    measure: Callable  # of a Run: a number, or a curve as an array [n]
    meaning: str
    scale: Callable | None = None  # of a Run: what errors are shares of; None: of the right answer itself
    right: float | None = None  # where it is the same for all scenes
    reads_points: bool = False  # of the last snapshot
    of_history: Callable | None = None  # of values [n] over the window: what a file of times and values is summed up by
    noise: Callable | None = None  # of a Run: standard error of a mean


@dataclass(frozen=True)
class Window:
    """Rows of a body's history over which its means are taken; the same span of time in every variant."""

    time: np.ndarray  # [n], s
    force: np.ndarray  # [n], N, upwards
    torque: np.ndarray  # [n], N m, that drives the wheel
    sinkage: np.ndarray  # [n], m
    drawbar_pull: np.ndarray  # [n], N


def body_name(scene):
    """The wheel that the last phase with a drive drives, else the first body."""
    driven = [phase["drive"]["body"] for phase in scene.get("phase", []) if "drive" in phase]
    names = [body["name"] for body in scene.get("body", [])]
    if not driven and not names:
        raise RunError("the scene has no [[body]]")
    return driven[-1] if driven else names[0]


def is_driven(scene):
    return any("drive" in phase for phase in scene.get("phase", []))


def window_of(run):
    """The second half of the last drive after its ramp; without one, the end of the last phase."""
    if is_driven(run.scene):
        drive = last_drive(run)
        rows = drive.time >= 0.5 * (drive.start + drive.time[-1])
        series = drive.series
        return Window(drive.time[rows], *(series[name][rows] for name in ("weight", "torque", "sinkage", "drawbar_pull")))
    wheel = run.wheel(body_name(run.scene))
    start = run.phases[-1].start
    rows = wheel["time"] >= wheel["time"][-1] - LAST_PART * (wheel["time"][-1] - start)
    return Window(wheel["time"][rows], wheel["force"][rows, 2], -wheel["torque"][rows, 1], wheel["sinkage"][rows], wheel["drawbar_pull"][rows])


def _mean(name):
    return lambda run: float(np.mean(getattr(window_of(run), name)))


def _noise(name):
    """Standard error of the mean over the window. A drift is no noise, as every variant has it: it is taken out before."""
    def measure(run):
        window = window_of(run)
        values = getattr(window, name)
        if len(values) < 2 * INDEPENDENT:
            return 0.0
        slope, height = np.polyfit(window.time - window.time[0], values, 1)
        return error_of_mean(values - slope * (window.time - window.time[0]) - height)

    return measure


def _largest(name, component=None):
    def measure(run):
        column = run.wheel(body_name(run.scene))[name]
        values = column if component is None else column[:, component]
        return float(np.nanmax(values))

    return measure


def unaccounted_energy(run):
    """Over the largest that changed hands."""
    return abs(run.summary["errors"]["energy"])


def profile(run):
    """Height of the sand along x in the middle of the wheel's track at the end, m, in bins of the same places for every variant."""
    if not run.snapshots or run.points(run.snapshots[-1]) is None:
        raise RunError(f"{run.path}: no snapshot of sand")
    points, scene = run.points(run.snapshots[-1]), run.scene
    middle = run.wheel(body_name(scene))["position"][-1, 1]
    near = np.abs(points.position[:, 1] - middle) <= max(0.05 * scene["domain"]["size"][1], point_spacing(scene, points))
    place, height = points.position[near, 0], points.position[near, 2]
    bins = np.clip((place / scene["domain"]["size"][0] * BINS).astype(int), 0, BINS - 1)
    top = np.full(BINS, -np.inf)
    np.maximum.at(top, bins, height)
    known = np.isfinite(top)
    if not known.any():
        raise RunError(f"{run.path}: no sand in the middle of the track")
    return np.interp(np.arange(BINS), np.flatnonzero(known), top[known])


def _load(run):
    return float(np.mean(np.abs(window_of(run).force)))


QUANTITIES = {
    "force": Quantity("N", _mean("force"), "vertical force of the ground on the wheel, mean", of_history=np.mean, noise=_noise("force")),
    "force_peak": Quantity("N", _largest("force", 2), "the largest vertical force of a row of the time series"),
    "torque": Quantity("N m", _mean("torque"), "torque that drives the wheel, mean", of_history=np.mean, noise=_noise("torque")),
    "drawbar_pull": Quantity("N", _mean("drawbar_pull"), "mean; its errors are shares of the vertical force", _load, of_history=np.mean,
                             noise=_noise("drawbar_pull")),
    "sinkage": Quantity("m", _mean("sinkage"), "mean", of_history=np.mean, noise=_noise("sinkage")),
    "sinkage_peak": Quantity("m", _largest("sinkage"), "the deepest"),
    "energy": Quantity("1", unaccounted_energy, "unaccounted, over the largest that changed hands; right is 0", lambda run: 1.0, right=0.0),
    "profile": Quantity("m", profile, "height of the sand along the track at the end; its error is the rms difference over the range",
                        reads_points=True),
}


def default_quantities(scene):
    """Names of what a scene is asked without --quantities and without a closed form."""
    if not scene.get("body"):
        return ("energy",)
    return ("torque", "drawbar_pull", "sinkage", "energy") if is_driven(scene) else ("force_peak", "sinkage_peak", "force", "energy")
