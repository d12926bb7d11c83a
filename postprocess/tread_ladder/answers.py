"""Answers of the ladder's runs, what is right, and where they lead: rows of the table."""

import csv
import math
from dataclasses import dataclass, fields

import numpy as np
from tread_post import Run
from tread_post.answers import last_drive
from tread_post.convergence import limit_of
from tread_post.quantities import QUANTITIES
from tread_post.steady import error_of_mean

LAST_PART = 0.25  # of a push, over which its load is taken
PRANDTL = 2 + math.pi


@dataclass(frozen=True)
class Row:
    problem: str
    quantity: str
    unit: str
    count: float  # cells across the problem's length
    spacing: float  # m
    value: float
    noise: float  # standard error of the mean over time
    reference: float  # NaN where none is known
    kind: str  # of the reference: "exact", "approximate", "at least" or ""
    limit: float  # extrapolated; NaN where the values do not tell
    order: float
    text: str  # on limit and order


@dataclass(frozen=True)
class Answer:
    value: float
    noise: float
    unit: str
    reference: float = math.nan
    kind: str = ""


def rows_of(problem, folders):
    """Rows of a problem's finished runs: {count: folder}."""
    answers = {count: _READERS[problem.body](problem, Run(folder)) for count, folder in folders.items()}
    return [row for name in next(iter(answers.values()), ()) for row in _fitted(problem, name, {n: one[name] for n, one in answers.items()})]


def _fitted(problem, name, answers):
    spacings = [problem.length / count for count in answers]
    limit = limit_of(spacings, [one.value for one in answers.values()], 0.0, [one.noise for one in answers.values()])
    value, order = (limit.value if limit.is_limit else math.nan), (math.nan if limit.order is None else limit.order)
    return [Row(problem.name, name, one.unit, count, h, one.value, one.noise, one.reference, one.kind, value, order, limit.text)
            for (count, one), h in zip(answers.items(), spacings)]


def _width(run):
    return run.scene["domain"]["size"][1]


def _cohesion(run):
    return run.scene["material"][0]["cohesion"]


@dataclass(frozen=True)
class Push:
    """The last quarter of a push at constant speed, N a metre of width."""

    sinkage: np.ndarray  # [n], m
    force: float
    noise: float  # standard error of the force, a linear rise taken out


def _end_of_push(run, body):
    series = run.wheel(body)
    rows = series["time"] >= (1 - LAST_PART) * series["time"][-1]
    time, force = series["time"][rows], series["force"][rows, 2] / _width(run)
    return Push(series["sinkage"][rows], float(force.mean()), error_of_mean(force - np.polyval(np.polyfit(time, force, 1), time)))


def _plate(problem, run):
    push, scale = _end_of_push(run, problem.body), 0.5 * problem.length * _cohesion(run)
    return {"load_over_c": Answer(push.force / scale, push.noise / scale, "1", PRANDTL, "exact")}


def cylinder_load(radius, cohesion, depth):
    """N a metre: smooth cylinder on weightless Tresca soil without heave, that is, a level surface that meets it at `depth` above its lowest
    point. The pressure where its normal leans by theta is c (2 + pi - 2 theta) along each slip line (Hencky)."""
    edge = math.acos(1 - depth / radius)
    return 2 * cohesion * radius * (PRANDTL * math.sin(edge) - 2 * (edge * math.sin(edge) + math.cos(edge) - 1))


def _cylinder(problem, run):
    push = _end_of_push(run, problem.body)
    least = float(np.mean([cylinder_load(problem.length, _cohesion(run), depth) for depth in push.sinkage]))
    return {"load_over_level_soil": Answer(push.force / least, push.noise / least, "1", 1.0, "at least")}


def _drum(problem, run):
    width = _width(run)

    def mean(name, unit, scale, reference=math.nan, kind=""):
        quantity = QUANTITIES[name]
        return Answer(quantity.measure(run) / scale, quantity.noise(run) / scale, unit, reference, kind)

    force = mean("force", "N/m", width, problem.load, "exact")
    if problem.name == "drum_elastic":
        # The surface of the layer strains where it carries the drum; the drum's does not.
        return {"speed_over_rim_speed": Answer(_rolled(problem, run), 0.0, "1", 1.0, "approximate"),
                "torque": mean("torque", "N", width, 0.0, "exact"), "force": force}
    # Without friction the torque is nothing. For pull and sinkage no form is known to hold: soil that keeps its volume leaves no rut in plane strain, so
    # that an inclined strip under a level surface, which leaves one, is no reference.
    torque = (0.0, "exact") if problem.name == "drum_clay_smooth" else ()
    return {"pull": mean("drawbar_pull", "N/m", width), "torque": mean("torque", "N", width, *torque), "sinkage": mean("sinkage", "m", 1.0), "force": force}


def _rolled(problem, run):
    """Way over that of the rim, in the second half of the drive after its ramp."""
    drive, series = last_drive(run), run.wheel(problem.body)
    rows = (series["time"] >= 0.5 * (drive.start + drive.time[-1])) & (series["time"] <= drive.time[-1])
    time, place, spin = series["time"][rows], series["position"][rows, 0], series["angular_velocity"][rows, 1]
    return float((place[-1] - place[0]) / (problem.length * np.mean(spin) * (time[-1] - time[0])))


_READERS = {"plate": _plate, "cylinder": _cylinder, "drum": _drum}


def error_of(row):
    """Relative error; NaN where the reference is 0 or unknown."""
    return row.value / row.reference - 1 if row.reference else math.nan


def table_of(rows):
    """Text: a line a run and quantity, below each quantity where it leads."""
    lines = [f"{'problem':22}{'quantity':22}{'cells':>6}{'h, mm':>8}{'value':>12}{'noise':>10}{'reference':>12}{'error':>9}  kind"]
    for at, row in enumerate(rows):
        error = error_of(row)
        lines.append(f"{row.problem:22}{row.quantity:22}{row.count:6g}{1e3 * row.spacing:8.3f}{row.value:12.5g}{row.noise:10.2g}"
                     f"{_text(row.reference, '12.5g'):>12}{_text(100 * error, '.1f'):>8}{' ' if math.isnan(error) else '%'}  {row.kind}")
        if at + 1 == len(rows) or (rows[at + 1].problem, rows[at + 1].quantity) != (row.problem, row.quantity):
            lines.append(f"    -> {_text(row.limit, '.5g') or 'no limit'} {row.unit}: {row.text}")
    return "\n".join(lines)


def _text(value, form):
    return "" if math.isnan(value) else format(value, form).strip()


def write_csv(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        names = [field.name for field in fields(Row)]
        writer.writerow(names)
        writer.writerows([getattr(row, name) for name in names] for row in rows)
