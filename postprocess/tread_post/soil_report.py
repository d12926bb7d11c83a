"""The constants of soil tests, and their figure, table and text."""

import csv
import json
import math

import numpy as np

from tread_post.soil_curves import soil_of
from tread_post.soil_fits import Constant, bekker, janosi, line, one_plate
from tread_post.soil_forms import PLASTIC, bounds_along, oedometer_modulus, shear_dilation, triaxial_dilation
from tread_post.style import COLOURS, DASHES, figure_grid, finish, readable, with_unit

# What a laboratory draws of each test: panels of (x, y), each a column.
PANELS = {
    "plate-sinkage": (("sinkage", "pressure"),),
    "cone-penetration": (("cone_index", "depth"),),
    "direct-shear": (("displacement", "shear_stress"), ("displacement", "rise")),
    "ring-shear": (("displacement", "shear_stress"), ("displacement", "sinkage")),
    "triaxial": (("axial_strain", "deviator"), ("axial_strain", "volume_strain")),
    "oedometer": (("stress", "strain"),),
    "repose": (("x", "height"),),
    "run-out": (("x", "height"),),
}
_BY_DEPTH = ("depth", "strain", "sinkage")  # drawn downwards


def _exact(value, unit):
    """A value that is read, not fitted: without an interval."""
    return Constant(float(value), math.nan, math.nan, unit)


def constants_of(curves, void_ratio=None):
    """{name: Constant} of (Run, Curve) pairs of one test; FitError where the curves do not tell them."""
    return _CONSTANTS[curves[0][1].test]([curve for _, curve in curves], void_ratio)


def _plates(curves, _):
    if len({round(curve.width, 9) for curve in curves}) > 1:
        return bekker([curve.width for curve in curves], [curve["sinkage"] for curve in curves], [curve["pressure"] for curve in curves])
    return one_plate(np.concatenate([curve["sinkage"] for curve in curves]), np.concatenate([curve["pressure"] for curve in curves]))


def _cones(curves, _):
    depth, index = (np.concatenate([curve[name] for curve in curves]) for name in ("depth", "cone_index"))
    gradient = line(depth[depth > 0], index[depth > 0], ("Pa/m", "Pa"))
    return {"cone_index_gradient": gradient["slope"], "cone_index_at_surface": gradient["intercept"]}


def _shear(curves, _):
    constants = janosi(*([curve[name] for curve in curves] for name in ("displacement", "normal_stress", "shear_stress")))
    for number, curve in enumerate(curves):
        mark = f"_{number}" if len(curves) > 1 else ""
        constants |= {f"peak_ratio{mark}": _exact(curve.peak("stress_ratio"), "1"), f"end_ratio{mark}": _exact(curve.plateau("stress_ratio"), "1")}
        if curve.test == "direct-shear":
            constants[f"dilation{mark}"] = _exact(shear_dilation(curve), "deg")
    return constants


def _triaxial(curves, _):
    """A straight line through the peaks of several confining stresses gives c and phi; one peak gives phi without cohesion."""
    constants = {}
    for number, curve in enumerate(curves):
        mark, ratio = f"_{number}" if len(curves) > 1 else "", curve.peak("stress_ratio")
        constants |= {f"peak_ratio{mark}": _exact(ratio, "1"), f"end_ratio{mark}": _exact(curve.plateau("stress_ratio"), "1"),
                      f"phi_without_c{mark}": _exact(math.degrees(math.asin((ratio - 1) / (ratio + 1))), "deg"),
                      f"dilation{mark}": _exact(triaxial_dilation(curve), "deg")}
    if len(curves) > 2:
        confining = np.array([curve.plateau("confining_stress") for curve in curves])
        axial = confining + np.array([curve.peak("deviator") for curve in curves])
        peaks = line(confining, axial, ("1", "Pa"))
        flow = max(peaks["slope"].value, 1.0)
        constants["phi"] = Constant(*(math.degrees(2 * math.atan(math.sqrt(max(bound, 0.0)))) - 90
                                      for bound in (peaks["slope"].value, peaks["slope"].low, peaks["slope"].high)), "deg")
        constants["c"] = Constant(*(bound / (2 * math.sqrt(flow)) for bound in (peaks["intercept"].value, peaks["intercept"].low,
                                                                                 peaks["intercept"].high)), "Pa")
    return constants


def _oedometers(curves, void_ratio):
    constants = {}
    for number, curve in enumerate(curves):
        mark = f"_{number}" if len(curves) > 1 else ""
        constants[f"modulus{mark}"] = _exact(oedometer_modulus(curve), "Pa")
        if void_ratio is not None:
            late = slice(len(curve["strain"]) // 2, None)
            fitted = line(np.log10(curve["stress"][late]), void_ratio - (1 + void_ratio) * curve["strain"][late], ("1", "1"))["slope"]
            constants[f"compression_index{mark}"] = Constant(-fitted.value, -fitted.high, -fitted.low, "1")
    return constants


def _facts(curves, _):
    units = {"angle_deg": "deg", "run_out": "1"}
    return {name + (f"_{number}" if len(curves) > 1 else ""): _exact(value, units[name])
            for number, curve in enumerate(curves) for name, value in curve.facts.items()}


_CONSTANTS = {"plate-sinkage": _plates, "cone-penetration": _cones, "direct-shear": _shear, "ring-shear": _shear, "triaxial": _triaxial,
              "oedometer": _oedometers, "repose": _facts, "run-out": _facts}


def model_of(curve, constants):
    """The fitted curve [rows] over the first panel's x; None where none is fitted."""
    if curve.test == "plate-sinkage":
        stiffness = constants["k"].value if "k" in constants else constants["k_c"].value / curve.width + constants["k_phi"].value
        return stiffness * np.maximum(curve["sinkage"], 0) ** constants["n"].value
    if curve.test in ("direct-shear", "ring-shear"):
        cohesion = constants["c"].value if "c" in constants else 0.0
        risen = -np.expm1(-curve["displacement"] / constants["K"].value)
        return (cohesion + constants["tan_phi"].value * curve["normal_stress"]) * risen
    return None


def figure_of(curves, constants, void_ratio=None):
    """The curves of (Run, Curve) pairs, the fits as thin black lines, and the bounds of bearing capacity in grey."""
    panels = PANELS[curves[0][1].test]
    figure, axes = figure_grid(1, len(panels), 6.5 * len(panels), 5.0)
    for axis, (across, up) in zip(axes[0], panels):
        if up == "strain" and void_ratio is not None:
            _draw_void_ratio(axis, curves, void_ratio)
        else:
            _draw(axis, curves, across, up)
        finish(axis)
    _draw_fits(axes[0, 0], curves, constants, panels[0])
    axes[0, 0].legend(frameon=False, fontsize=10)
    return figure


def _factors(curves, *names):
    """{column: (factor, unit)} with which its values read well in all curves."""
    return {name: readable(np.concatenate([curve[name] for _, curve in curves]), curves[0][1].units[name]) for name in names}


def _draw(axis, curves, across, up):
    factors = _factors(curves, across, up)
    for number, (run, curve) in enumerate(curves):
        axis.plot(factors[across][0] * curve[across], factors[up][0] * curve[up], color=COLOURS[number % len(COLOURS)],
                  linestyle=DASHES[number // len(COLOURS) % len(DASHES)], label=f"{run.path.name}: {curve.name}")
    axis.set(xlabel=with_unit(across.replace("_", " "), factors[across][1]), ylabel=with_unit(up.replace("_", " "), factors[up][1]))
    if up in _BY_DEPTH and not axis.yaxis_inverted():
        axis.invert_yaxis()


def _draw_void_ratio(axis, curves, void_ratio):
    factor, unit = _factors(curves, "stress")["stress"]
    for number, (run, curve) in enumerate(curves):
        loaded = curve["stress"] > 0
        axis.semilogx(factor * curve["stress"][loaded], void_ratio - (1 + void_ratio) * curve["strain"][loaded],
                      color=COLOURS[number % len(COLOURS)], label=f"{run.path.name}: {curve.name}")
    axis.set(xlabel=with_unit("vertical stress", unit), ylabel="void ratio")


def _draw_fits(axis, curves, constants, panel):
    across, up = panel
    if curves[0][1].test in ("oedometer", "repose", "run-out", "triaxial"):
        return
    factors = _factors(curves, across, up)
    for run, curve in curves:
        fitted = model_of(curve, constants)
        if fitted is not None:
            axis.plot(factors[across][0] * curve[across], factors[up][0] * fitted, color="black", linewidth=0.8)
        if curve.test in ("plate-sinkage", "cone-penetration") and soil_of(run)["model"] == PLASTIC:
            for bound in bounds_along(run, curve):
                load, other = ("pressure", "sinkage") if curve.test == "plate-sinkage" else ("cone_index", "depth")
                drawn = {load: factors[load][0] * bound, other: factors[other][0] * curve[other]}
                axis.plot(drawn[across], drawn[up], color="#999999", linestyle=":", linewidth=1.0)


def text_of(test, constants):
    """Lines of constants with their intervals."""
    lines = [test]
    for name, constant in constants.items():
        interval = f"  ({constant.low:.4g} to {constant.high:.4g})" if math.isfinite(constant.low) else ""
        lines.append(f"  {name:24} {constant.value:12.5g}{interval}" + ("" if constant.unit == "1" else f"  {constant.unit}"))
    return "\n".join(lines)


def write_csv(path, curves):
    """All curves, one row each time, after the run's and the curve's name; columns are named `name [unit]`."""
    names = list(curves[0][1].columns)
    with open(path, "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["run", "curve", *(f"{name} [{curves[0][1].units[name]}]" for name in names)])
        for run, curve in curves:
            rows.writerows([run.path.name, curve.name, *(f"{value:.9g}" for value in row)] for row in zip(*(curve[name] for name in names)))


def write_json(path, curves, constants):
    """The constants; an interval of null is that of a value that is read, not fitted."""
    found = {name: {"value": constant.value, "interval": [constant.low, constant.high] if math.isfinite(constant.low) else None, "unit": constant.unit}
             for name, constant in constants.items()}
    runs = list(dict.fromkeys(str(run.path) for run, _ in curves))
    path.write_text(json.dumps({"test": curves[0][1].test, "runs": runs, "constants": found}, indent=2) + "\n", encoding="utf-8")
