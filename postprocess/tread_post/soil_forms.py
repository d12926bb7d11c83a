"""Closed forms of the soil tests: docs/soil_tests.md. The soil is perfectly plastic (Mohr-Coulomb), but for the oedometer's, which is elastic."""

import math

import numpy as np

from tread_post.bearing_capacity import Ground, flow_value, reduced_tan, round_bounds, strip_bounds
from tread_post.closed_form import ClosedForm
from tread_post.quantities import Quantity
from tread_post.run import RunError
from tread_post.soil_curves import curves_of, soil_of


def ground_of(run):
    """Ground of a run's sand under its gravity."""
    soil = soil_of(run)
    return Ground(*(math.radians(soil.get(f"{name}_angle_deg", 0.0)) for name in ("friction", "dilation")), soil.get("cohesion", 0.0),
                  soil["density"] * -run.scene["domain"]["gravity"][2])


def bounds_along(run, curve):
    """(lower, upper) bearing capacity [rows] of a plate's or a cone's curve, Pa."""
    ground = ground_of(run)
    bounds = strip_bounds if curve.facts.get("strip") else round_bounds
    depths = curve["depth" if curve.test == "cone-penetration" else "sinkage"]
    breadth = curve.width if curve.facts.get("strip") or curve.test == "cone-penetration" else 2 * curve.width
    return tuple(np.array(side) for side in zip(*(bounds(ground, breadth, max(depth, 0.0)) for depth in depths)))


def place_between(lower, upper, value):
    """0 at the lower bound, 1 at the upper one, on a logarithmic scale."""
    return float(np.log(value / lower) / np.log(upper / lower))


def _capacity(run):
    """Mean over the plates or the cone, each at the end of its curve."""
    places = []
    for curve in curves_of(run):
        load = curve.plateau("cone_index" if curve.test == "cone-penetration" else "pressure")
        lower, upper = (float(np.mean(bound[3 * len(bound) // 4:])) for bound in bounds_along(run, curve))
        if not load > 0:
            raise RunError(f"{run.path}: '{curve.name}' carries nothing at the end")
        places.append(place_between(lower, upper, load))
    return float(np.mean(places))


def _plateau(name):
    return lambda run: curves_of(run)[0].plateau(name)


def _peak(name):
    return lambda run: curves_of(run)[0].peak(name)


def slope_of_last_half(curve, x, y):
    """dy/dx over the last half of the rows."""
    half = len(curve[x]) // 2
    return float(np.polyfit(curve[x][half:], curve[y][half:], 1)[0])


def shear_dilation(curve):
    """Degrees: the angle at which the upper half of a shear box rises."""
    return math.degrees(math.atan(slope_of_last_half(curve, "displacement", "rise")))


def triaxial_dilation(curve):
    """Degrees: psi of d eps_v / d eps_1 = 1 - tan^2(45 + psi/2)."""
    rate = 1 - slope_of_last_half(curve, "axial_strain", "volume_strain")
    return math.degrees(2 * math.atan(math.sqrt(max(rate, 0.0)))) - 90


def oedometer_modulus(curve):
    """Pa: rise of the stress over the strain of the sample's inner half; of the whole sample where there are no snapshots of it."""
    name = "inner_axial_strain" if np.isfinite(curve["inner_axial_strain"]).all() else "strain"
    return slope_of_last_half(curve, name, "stress")


def _shear_answers(run):
    ground = ground_of(run)
    return {"stress_ratio": reduced_tan(ground.friction, ground.dilation), "dilation": math.degrees(ground.dilation)}


def _triaxial_answers(run):
    ground, flow = ground_of(run), flow_value(ground_of(run).friction)
    confining = curves_of(run)[0].plateau("confining_stress")
    ratio = flow + 2 * ground.cohesion * math.sqrt(flow) / confining
    return {"stress_ratio": ratio, "peak_ratio": ratio, "dilation": math.degrees(ground.dilation)}


def _oedometer_answers(run):
    soil = soil_of(run)
    young, poisson = soil["young"], soil.get("poisson", 0.3)
    return {"modulus": young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))}


def _needs(model, bodies=1):
    """The check of a scene for a box of sand of that model, and for so many bodies."""
    def needs(scene):
        models = {material.get("name"): material.get("model") for material in scene.get("material", [])}
        terrain = (scene.get("terrain") or [{}])[0]
        fits = models.get(terrain.get("material")) == model and "box" in terrain.get("region", {}) and len(scene.get("body", [])) >= bodies
        return "" if fits else f"a first [[terrain]] that fills a box with a material of model \"{model}\", and {bodies} [[body]] or more"

    return needs


PLASTIC = "mohr-coulomb"
_BETWEEN = ClosedForm("between both bounds of bearing capacity: 0 is the lower one, 1 the upper one", {"capacity": Quantity("1", _capacity, "")},
                      lambda run: {"capacity": 0.5}, 1.0, _needs(PLASTIC))
_RATIO = Quantity("1", _plateau("stress_ratio"), "mean of the last quarter")

SOIL_FORMS = {
    "plate-sinkage": _BETWEEN,
    "cone-penetration": _BETWEEN,
    "direct-shear": ClosedForm(
        "Davis (1968): sin phi cos psi / (1 - sin phi sin psi)",
        {"stress_ratio": _RATIO, "dilation": Quantity("deg", lambda run: shear_dilation(curves_of(run)[0]), "", lambda run: 45.0)},
        _shear_answers, 0.0, _needs(PLASTIC, 2)),
    # The soil beside and under the ring takes a share that no closed form has.
    "ring-shear": ClosedForm("Davis (1968), right to 15 %", {"stress_ratio": _RATIO}, lambda run: {"stress_ratio": _shear_answers(run)["stress_ratio"]},
                             0.15, _needs(PLASTIC)),
    "triaxial": ClosedForm(
        "tan^2(45 + phi/2)",
        {"stress_ratio": _RATIO, "peak_ratio": Quantity("1", _peak("stress_ratio"), "largest mean of a twentieth of the rows"),
         "dilation": Quantity("deg", lambda run: triaxial_dilation(curves_of(run)[0]), "", lambda run: 45.0)},
        _triaxial_answers, 0.0, _needs(PLASTIC, 2)),
    "oedometer": ClosedForm(
        "E (1 - nu) / ((1 + nu)(1 - 2 nu))", {"modulus": Quantity("Pa", lambda run: oedometer_modulus(curves_of(run)[0]), "", reads_points=True)},
        _oedometer_answers, 0.0, _needs("elastic")),
    "repose": ClosedForm(
        "the friction angle", {"angle": Quantity("deg", lambda run: curves_of(run)[0].facts["angle_deg"], "", reads_points=True)},
        lambda run: {"angle": soil_of(run)["friction_angle_deg"]}, 0.0, _needs(PLASTIC, 0)),
}
