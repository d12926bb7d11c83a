"""What the ladder's problems are and what their scenes need at each spacing. Standard library only: this runs where GPUs are."""

import json
import math
from dataclasses import dataclass
from pathlib import Path

SCENES = Path(__file__).resolve().parents[2] / "configs" / "ladder"

# tread refuses drums narrower than a twentieth of their radius.
NARROWEST = 1 / 20
FILL = 0.98  # width of a drum over that of the slab


@dataclass(frozen=True)
class Problem:
    """A scene in configs/ladder and its sizes. `counts` are cells across `length`; the scene's file has the first."""

    name: str
    length: float  # m, radius or width of what touches the soil
    extent: tuple  # m, x and z of the domain
    depth: float  # m, of the soil
    body: str
    x: float  # m, of the body's centre
    load: float = 0.0  # N a metre of width; 0: the body is pushed at a given speed
    counts: tuple = (12, 20, 34, 50)

    @property
    def scene(self):
        return SCENES / f"{self.name}.toml"


def _drum(name, load, depth=0.24):
    return Problem(name, 0.24, (1.2, 0.72), depth, "drum", 0.3, load)


def layers_of(problem, spacing):
    """Cells across the slab: two, or as many as the drum needs."""
    return 2 if problem.body == "plate" else max(2, math.ceil(NARROWEST * problem.length / (FILL * spacing)))


# Edges of the plate lie on nodes at all its counts, as its error is one of the edge.
PROBLEMS = {problem.name: problem for problem in (
    Problem("plate_clay", 0.1, (0.2, 0.2), 0.1, "plate", 0.025, counts=(10, 20, 32, 50)),
    Problem("cylinder_clay", 0.24, (1.2, 0.84), 0.24, "cylinder", 0.6),
    _drum("drum_clay_smooth", 2500.0), _drum("drum_clay_rough", 5000.0), _drum("drum_elastic", 100.0, 0.12),
    _drum("drum_sand", 5000.0), _drum("drum_sand_associated", 5000.0),
)}


def settings_of(problem, count, mesh=None):
    """KEY=VALUE settings of a problem with `count` cells across its length; `mesh`: the plate's file."""
    h = problem.length / count
    across, (long, high) = layers_of(problem, h) * h, problem.extent
    values = {
        "grid.spacing": h,
        "domain.size": [long, across, high],
        "terrain[0].region.box": [[0.0, 0.0, 0.0], [long, across, problem.depth]],
        f"body.{problem.body}.position": [problem.x, 0.5 * across, "on surface"],
    }
    if problem.load > 0:
        values[f"body.{problem.body}.load"] = problem.load * across
    if problem.body == "plate":
        values["shape.block.file"] = str(mesh)
    else:
        values["shape.drum.generate.width"] = FILL * across
    return [f"{key}={json.dumps(_rounded(value))}" for key, value in values.items()]


def _rounded(value):
    if isinstance(value, list):
        return [_rounded(one) for one in value]
    return round(value, 12) if isinstance(value, float) else value


def plate_mesh(problem, count):
    """OBJ of half the plate, a twentieth of a cell off the walls that it must not meet, four cells high."""
    h = problem.length / count
    x, y, z = 0.25 * problem.length - 0.025 * h, 0.475 * layers_of(problem, h) * h, 2 * h
    corners = [(-x, -y, -z), (x, -y, -z), (x, y, -z), (-x, y, -z), (-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z)]
    faces = ((1, 4, 3), (1, 3, 2), (5, 6, 7), (5, 7, 8), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 4, 8), (3, 8, 7), (4, 1, 5), (4, 5, 8))
    lines = ["v " + " ".join(f"{value:.9g}" for value in corner) for corner in corners] + ["f {} {} {}".format(*face) for face in faces]
    return "\n".join(["# Half of the plate of plate_clay.toml.", *lines]) + "\n"
