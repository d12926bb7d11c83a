"""A wheel on grains beside the same wheel on the continuum."""

from dataclasses import dataclass

import numpy as np

from tread_post.answers import last_drive
from tread_post.run import RunError
from tread_post.steady import error_of_mean

# What counts as agreement, of the finest cells, set before any run; ours.
AGREEMENT = {"pull/load": 0.1, "torque/(load r)": 0.1, "sinkage/r": 0.05}
# Slips of drives that are compared differ by less.
SAME_SLIP = 0.01


@dataclass(frozen=True)
class Drive:
    """Means over the last half of a drive, and their standard errors, by the names of AGREEMENT; `spacing` is None on grains."""

    slip: float
    spacing: float | None  # m
    mean: dict
    error: dict


def drive_of(run):
    """Drive of a run; RunError where it drives no wheel."""
    drive, scene = last_drive(run), run.scene
    late = drive.time > 0.5 * (drive.time[0] + drive.time[-1])
    series = {name: values[late] for name, values in drive.series.items()}
    if late.sum() < 8:
        raise RunError(f"{run.path}: {late.sum()} rows in the last half of its drive; 8 at least: lower [output] every")
    radius = next(body for body in scene["body"] if body["name"] == drive.wheel).get("rolling_radius")
    if not isinstance(radius, float):
        raise RunError(f"{run.path}: '{drive.wheel}' has no rolling_radius")
    load = series["weight"].mean()
    scaled = {"pull/load": series["drawbar_pull"] / load, "torque/(load r)": series["torque"] / (load * radius), "sinkage/r": series["sinkage"] / radius}
    return Drive(float(series["slip"].mean()), scene["grid"]["spacing"] if "terrain" in scene else None,
                 {name: float(values.mean()) for name, values in scaled.items()}, {name: error_of_mean(values) for name, values in scaled.items()})


def table_of(drives):
    """Lines of the table: at each slip each quantity on grains, on the continuum by cells, and whether the finest agrees."""
    grains = sorted((drive for drive in drives if drive.spacing is None), key=lambda drive: drive.slip)
    spacings = sorted({drive.spacing for drive in drives if drive.spacing is not None}, reverse=True)
    if not grains or not spacings:
        raise RunError("runs on grains and on the continuum are needed")
    lines = ["| slip | quantity | grains | " + " | ".join(f"{1e3 * spacing:g} mm" for spacing in spacings) + " | finest less grains | accepted | agrees |",
             "|" + "---|" * (6 + len(spacings))]
    for one in grains:
        others = {drive.spacing: drive for drive in drives if drive.spacing is not None and abs(drive.slip - one.slip) < SAME_SLIP}
        if not others:
            raise RunError(f"no run on the continuum has the slip {one.slip:.3g} of one on grains")
        lines += (_line(one, others, spacings, name) for name in AGREEMENT)
    return lines


def _line(one, others, spacings, name):
    def cell(drive):
        return f"{drive.mean[name]:.3f} +- {drive.error[name]:.3f}" if drive else "-"

    off = others[min(others)].mean[name] - one.mean[name]
    cells = [f"{one.slip:.2g}", name, cell(one), *(cell(others.get(spacing)) for spacing in spacings), f"{off:+.3f}", f"{AGREEMENT[name]:g}",
             "yes" if np.abs(off) <= AGREEMENT[name] else "no"]
    return "| " + " | ".join(cells) + " |"
