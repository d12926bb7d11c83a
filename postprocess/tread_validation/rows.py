"""What runs of a set's scene answered: a row a run, as it is stored."""

import math
from dataclasses import asdict, dataclass

from tread_post.answers import answers_of
from tread_post.rows import read_rows, write_rows
from tread_post.run import DAMAGE, Run, RunError, words_of
from tread_post.verdict import resolution_of
from tread_validation.sets import QUANTITIES

FINISHED = "finished"
SAME = 1e-6  # relative difference up to which two values of a scene are one
STORED_ERRORS = {"drawbar_pull": "pull_error", "torque": "torque_error", "sinkage": "sinkage_error"}


@dataclass(frozen=True)
class Row:
    """Answers of a run; those of a quantity that it does not have are NaN."""

    set: str
    curve: str
    at: float  # slip that was prescribed, or slope in degrees
    spacing: float  # m
    assumed: str  # what differs from the set's scene; "" where nothing does
    drawbar_pull: float  # N
    drawbar_pull_spread: float
    drawbar_pull_grid: float  # estimated error of the grid, N
    torque: float  # N m
    torque_spread: float
    torque_grid: float
    sinkage: float  # m
    sinkage_spread: float
    sinkage_grid: float
    slip: float
    slip_spread: float
    slip_grid: float
    weight: float  # N
    steady: int  # 1: pull, torque and sinkage are steady
    verdict: str
    points: int
    wall_s: float
    version: str
    commit: str
    device: str
    run: str


def assumed_values(scene):
    """{name: value} of what sets vary, by names that tables can print: the sand is the first granular material, the rim the driven body's."""
    sand = next(material for material in scene["material"] if "friction_angle_deg" in material)
    driven = next(phase["drive"]["body"] for phase in reversed(scene["phase"]) if "drive" in phase)
    body = next(body for body in scene["body"] if body["name"] == driven)
    rim = next(material for material in scene["material"] if material["name"] == body["material"])
    pair = {rim.get("family", rim["name"]), sand.get("family", sand["name"])}
    contact = next((contact for contact in scene.get("contact", []) if set(contact["between"]) == pair), {})
    return {
        "rim friction": contact.get("friction", 0.3), "modulus [Pa]": sand["young"], "density [kg/m3]": sand["density"],
        "friction angle [deg]": sand["friction_angle_deg"], "dilation angle [deg]": sand.get("dilation_angle_deg", 0.0),
        "cohesion [Pa]": sand.get("cohesion", 0.0), "law": sand["model"], "relative density": sand.get("relative_density", math.nan),
        "modulus grows up to [Pa]": sand.get("young_pressure", 0.0), "softening length [m]": sand.get("softening_length") or 0.0,
    }


def differences(scene, nominal):
    """What of assumed_values differs from those of the set's own scene, in words; "" where nothing does."""
    values, own = assumed_values(scene), assumed_values(nominal)
    return ", ".join(f"{name} {value if isinstance(value, str) else f'{value:g}'}" for name, value in values.items() if _differ(value, own[name]))


def _differ(value, other):
    """Words differ unless equal, numbers by more than SAME of their size; what a law does not have is NaN and differs from nothing."""
    if isinstance(value, str):
        return value != other
    return not math.isnan(value) and not abs(value - other) <= SAME * max(abs(value), abs(other))


def row_of(measured_set, path):
    """The Row of a run directory. RunError where it is no finished run of the set, or has no answers."""
    run = Run(path)
    try:
        curve = measured_set.curve(*wheel_of(run.scene))
        if curve is None:
            raise RunError(f"{path}: no wheel of set {measured_set.name}")
        if not run.summary or run.summary.get("status") != FINISHED:
            raise RunError(f"{path}: did not finish")
        answers, _ = answers_of(run)
        if not answers:
            raise RunError(f"{path}: its drive is too short to give answers")
        return Row(set=measured_set.name, curve=curve.name, at=_place(run.scene, measured_set.against), spacing=run.scene["grid"]["spacing"],
                   assumed=differences(run.scene, measured_set.scene), steady=int(answers["steady"]), weight=answers["weight"],
                   run=path.parent.name if path.name == "run" else path.name, **_quantities(answers, resolution_of(run.summary).errors),
                   **_provenance(run.summary))
    except RunError:
        raise
    except (*DAMAGE, StopIteration) as error:
        raise RunError(f"{path}: {words_of(error)}") from error


def wheel_of(scene):
    """(grousers, radius over them in m) of the scene's generated wheel."""
    drum = next(shape["generate"] for shape in scene["shape"] if shape.get("generate", {}).get("kind") == "wheel")
    return drum.get("grousers", 48), drum.get("radius", 0.26)


def _place(scene, against):
    if against == "slip":
        slip = next(phase["drive"].get("slip", "free") for phase in reversed(scene["phase"]) if "drive" in phase)
        if not isinstance(slip, (int, float)):
            raise RunError("the wheel is driven freely; this set is compared at prescribed slips")
        return float(slip)
    gravity = scene["domain"]["gravity"]
    return math.degrees(math.atan2(-gravity[0], -gravity[2]))


def _quantities(answers, errors):
    scales = {"drawbar_pull": abs(answers["weight"]), "torque": abs(answers["torque"]), "sinkage": abs(answers["sinkage"])}
    found = {}
    for name in QUANTITIES:
        grid = errors.get(STORED_ERRORS[name], math.nan) * scales[name] if name in STORED_ERRORS else math.nan
        found |= {name: answers[name], f"{name}_spread": answers[f"{name}_spread"], f"{name}_grid": grid}
    return found


def _provenance(summary):
    devices = summary.get("devices") or [f"{summary.get('threads')} threads"]
    return {"verdict": resolution_of(summary).verdict, "points": int(summary.get("points") or 0), "wall_s": float(summary.get("wall_s") or math.nan),
            "version": str(summary.get("version")), "commit": str(summary.get("commit")), "device": ", ".join(map(str, devices))}


def find_runs(paths):
    """Run directories at or under the paths, in order of their names."""
    return [file.parent for path in paths for file in sorted(path.rglob("timeseries.h5"))]


def store_rows(path, rows):
    write_rows(path, [{name: f"{value:.6g}" if isinstance(value, float) else value for name, value in asdict(row).items()} for row in rows])


def stored_rows(path):
    return read_rows(path, Row, "validation.py rows")
