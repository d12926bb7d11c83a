"""What a drive told: steady means of a wheel's pull, torque, sinkage and power, at its slip."""

from dataclasses import dataclass

import numpy as np

from tread_post.run import RunError, UnreadableError
from tread_post.steady import steady_part

# Names and units, in the order of tables. Each has a mean and a spread.
QUANTITIES = {
    "slip": "1", "drawbar_pull": "N", "torque": "N m", "sinkage": "m", "power_number": "1", "weight": "N", "speed": "m/s",
}
# Those that decide together whether a drive is steady.
DECIDING = ("drawbar_pull", "torque", "sinkage")


@dataclass(frozen=True)
class Drive:
    """The rows of the last phase that drives a wheel, from the end of its ramp on."""

    wheel: str
    start: float  # s, end of the ramp
    time: np.ndarray  # [n], s
    series: dict  # by the names of QUANTITIES, each [n]


def last_drive(run):
    """The Drive of a run, as far as it has come. RunError where no wheel is driven yet."""
    phases = {phase["name"]: phase for phase in run.scene.get("phase", [])}
    begun = run.phases
    driven = [index for index, phase in enumerate(begun) if "drive" in phases.get(phase.name, {})]
    if not driven:
        raise RunError(f"{run.path}: no phase has driven a wheel")
    # A drive that would have gone on where the bed had ended took no time.
    lasting = [index for index in driven if index + 1 == len(begun) or begun[index + 1].start > begun[index].start]
    driven = _without_empty_end(run, begun, lasting) or driven
    drive = phases[begun[driven[-1]].name]["drive"]
    start = begun[driven[-1]].start + drive.get("ramp", 0.0)
    wheel = run.wheel(drive["body"])
    after = begun[driven[-1] + 1].start if driven[-1] + 1 < len(begun) else np.inf
    # A row is the mean since the one before it: all of that time must be the drive's. At the time of the one before it, it is a mean over nothing.
    before = np.concatenate(([-np.inf], wheel["time"][:-1]))
    rows = (before >= start - 1e-9) & (wheel["time"] <= after + 1e-9) & (wheel["time"] - before > 1e-9)
    if not rows.any():
        raise RunError(f"{run.path}: '{drive['body']}' is not up to speed yet")
    return Drive(drive["body"], start, wheel["time"][rows], _series(wheel, rows, np.sign(drive["angular_velocity"])))


def _without_empty_end(run, begun, driven):
    ended = run.summary is not None and len(driven) > 1 and begun[driven[-1]].start >= run.energy["time"][-1]
    return driven[:-1] if ended else driven


def _series(wheel, rows, direction):
    """Torque is what drives the wheel: that of the ground, against its spin, turned round."""
    weight, speed = wheel["force"][rows, 2], direction * wheel["velocity"][rows, 0]
    moving = speed > 1e-3 * np.abs(wheel["angular_velocity"][rows, 1]).max()
    with np.errstate(divide="ignore", invalid="ignore"):
        number = np.where(moving, wheel["power"][rows] / (weight.mean() * speed), np.nan)
    return {
        "slip": wheel["slip"][rows], "drawbar_pull": direction * wheel["drawbar_pull"][rows], "torque": -direction * wheel["torque"][rows, 1],
        "sinkage": wheel["sinkage"][rows], "power_number": number, "weight": weight, "speed": speed,
    }


def answers_of(run):
    """(values, units) by name: mean and spread of QUANTITIES over the steady part of the last drive, whether and since when it is steady.
    Empty where no wheel is up to speed, or too few rows tell anything; UnreadableError where the time series is damaged."""
    try:
        drive = last_drive(run)
    except UnreadableError:
        raise
    except RunError:
        return {}, {}
    parts = {name: steady_part(drive.time, values) for name, values in drive.series.items()}
    deciding = [parts[name] for name in DECIDING]
    if None in deciding:
        return {}, {}
    # All means are over the same rows.
    is_steady = all(part.is_steady for part in deciding)
    start = max(part.start for part in deciding) if is_steady else float(np.median(drive.time))
    rows = drive.time >= start
    values, units = {"steady": float(is_steady), "steady_from": start}, {"steady": "1", "steady_from": "s"}
    for name, unit in QUANTITIES.items():
        part = drive.series[name][rows]
        known = part[np.isfinite(part)]
        values[name], values[f"{name}_spread"] = (known.mean(), known.std()) if len(known) else (np.nan, np.nan)
        units[name] = units[f"{name}_spread"] = unit
    return {name: float(value) for name, value in values.items()}, units
