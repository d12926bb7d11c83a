"""Cells of the stability matrix: from matrix.toml to scenes, through `tread run`, to what each of them was."""

import copy
import itertools
import json
import re
import subprocess
import sys
import tempfile
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "jobs"))

from tread_jobs.scene_keys import canonical, with_values
from tread_jobs.toml_text import toml_text

ROWS = 500  # of the time series, in which energies are looked at
STOPPED_LATE = 10  # times the energy that was given: what is stopped after that was let go on too long
LEAST_STEPS = 100  # in the time given, of a run that does not end in it
STATUS = {0: "ran", 2: "refused", 3: "stopped", 75: "ran"}  # 75: until the wall-time limit


@dataclass(frozen=True)
class Cell:
    name: str
    scene: str
    values: dict  # by key
    unset: list
    bounds: dict
    allowed: dict  # outcome -> what its diagnosis must say; "stable" -> ""
    map: str = ""
    x: object = None
    y: object = None
    x_label: str = ""
    y_label: str = ""
    steps: float = 1.0  # of those that are asked for


@dataclass
class Result:
    outcome: str  # stable, told, stopped, refused, wrong
    expected: bool
    reason: str
    figures: dict = field(default_factory=dict)


def read_matrix(path):
    """All cells of the file, those of the maps first."""
    with open(path, "rb") as file:
        table = tomllib.load(file)
    cells = [cell for one in table.get("map", []) for cell in _cells_of_map(one, table)]
    return cells + [_cell(one["name"], one, {}, table) for one in table.get("case", [])]


def _cells_of_map(one, table):
    for x, y in itertools.product(one["x"]["values"], one["y"]["values"]):
        values = {key: x for key in one["x"]["keys"]} | {key: y for key in one["y"]["keys"]}
        yield _cell(f"{one['name']}: {_label(x)}, {_label(y)}", one, values, table, x, y)


def _cell(name, one, values, table, x=None, y=None):
    allowed = dict(one.get("must", {"stable": ""}))
    for rule in one.get("may", []):
        if x in rule.get("x", [x]) and y in rule.get("y", [y]):
            for outcome in {"told", "stopped", "refused"} & set(rule):
                allowed[outcome] = f"{allowed[outcome]}|{rule[outcome]}" if outcome in allowed else rule[outcome]
    bounds = table["bounds"] | one.get("bounds", {})
    of_map = (one["name"], x, y, one["x"]["label"], one["y"]["label"]) if "x" in one else ()
    return Cell(name, one["scene"], one.get("set", {}) | values, one.get("unset", []), bounds, allowed, *of_map, steps=one.get("steps", 1.0))


def _label(value):
    """Label of a value; of a vector, the length with the sign of what is not zero."""
    return str(sum(value)) if isinstance(value, list) else str(value)


def scene_of(cell):
    """The cell's scene, but for its time: (scene, multiple of the automatic step or None)."""
    with open(HERE / "scenes" / f"{cell.scene}.toml", "rb") as file:
        scene = tomllib.load(file)
    for key in cell.unset:
        place = canonical(scene, key)
        node = scene
        for part in place[:-1]:
            node = node[part]
        del node[place[-1]]
    values = dict(cell.values)
    share = values.pop("dt", None)
    for key in sorted(values, key=len):
        scene = with_values(scene, {canonical(scene, key): copy.deepcopy(values[key])})
    return scene, share


class Program:
    """`tread` on one backend."""

    def __init__(self, path, backend, threads=1):
        self.path, self.backend, self.threads = str(path), backend, threads

    def first_step(self, scene_path):
        """(s, "") as `tread check` reports it; or (None, why the scene is refused)."""
        done = subprocess.run([self.path, "check", scene_path], capture_output=True, text=True, check=False, timeout=300)
        if done.returncode != 0:
            return None, done.stderr.strip()
        return float(re.search(r"^dt (\S+) s at the start", done.stdout, re.MULTILINE)[1]), ""

    def run(self, scene_path, output, wall_s):
        """(exit code, what it said)"""
        limit = f"{int(wall_s) // 3600:02}:{int(wall_s) // 60 % 60:02}:{int(wall_s) % 60:02}"
        command = [self.path, "run", scene_path, "--output", output, "--backend", self.backend, "--threads", self.threads,
                   "--walltime-limit", limit, "--quiet"]
        try:
            done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, timeout=wall_s + 120)
        except subprocess.TimeoutExpired:
            return None, "hung"
        return done.returncode, done.stderr.strip()


def run_cell(program, cell, steps, wall_s, factor=1.0, steps_of_first=1.0):
    """Runs a cell for about `steps` steps, at most `wall_s` seconds; `factor` on the automatic step."""
    with tempfile.TemporaryDirectory(prefix="tread-stability-") as folder:
        folder = Path(folder)
        scene, share = scene_of(cell)
        path = folder / "scene.toml"
        path.write_text(toml_text(scene), encoding="utf-8")
        first, why = program.first_step(path)
        if first is None:
            return _judged(cell, "refused", why, {})
        fixed = scene.get("time", {}).get("dt", "auto")
        if share is not None or factor != 1.0:
            fixed = (share or 1.0) * factor * first
            scene.setdefault("time", {})["dt"] = fixed
        _set_time(scene, steps * steps_of_first * (first if fixed == "auto" else fixed))
        path.write_text(toml_text(scene), encoding="utf-8")
        code, said = program.run(path, folder / "run", wall_s)
        return _result(cell, code, said, folder / "run")


def _set_time(scene, total):
    whole = sum(phase["duration"] for phase in scene["phase"])
    for phase in scene["phase"]:
        phase["duration"] *= total / whole
    scene["output"] = {"every": total / ROWS}
    scene["checkpoint"] = {"every_wall": 0.0}


def _result(cell, code, said, run):
    status = STATUS.get(code)
    if status == "refused":
        return _judged(cell, "refused", said, {})
    if status is None or not (run / "summary.json").exists():
        return _judged(cell, "wrong", f"exit {code}: {said}", {})
    summary = json.loads((run / "summary.json").read_text(encoding="utf-8"))
    figures = _figures(summary, run / "timeseries.h5")
    if status == "stopped":
        late = not figures["energy_held"] <= STOPPED_LATE
        reason = summary["reason"]
        return _judged(cell, "wrong" if late or "t = " not in reason else "stopped", reason, figures)
    if summary["steps"] < LEAST_STEPS and summary["status"] != "finished":
        return _judged(cell, "wrong", f"{summary['steps']} steps within the time given", figures)
    broken = [name for name, bound in cell.bounds.items() if not figures.get(name, 0) <= bound]
    # What its own verdict says is not silent.
    told = broken == ["energy_error"] and "energy_error" in figures["verdict"]
    reason = "; ".join(f"{name} {figures[name]:.3g} over {cell.bounds[name]:.3g}" for name in broken)
    return _judged(cell, "told" if told else "wrong" if broken else "stable", reason, figures)


def _judged(cell, outcome, reason, figures):
    expected = outcome in cell.allowed and re.search(cell.allowed[outcome], reason) is not None
    return Result(outcome, expected, " ".join(re.sub(r"\S*/scene\.toml", "scene.toml", reason).split()), figures)


def _figures(summary, series):
    """What bounds are set on. A figure that is not a number stays one, and breaks its bound."""
    errors = {name: float("nan") if value is None else abs(value) for name, value in summary["errors"].items()}
    found = {name: figure["value"] for name, figure in summary.get("resolution", {}).get("figures", {}).items()}
    held, kinetic = _energies(series)
    return {
        "steps": summary["steps"], "substeps": summary["substeps"], "time": summary["time"], "wall_s": summary["wall_s"],
        "energy_held": held, "kinetic": kinetic, "energy_error": errors["energy"], "momentum": errors["momentum"], "mass": errors["mass"],
        "body_overlap": found.get("body_overlap") or 0.0, "point_overlap": found.get("point_overlap") or 0.0,
        "margin_body_contact": found.get("margin_body_contact") or 0.0, "host_bytes": summary["peak_host_bytes"], "verdict": _verdict(summary),
    }


def _verdict(summary):
    """The run's own, and its under-resolved figures: "under-resolved: energy_error contact_cells"."""
    resolution = summary.get("resolution", {"verdict": "", "figures": {}})
    worst = [name for name, figure in resolution["figures"].items() if figure["verdict"] == "under-resolved"]
    return resolution["verdict"] + (": " + " ".join(worst) if worst else "")


def _energies(series):
    """Kinetic and elastic energy over all that the start, falls and drives have given until then, at its largest; and the
    largest kinetic energy, J."""
    with h5py.File(series, "r") as file:
        energy = {name: file["energy"][name][:].astype(float).ravel() for name in
                  ("kinetic_points", "strain", "kinetic_bodies", "contact", "gravity", "work_in")}
    kinetic = energy["kinetic_points"] + energy["kinetic_bodies"]
    stored = kinetic + energy["strain"] + energy["contact"]
    given = stored[0] + energy["gravity"][0] - energy["gravity"] + energy["work_in"]
    given = np.maximum.accumulate(np.maximum(given, stored[0]))
    # What rounding stirs up where nothing was given is no growth.
    floor = 1e-9 * np.max(np.abs(energy["gravity"])) + 1e-24
    share = np.max(stored / (given + floor))
    return float(share), float(np.max(kinetic))
