"""The right answers that `[reference] form` names, from the scene of a run, and how the run's own are read."""

import math

import numpy as np

from tread_post.closed_form import ClosedForm
from tread_post.hertz_impact import hertz, history_of
from tread_post.quantities import QUANTITIES, Quantity, body_name
from tread_post.run import RunError
from tread_post.soil_forms import SOIL_FORMS


# A rigid sphere against an elastic one.


_IMPACT = {
    "force_peak": Quantity("N", lambda run: float(history_of(run).force.max()), "the largest of a row"),
    "body_speed": Quantity("m/s", lambda run: float(abs(history_of(run).body_velocity[-1])), "at the end"),
    "points_speed": Quantity("m/s", lambda run: float(abs(history_of(run).points_velocity[-1])), "at the end, of the centre of mass"),
    "energy_kept": Quantity("1", lambda run: _kept(history_of(run)), "at the end"),
}


def _impact_answers(run):
    law = hertz(run.scene, 1, np.linspace(0, history_of(run).time[-1], 40001))
    return {"force_peak": float(law.force.max()), "body_speed": float(abs(law.body_velocity[-1])),
            "points_speed": float(abs(law.points_velocity[-1])), "energy_kept": _kept(law)}


def _kept(history):
    return float(history.total[-1] / history.total[0])


def _impact_needs(scene):
    bodies, terrain = scene.get("body", []), scene.get("terrain", [])
    if len(bodies) != 1 or not {"diameter", "density", "velocity"} <= set(bodies[0]):
        return "one [[body]], a sphere with diameter, density and velocity"
    if len(terrain) != 1 or "sphere" not in terrain[0].get("region", {}) or "velocity" not in terrain[0]:
        return "one [[terrain]] that fills a sphere and has a velocity"
    return ""


# A bar, fixed at x = 0, pulled along x from t = 0 on.


def _bar_period(run):
    """From the first to the last zero of the momentum, T/2 apart; all stand half a step late, as velocities do."""
    time, momentum = run.balance["time"], run.balance["momentum"][:, 0]
    crossing = np.nonzero(momentum[1:-1] * momentum[2:] < 0)[0] + 1
    if len(crossing) < 2:
        raise RunError(f"{run.path}: the bar has not swung once")
    zeros = time[crossing] - momentum[crossing] * (time[crossing + 1] - time[crossing]) / (momentum[crossing + 1] - momentum[crossing])
    return float(2 * (zeros[-1] - zeros[0]) / (len(zeros) - 1))


def _bar_energy(run):
    """All stores, over the energy that the bar has above its equilibrium at the start, (rho g)^2 L^3 A / (6 E)."""
    material, energy = run.scene["material"][0], run.energy
    stores = sum(energy[name] for name in ("kinetic_points", "half_step", "strain", "gravity"))
    length, width, height = np.subtract(*run.scene["terrain"][0]["region"]["box"][::-1])
    weight = material["density"] * run.scene["domain"]["gravity"][0]
    return float(1 + (stores[-1] - stores[0]) / (weight**2 * length**3 * width * height / (6 * material["young"])))


def _bar_answers(run):
    material, (low, high) = run.scene["material"][0], run.scene["terrain"][0]["region"]["box"]
    return {"period": 4 * (high[0] - low[0]) / math.sqrt(material["young"] / material["density"]), "energy_kept": 1.0}


def _bar_needs(scene):
    material = scene.get("material", [{}])[0]
    fits = material.get("model") == "elastic" and material.get("poisson", 0.0) == 0.0 and _one_box(scene)
    return "" if fits else "one box of [[terrain]] along x, of an elastic material with poisson = 0"


# A bed that rests under its own weight.


def _stress_error(run):
    """Root mean square error of sigma_zz against the weight above, over that at the floor, per layer of points."""
    if len(run.snapshots) < 2:
        raise RunError(f"{run.path}: the first and the last snapshot are needed")
    last, scene = run.points(run.snapshots[-1]), run.scene
    weight = scene["material"][0]["density"] * -scene["domain"]["gravity"][2]
    low, high = (corner[2] for corner in scene["terrain"][0]["region"]["box"])
    layers = np.unique(np.round(run.points(run.snapshots[0]).position[:, 2], 9))
    start = np.round(last.position[:, 2] - last.fields["displacement"][:, 2], 6)
    errors = [np.mean(last.fields["stress"][np.abs(start - layer) < 1e-5, 2]) + weight * (high - layer) for layer in layers]
    return float(np.sqrt(np.mean(np.square(errors))) / (weight * (high - low)))


def _bed_needs(scene):
    return "" if _one_box(scene) else "one box of [[terrain]] on its floor"


# A body at rest.


def _weight(run):
    body = next(body for body in run.scene["body"] if body["name"] == body_name(run.scene))
    return {"force": body["load"] if "load" in body else body["mass"] * -run.scene["domain"]["gravity"][2]}


def _weight_needs(scene):
    bodies = scene.get("body", [])
    return "" if bodies and ("mass" in bodies[0] or "load" in bodies[0]) else "a first [[body]] with mass or load"


# A ball on a slope, made by gravity that leans towards x.


def _acceleration(run):
    """Mean of the last two thirds of the last phase: contact and slip have settled."""
    ball, start = run.wheel(body_name(run.scene)), run.phases[-1].start
    time, speed = ball["time"], ball["velocity"][:, 0]
    first = np.searchsorted(time, start + (time[-1] - start) / 3)
    return float((speed[-1] - speed[first]) / (time[-1] - time[first]))


def _rolling_answers(run):
    """About the point of contact, R less the overlap below the ball's centre, its inertia is m r^2 + 2/5 m R^2; mu_r R times the load resists."""
    scene = run.scene
    body = scene["body"][0]
    material = next(material for material in scene["material"] if material["name"] == body["material"])
    contact = next((contact for contact in scene["contact"] if set(contact["between"]) == {material.get("family", material["name"]), "wall"}), {})
    along, down, radius = scene["domain"]["gravity"][0], -scene["domain"]["gravity"][2], 0.5 * body["diameter"]
    if abs(along) > 3.5 * contact.get("friction", 0.5) * down:
        raise RunError(f"{run.path}: the ball slides: its slope is over 3.5 times the friction")
    overlap = (0.75 * body["mass"] * down * (1 - material["poisson"] ** 2) / (material["young"] * math.sqrt(radius))) ** (2 / 3)
    arm = radius - overlap
    resisting = contact.get("rolling_friction", 0.0) * radius * down * math.copysign(1.0, along)
    return {"acceleration": arm * (arm * along - resisting) / (arm**2 + 0.4 * radius**2)}


def _leans_to_x(domain):
    """Whether gravity, given as a vector or by a slope, has a part along x and one downwards."""
    if "gravity_size" not in domain:
        gravity = domain.get("gravity", [0, 0, 0])
        return gravity[0] != 0 and gravity[2] < 0
    slope, direction = domain.get("slope_deg", 0), domain.get("slope_direction_deg", 0)
    return domain["gravity_size"] > 0 and 0 < abs(slope) < 90 and direction % 180 != 90


def _rolling_needs(scene):
    bodies = scene.get("body", [])
    fits = len(bodies) == 1 and {"diameter", "mass"} <= set(bodies[0]) and _leans_to_x(scene.get("domain", {}))
    return "" if fits else "one [[body]], a sphere with diameter and mass, and gravity that leans towards x"


# A column of sand that collapses.


def _run_out(run):
    """How far beyond the column's foot 99 % of the points end, over its width."""
    width = run.scene["terrain"][0]["region"]["box"][1][0]
    return float(np.quantile(run.points(run.snapshots[-1]).position[:, 0], 0.99) / width - 1)


def _run_out_answers(run):
    width, _, height = run.scene["terrain"][0]["region"]["box"][1]
    return {"run_out": 1.2 * height / width}


def _column_needs(scene):
    if not _one_box(scene) or any(scene["terrain"][0]["region"]["box"][0]):
        return "one box of [[terrain]] in the corner of the domain"
    width, _, height = scene["terrain"][0]["region"]["box"][1]
    return "" if height <= 3 * width else "a column of at most three times its width"


def _one_box(scene):
    terrain = scene.get("terrain", [])
    return len(terrain) == 1 and "box" in terrain[0].get("region", {})


def _one(run):
    return 1.0


FORMS = {
    "hertz-impact": ClosedForm("Hertz's law, rigid and elastic", _IMPACT, _impact_answers, 0.0, _impact_needs),
    "fixed-free-bar": ClosedForm(
        "T = 4 L/c, no loss", {"period": Quantity("s", _bar_period, ""), "energy_kept": Quantity("1", _bar_energy, "")}, _bar_answers, 0.0,
        _bar_needs),
    "geostatic": ClosedForm(
        "rho g depth", {"stress_error": Quantity("1", _stress_error, "", _one, reads_points=True)}, lambda run: {"stress_error": 0.0}, 0.0,
        _bed_needs),
    "weight": ClosedForm("the weight", {"force": QUANTITIES["force"]}, _weight, 0.0, _weight_needs),
    "rolling-ball": ClosedForm("a ball that rolls", {"acceleration": Quantity("m/s2", _acceleration, "")}, _rolling_answers, 0.0, _rolling_needs),
    # Lube et al. (2005) and Lajeunesse et al. (2005) are 15 % apart.
    "run-out": ClosedForm(
        "1.2 a of two laboratories, right to 15 %", {"run_out": Quantity("1", _run_out, "", reads_points=True)}, _run_out_answers, 0.15,
        _column_needs),
    **SOIL_FORMS,
}
