"""Reads configs/validation/sets.toml and the measured data that it names."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tread_post.measured import Measured, read_measured
from tread_post.resistive_force import RimWheel
from tread_post.run import RunError

SETS = Path(__file__).resolve().parents[2] / "configs" / "validation" / "sets.toml"
QUANTITIES = ("drawbar_pull", "torque", "sinkage", "slip")
ABSCISSAE = ("slip", "slope")


@dataclass(frozen=True)
class Curve:
    name: str
    measured: Measured
    wheel: dict  # radius of the drum, width, grousers, grouser_height, grouser_width
    load: float  # N, where the data have no column of it; else NaN

    @property
    def loads(self):
        """Load at each measured point, N, [n]."""
        return self.measured.columns.get("load", np.full(len(self.measured), self.load))

    def wheel_under(self, weight):
        return RimWheel(weight=weight, **self.wheel)


@dataclass(frozen=True)
class MeasuredSet:
    name: str
    title: str
    source: str
    campaign: Path
    quick: Path
    scene: dict
    against: str  # of ABSCISSAE
    quantities: tuple
    theory: tuple  # dictionaries of density, friction_angle_deg, rim_friction
    bekker: tuple  # dictionaries of Bekker's and Janosi's constants
    curves: tuple

    def curve(self, grousers, outer_radius):
        """The curve of a wheel with so many grousers and of this radius over them, m; None where the set has none."""
        return next((curve for curve in self.curves if curve.wheel["grousers"] == grousers
                     and abs(curve.wheel_under(1.0).outer_radius / outer_radius - 1) < 1e-3), None)


def read_sets(path=SETS):
    """{name: MeasuredSet}. RunError says what is wrong with the file or with the data."""
    try:
        table = tomllib.loads(Path(path).read_text(encoding="utf-8"))
        return {entry["name"]: _set(entry, Path(path).parent) for entry in table["set"]}
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RunError(f"{path}: {error!r}") from error


def _set(entry, folder):
    if entry["against"] not in ABSCISSAE or not set(entry["quantities"]) <= set(QUANTITIES):
        raise RunError(f"set {entry['name']}: against is one of {', '.join(ABSCISSAE)}, quantities are of {', '.join(QUANTITIES)}")
    scene = tomllib.loads((folder / entry["scene"]).read_text(encoding="utf-8"))
    curves = tuple(Curve(curve["name"], read_measured(folder / curve["measured"]), curve["wheel"], curve.get("load", np.nan)) for curve in entry["curve"])
    for curve in curves:
        missing = [name for name in (entry["against"], *entry["quantities"]) if name not in curve.measured.columns]
        if missing:
            raise RunError(f"{curve.measured.path}: column {missing[0]} is missing; set {entry['name']} compares it")
        if np.isnan(curve.loads).any():
            raise RunError(f"{curve.measured.path}: no load, and curve {curve.name} of set {entry['name']} gives none")
    return MeasuredSet(entry["name"], entry["title"], entry["source"], folder / entry["campaign"], folder / entry["quick"], scene,
                       entry["against"], tuple(entry["quantities"]), tuple(entry["theory"]), tuple(entry["bekker"]), curves)
