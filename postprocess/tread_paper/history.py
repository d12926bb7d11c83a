"""A wheel against time since the last phase of its run began, by the names that the paper's figures and numbers go by."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tread_post.run import RunError

# Of the built-in wheels (docs/scene.md): radius over the grousers, m, and volume of the solid, m3.
RADII = {"perseverance": 0.26, "spirit": 0.13, "curiosity": 0.25}
PERSEVERANCE_VOLUME = 0.0058

UNITS = {
    "way": "m", "rise": "m", "speed": "m/s", "vertical_speed": "m/s", "pull": "N", "lift": "N", "torque": "N m", "sinkage": "m", "slip": "1",
    "indentation": "m", "lift_share": "1", "torque_share": "1", "speed_share": "1",
    "lateral_share": "1",
}


@dataclass(frozen=True)
class History:
    """Rows of the first body of `run` since its last phase began."""

    run: object
    name: str  # of that phase
    start: float  # s, of that phase

    @cached_property
    def wheel(self):
        table = self.run.wheel(self.run.wheels[0])
        rows = table["time"] >= self.start - 1e-9
        # A row at the time of the one before it is a mean over nothing.
        rows &= np.diff(table["time"], prepend=-np.inf) > 1e-9
        return {name: column[rows] for name, column in table.columns.items()}

    @property
    def time(self):
        """s, since the phase began."""
        return self.wheel["time"] - self.start

    @property
    def body(self):
        return self.run.scene["body"][0]

    @property
    def radius(self):
        """m, over the grousers."""
        shape = self.body["shape"]
        if shape in RADII:
            return RADII[shape]
        generate = {item["name"]: item.get("generate", {}) for item in self.run.scene.get("shape", [])}.get(shape, {})
        if "radius" not in generate:
            raise RunError(f"{self.run.path}: the radius of '{shape}' is not known")
        return generate["radius"]

    @property
    def weight(self):
        """N."""
        if "load" in self.body:
            return self.body["load"]
        mass = self.body.get("mass", self.body.get("density", 0.0) * PERSEVERANCE_VOLUME)
        return mass * abs(self.run.scene["domain"]["gravity"][2])

    @property
    def drive(self):
        """The phase's table, if it drives the wheel."""
        return {phase["name"]: phase for phase in self.run.scene["phase"]}[self.name].get("drive")

    @property
    def spin(self):
        """rad/s, as prescribed; 0 where nothing is."""
        return self.drive["angular_velocity"] if self.drive else 0.0

    def friction(self):
        """Friction mu, as in mu W R, of the wheel on sand, else on rock."""
        ours = [contact for contact in self.run.scene.get("contact", []) if "wheel" in contact["between"] and "wall" not in contact["between"]]
        on_sand = [contact for contact in ours if any("sand" in name for name in contact["between"])]
        return (on_sand or ours)[0]["friction"]

    def _indentation(self):
        """How far it has come, m, since it was first pressed with a twentieth of its weight: known to what it falls in a row's time."""
        pressed = self.wheel["force"][:, 2] > 0.05 * self.weight
        height = self.wheel["position"][:, 2]
        return height[np.argmax(pressed)] - height if pressed.any() else np.full(len(height), np.nan)

    def series(self, quantity):
        """[n] of a quantity of UNITS."""
        wheel = self.wheel
        columns = {
            "way": lambda: wheel["position"][:, 0] - wheel["position"][0, 0],
            "rise": lambda: wheel["position"][:, 2] - wheel["position"][0, 2],
            "speed": lambda: wheel["velocity"][:, 0],
            "vertical_speed": lambda: wheel["velocity"][:, 2],
            "pull": lambda: wheel["force"][:, 0],
            "lift": lambda: wheel["force"][:, 2],
            "torque": lambda: -wheel["torque"][:, 1],  # what drives the wheel, against the ground's
            "sinkage": lambda: wheel["sinkage"],
            "indentation": self._indentation,
            "slip": lambda: wheel["slip"],
            "lateral_share": lambda: wheel["force"][:, 1] / self.weight,
            "lift_share": lambda: wheel["force"][:, 2] / self.weight,
            "torque_share": lambda: -wheel["torque"][:, 1] / (self.friction() * self.weight * self.radius),
            "speed_share": lambda: wheel["velocity"][:, 0] / (self.spin * self.radius),
        }
        if quantity not in columns:
            raise RunError(f"no quantity '{quantity}'; there are {', '.join(columns)}")
        return columns[quantity]()


def history_of(run):
    """The History of a run that has begun."""
    phases = run.phases
    if not phases or not run.wheels:
        raise RunError(f"{run.path}: no phase has begun, or no body has a history")
    return History(run, phases[-1].name, phases[-1].start)


def smoothed(time, values, span):
    """Means over `span` (s) around each row."""
    if span <= 0 or len(time) < 3:
        return values
    sums = np.concatenate(([0.0], np.cumsum(np.nan_to_num(values))))
    first = np.searchsorted(time, time - 0.5 * span)
    last = np.searchsorted(time, time + 0.5 * span, side="right")
    return (sums[last] - sums[first]) / (last - first)
