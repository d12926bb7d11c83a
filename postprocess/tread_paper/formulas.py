"""Independent formulas beside the paper's numbers and ours.

    arithmetic("2.3 * 1.0 * 0.5 / 0.01**3")                     closed forms of the paper's own numbers
    Theories("bearing_capacity slip_sand", ...)                 theories for the scene of a run of the list:

    bearing_capacity RUN                    mm, static sinkage: Meyerhof's factors (static_sinkage.py)
    wong_reece QUANTITY RUN SLIP            sinkage (mm), pull (N), torque (N m), or speed_share with SLIP = free: from the first to the last of the published soils
    wong_reece_at QUANTITY RUN SLIP FROM TO pull or torque with the contact angle of the run's own mean sinkage there, pressure scaled to carry the weight
    resistive_force QUANTITY RUN SLIP       the same quantities by resistive force theory

SLIP is a number, `free`: that at which the pull is zero, or `own`: the mean of the run between FROM and TO.
"""

import ast
import math
import operator
import tomllib
from dataclasses import replace

import numpy as np

from static_sinkage import depth_for
from tread_paper.history import PERSEVERANCE_VOLUME
from tread_paper.measures import Absent, in_scene
from tread_post import RunError, resistive_force, wong_reece

_OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: operator.pow,
              ast.USub: operator.neg, ast.UAdd: operator.pos}
_NAMES = {"pi": math.pi}
_FUNCTIONS = {name: getattr(math, name) for name in ("sqrt", "sin", "cos", "tan", "atan", "degrees", "radians")}
# Grousers of the built-in Perseverance wheel: src/shape/generators/builtin_wheels.cpp.
GROUSERS = {"perseverance": (48, 0.0125, 0.004), "spirit": (0, 0.0, 0.0)}
UNITS = {"sinkage": (1e3, "mm"), "pull": (1.0, "N"), "torque": (1.0, "N m"), "speed_share": (1.0, "")}


def arithmetic(text):
    """The number that an expression of numbers, pi, + - * / ** and a few functions is."""
    def value_of(node):
        match node:
            case ast.Constant(value=value) if isinstance(value, (int, float)):
                return value
            case ast.Name(id=name) if name in _NAMES:
                return _NAMES[name]
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
                return _OPERATORS[type(op)](value_of(left), value_of(right))
            case ast.UnaryOp(operand=operand, op=op) if type(op) in _OPERATORS:
                return _OPERATORS[type(op)](value_of(operand))
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
                return _FUNCTIONS[name](*map(value_of, args))
        raise RunError(f"'{text}': no arithmetic")

    try:
        return float(value_of(ast.parse(text, mode="eval").body))
    except (SyntaxError, ArithmeticError, ValueError) as error:
        raise RunError(f"'{text}': {error}") from error


def applied(scene, settings):
    """The scene with settings of numbers as --set takes them; others do not matter to a formula and are left out."""
    for setting in settings:
        key, _, text = setting.partition("=")
        try:
            value = tomllib.loads(f"value = {text}")["value"]
            place, _, last = key.rpartition(".")
            table = in_scene(scene, place) if place else scene
        except (tomllib.TOMLDecodeError, RunError):
            continue
        if isinstance(table, dict):
            table[last] = value
    return scene


class Theories:
    """Theories for the scenes of a list of runs."""

    def __init__(self, plan, root, measures):
        self.plan, self.root, self.measures = plan, root, measures

    def scene(self, group):
        first = self.plan.groups[self.plan.members(group)[0]][0]
        text = (self.root / first.scene).read_text(encoding="utf-8")
        return applied(tomllib.loads(text), first.set)

    def __call__(self, text):
        """The theory's number with its name and unit. RunError where the question is none; Absent where it hangs on a run that is not there."""
        name, *words = text.split()
        ways = {"bearing_capacity": self._bearing_capacity, "wong_reece": self._wong_reece, "wong_reece_at": self._wong_reece_at,
                "resistive_force": self._resistive_force}
        if name not in ways:
            raise RunError(f"'{text}': '{name}' is none of {', '.join(ways)}")
        return ways[name](*words)

    def _bearing_capacity(self, group):
        scene = self.scene(group)
        wheel, sand, gravity = _wheel(scene), _sand(scene), _gravity(scene)
        depth = depth_for(wheel.weight, wheel.radius, wheel.width, sand["density"] * gravity, math.radians(sand["friction_angle_deg"]))
        return f"bearing capacity {1e3 * depth:.0f} mm"

    def _slip(self, slip, group, window, pull_at):
        if slip == "free":
            return resistive_force.slip_for_pull(pull_at, 0.0)
        return self.measures(f"{group} mean slip {' '.join(window)}") if slip == "own" else float(slip)

    def _wong_reece(self, quantity, group, slip, *window):
        scene = self.scene(group)
        wheel = _wheel(scene)
        found = []
        for soil in wong_reece.soils_like(scene, wheel.width):
            at = lambda one, soil=soil: getattr(wong_reece.predict(wheel, soil, one), "drawbar_pull", None)  # noqa: E731
            chosen = self._slip(slip, group, window, at)
            found.append(_quantity(quantity, wong_reece.predict(wheel, soil, chosen) if np.isfinite(chosen) else None, chosen))
        return f"Wong and Reece {_band(found, quantity)}"

    def _wong_reece_at(self, quantity, group, slip, *window):
        scene = self.scene(group)
        wheel = _wheel(scene)
        sinkage = self.measures(f"{group} mean sinkage {' '.join(window)}")
        slip = self._slip(slip, group, window, None)
        found = [_quantity(quantity, _at_sinkage(wheel, soil, slip, sinkage), slip) for soil in wong_reece.soils_like(scene, wheel.width)]
        return f"Wong and Reece at this sinkage {_band(found, quantity)}"

    def _resistive_force(self, quantity, group, slip, *window):
        scene = self.scene(group)
        wheel, sand = _wheel(scene), _sand(scene)
        shape = _shape_of(scene)
        grousers, height, width = (shape.get("grousers", 0), shape.get("grouser_height", 0.0), shape.get("grouser_width", 0.0)) if shape else GROUSERS[_body(scene)["shape"]]
        rim = resistive_force.RimWheel(wheel.radius - (height if grousers else 0.0), wheel.width, wheel.weight, grousers, height, width)
        bed = resistive_force.Sand(sand["density"], math.tan(math.radians(sand["friction_angle_deg"])), _wheel_friction(scene), _gravity(scene))
        at = lambda one: getattr(resistive_force.predict(rim, bed, 1.0, 1.0 - one), "drawbar_pull", None)  # noqa: E731
        slip = self._slip(slip, group, window, at)
        drive = resistive_force.predict(rim, bed, 1.0, 1.0 - slip) if np.isfinite(slip) else None
        return f"resistive force theory {_band([_quantity(quantity, drive, slip)], quantity)}"


def _at_sinkage(wheel, soil, slip, sinkage):
    """Wong and Reece's wheel that stands at this sinkage: the pressure's scale, which no scene tells, is what carries the weight."""
    entry = math.acos(max(1 - sinkage / wheel.radius, 0.0))
    low, high = 1.0, 1e12
    for _ in range(80):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if wong_reece.forces(wheel, replace(soil, stiffness=middle), slip, entry)[0] < wheel.weight else (low, middle)
    _, pull, torque = wong_reece.forces(wheel, replace(soil, stiffness=high), slip, entry)
    return wong_reece.Prediction(sinkage, pull, torque)


def _quantity(quantity, drive, slip):
    if quantity not in UNITS:
        raise RunError(f"'{quantity}': none of {', '.join(UNITS)}")
    if drive is None:
        return math.nan
    return {"sinkage": lambda: drive.sinkage, "pull": lambda: drive.drawbar_pull, "torque": lambda: drive.torque, "speed_share": lambda: 1 - slip}[quantity]()


def _band(values, quantity):
    scale, unit = UNITS[quantity]
    known = sorted({f"{scale * value:.2f}" if quantity == "speed_share" else f"{scale * value:.0f}" for value in values if math.isfinite(value)}, key=float)
    if not known:
        return "does not carry or drive the wheel"
    return f"{' to '.join(dict.fromkeys((known[0], known[-1])))} {unit}".strip()


def _body(scene):
    return scene["body"][0]


def _shape_of(scene):
    return next((shape["generate"] for shape in scene.get("shape", []) if shape["name"] == _body(scene)["shape"]), {})


def _gravity(scene):
    return math.sqrt(sum(part**2 for part in scene["domain"]["gravity"]))


def _sand(scene):
    """The material of the first bed of sand."""
    return in_scene(scene, f"material.{scene['terrain'][0]['material']}")


def _wheel_friction(scene):
    sand = scene["terrain"][0]["material"]
    return next((contact["friction"] for contact in scene["contact"] if set(contact["between"]) == {"wheel", sand}), 0.0)


def _wheel(scene):
    body, shape = _body(scene), _shape_of(scene)
    presets = {"perseverance": (0.26, 0.33), "spirit": (0.13, 0.16)}
    radius, width = (shape["radius"], shape["width"]) if shape else presets[body["shape"]]
    weight = body["load"] if "load" in body else body.get("mass", body.get("density", 0.0) * PERSEVERANCE_VOLUME) * _gravity(scene)
    return wong_reece.Wheel(radius, width, weight)
