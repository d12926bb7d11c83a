"""Curves of soil tests, read from runs of scenes whose [reference] form names the test: docs/soil_tests.md. SI units; compression is positive."""

import math
from dataclasses import dataclass, field

import numpy as np

from tread_post.run import RunError


@dataclass(frozen=True)
class Curve:
    """Columns of a test by name, each [rows], and the unit of each; `width` is b of a plate or the base's diameter of a cone."""

    test: str
    name: str
    columns: dict[str, np.ndarray]
    units: dict[str, str]
    width: float = math.nan  # m
    facts: dict[str, float] = field(default_factory=dict)

    def __getitem__(self, name):
        return self.columns[name]

    def plateau(self, name):
        """Mean over the last quarter of the rows."""
        values = self[name]
        return float(np.nanmean(values[3 * len(values) // 4:]))

    def peak(self, name):
        """Largest mean of a twentieth of the rows in turn."""
        values = self[name]
        size = max(1, len(values) // 20)
        return float(np.nanmax(np.convolve(values, np.ones(size) / size, "valid")))


def curves_of(run):
    """The curves of a run, one for each plate, else one. RunError if its scene names no soil test, or lacks one of its parts."""
    test = run.scene.get("reference", {}).get("form", "none")
    if test not in READERS:
        raise RunError(f"{run.path}: [reference] form = \"{test}\" is no soil test; these are: {', '.join(READERS)}")
    return READERS[test](run)


def _of_last_phase(run, name):
    """Rows of a body within the last phase whose whole span lies in it."""
    series, start = run.wheel(name), run.phases[-1].start
    rows = np.flatnonzero(series["time"] > start + 1e-9)[1:]
    if len(rows) < 8:
        raise RunError(f"{run.path}: {len(rows)} rows of '{name}' in its last phase; 8 at least: lower [output] every")
    first = max(rows[0] - 1, 0)
    return {column: values[rows] for column, values in series.columns.items()}, {column: values[first] for column, values in series.columns.items()}


def _body(run, name=None):
    """The first [[body]], or the one of that name."""
    bodies = run.scene.get("body", [])
    found = [body for body in bodies if name in (None, body["name"])]
    if not found:
        raise RunError(f"{run.path}: the test wants a [[body]]" + (f" named '{name}'" if name else ""))
    return found[0]


def _generator(run, body):
    """The generator's keys of a body's shape."""
    shapes = [shape for shape in run.scene.get("shape", []) if shape["name"] == body["shape"]]
    if not shapes or "generate" not in shapes[0]:
        raise RunError(f"{run.path}: the shape of '{body['name']}' has no `generate`, which gives its area")
    return shapes[0]["generate"]


def sample_of(run):
    """(low, high) corners of the sand, m; of grains between plates, when the last phase begins."""
    if "terrain" not in run.scene and "rocks" in run.scene:
        return _between_plates(run)
    terrain = run.scene.get("terrain", [{}])
    if "box" not in terrain[0].get("region", {}):
        raise RunError(f"{run.path}: the test wants a first [[terrain]] with region = {{ box = ... }}")
    return tuple(np.array(corner, float) for corner in terrain[0]["region"]["box"])


def _between_plates(run):
    """(low, high) corners of what the first body, "side_x" and "side_y" hold against the domain's corner, m."""
    low, high = np.zeros(3), np.array(run.scene["domain"]["size"], float)
    for axis, name in ((2, _body(run)["name"]), (0, "side_x"), (1, "side_y")):
        for body in (body for body in run.scene["body"] if body["name"] == name):
            shape = _generator(run, body)
            if shape["kind"] != "box":
                raise RunError(f"{run.path}: the shape of '{name}' is a {shape['kind']}, not a box, whose face bounds the sample")
            high[axis] = _of_last_phase(run, name)[1]["position"][axis] - 0.5 * shape["size"][axis]
    return low, high


def soil_of(run):
    """The [[material]] of the sand."""
    name = run.scene["terrain"][0]["material"]
    return next(material for material in run.scene["material"] if material["name"] == name)


# A plate's edges end a little before the walls of a slab, which it must not touch; the slab's whole thickness carries it.
_IS_STRIP = 0.9


def _plate_sizes(run, shape):
    """(area in m2, b in m, whether it is a strip) of a plate."""
    if shape["kind"] == "plate" and "radius" in shape:
        return math.pi * shape["radius"] ** 2, shape["radius"], False
    if shape["kind"] not in ("plate", "box"):
        raise RunError(f"{run.path}: a shape of kind \"{shape['kind']}\" is no plate; \"plate\" and \"box\" are")
    along, thickness = shape["size"][:2], run.scene["domain"]["size"][1]
    if along[1] > _IS_STRIP * thickness:
        return along[0] * thickness, along[0], True
    return along[0] * along[1], min(along), False


def _plates(run):
    curves = []
    for body in run.scene.get("body", []):
        area, width, is_strip = _plate_sizes(run, _generator(run, body))
        rows, _ = _of_last_phase(run, body["name"])
        curves.append(Curve("plate-sinkage", body["name"], {"sinkage": rows["sinkage"], "pressure": rows["force"][:, 2] / area},
                            {"sinkage": "m", "pressure": "Pa"}, width, {"strip": float(is_strip)}))
    if not curves:
        raise RunError(f"{run.path}: the test wants a [[body]] for each plate")
    return curves


def _cone(run):
    body = _body(run)
    shape = _generator(run, body)
    if shape["kind"] != "cone":
        raise RunError(f"{run.path}: the first body's shape is a {shape['kind']}, not a cone")
    radius, rows = shape["base_radius"], _of_last_phase(run, body["name"])[0]
    height = radius / math.tan(0.5 * math.radians(shape.get("apex_angle_deg", 30.0)))
    columns = {"depth": rows["sinkage"] - height, "cone_index": rows["force"][:, 2] / (math.pi * radius**2)}
    return [Curve("cone-penetration", body["name"], columns, {"depth": "m", "cone_index": "Pa"}, 2 * radius)]


def _direct_shear(run):
    """Forces on the upper half and the lid together: what they exert on each other cancels, and the rest acts on the plane of shear."""
    upper, lid = _body(run), _body(run, "lid")
    low, high = sample_of(run)
    area = float(np.prod((high - low)[:2]))
    (rows, first), (lid_rows, lid_first) = _of_last_phase(run, upper["name"]), _of_last_phase(run, lid["name"])
    forces = rows["force"] + lid_rows["force"]
    columns = {"displacement": rows["position"][:, 0] - first["position"][0], "rise": lid_rows["position"][:, 2] - lid_first["position"][2],
               "normal_stress": forces[:, 2] / area, "shear_stress": -forces[:, 0] / area}
    columns["stress_ratio"] = columns["shear_stress"] / columns["normal_stress"]
    return [Curve("direct-shear", upper["name"], columns,
                  {"displacement": "m", "rise": "m", "normal_stress": "Pa", "shear_stress": "Pa", "stress_ratio": "1"})]


def _ring_shear(run):
    body = _body(run)
    shape = _generator(run, body)
    if shape["kind"] != "ring":
        raise RunError(f"{run.path}: the first body's shape is a {shape['kind']}, not a ring")
    inner, outer, rows = shape["inner_radius"], shape["outer_radius"], _of_last_phase(run, body["name"])[0]
    cubes, squares = outer**3 - inner**3, outer**2 - inner**2
    time, spin = rows["time"], np.abs(rows["angular_velocity"][:, 2])
    turn = np.concatenate(([0.0], np.cumsum(0.5 * (spin[1:] + spin[:-1]) * np.diff(time))))
    columns = {"displacement": turn * 2 / 3 * cubes / squares, "normal_stress": rows["force"][:, 2] / (math.pi * squares),
               "shear_stress": 3 * np.abs(rows["torque"][:, 2]) / (2 * math.pi * cubes), "sinkage": rows["sinkage"]}
    columns["stress_ratio"] = columns["shear_stress"] / columns["normal_stress"]
    return [Curve("ring-shear", body["name"], columns,
                  {"displacement": "m", "normal_stress": "Pa", "shear_stress": "Pa", "sinkage": "m", "stress_ratio": "1"})]


def _triaxial(run):
    """An eighth of the sample, from the domain's corner on; the first body is the top, "side_x" and "side_y" are the plates that confine it. Without
    "side_y" the strain along y is 0. Areas are those of the sample as it is now."""
    top = _body(run)
    sides = {axis: body["name"] for axis, name in ((0, "side_x"), (1, "side_y")) for body in run.scene["body"] if body["name"] == name}
    if 0 not in sides:
        raise RunError(f"{run.path}: the test wants a [[body]] named 'side_x'")
    low, high = sample_of(run)
    size, (rows, first) = high - low, _of_last_phase(run, top["name"])
    strain = {2: (first["position"][2] - rows["position"][:, 2]) / size[2], 1: np.zeros(len(rows["time"]))}
    stress = {}
    plates = {axis: _of_last_phase(run, name) for axis, name in sides.items()}
    for axis, (plate, plate_first) in plates.items():
        strain[axis] = (plate_first["position"][axis] - plate["position"][:, axis]) / size[axis]
    edges = {axis: size[axis] * (1 - strain[axis]) for axis in range(3)}
    stress[2] = rows["force"][:, 2] / (edges[0] * edges[1])
    for axis, (plate, _) in plates.items():
        stress[axis] = plate["force"][:, axis] / (edges[2] * edges[1 - axis])
    confining = np.mean([stress[axis] for axis in plates], axis=0)
    columns = {"axial_strain": strain[2], "volume_strain": strain[0] + strain[1] + strain[2], "confining_stress": confining,
               "deviator": stress[2] - confining, "stress_ratio": stress[2] / confining}
    units = {"axial_strain": "1", "volume_strain": "1", "confining_stress": "Pa", "deviator": "Pa", "stress_ratio": "1"}
    return [Curve("triaxial", top["name"], columns | _inner_columns(run, rows["time"]), units | INNER_UNITS)]


def _oedometer(run):
    lid = _body(run)
    low, high = sample_of(run)
    size, (rows, first) = high - low, _of_last_phase(run, lid["name"])
    columns = {"strain": (first["position"][2] - rows["position"][:, 2]) / size[2], "stress": rows["force"][:, 2] / (size[0] * size[1])}
    return [Curve("oedometer", lid["name"], columns | _inner_columns(run, rows["time"]), {"strain": "1", "stress": "Pa"} | INNER_UNITS)]


INNER_UNITS = {"inner_axial_strain": "1", "inner_volume_strain": "1", "inner_axial_stress": "Pa", "inner_lateral_stress": "Pa"}


def _inner_columns(run, times):
    """Strains and mean stresses of the sample's inner half, from snapshots, interpolated to `times` [n]; none without snapshots of the last phase. Strains
    count from the first of these, and leave out what contacts with the plates yield, as gauges on a sample do. The lateral stress is along x."""
    start, found = run.phases[-1].start, []
    first = None
    for snapshot, time in sorted(run.points_times.items(), key=lambda item: item[1]):
        if time < start - 1e-9:
            continue
        points = run.points(snapshot)
        order = np.argsort(points.fields["id"])
        place, stress = points.position[order], points.fields["stress"][order]
        if first is None:
            first, inside = place, _inner_half(run, place)
        strains = [-np.polyfit(first[inside, axis], (place - first)[inside, axis], 1)[0] if np.ptp(first[inside, axis]) > 0 else 0.0
                   for axis in range(3)]
        mean = -stress[inside].mean(axis=0)
        found.append((time, strains[2], sum(strains), mean[2], mean[0]))
    if len(found) < 3:
        return {name: np.full(len(times), math.nan) for name in INNER_UNITS}
    time, *values = np.array(found).T
    return {name: np.interp(times, time, column) for name, column in zip(INNER_UNITS, values)}


def _inner_half(run, place):
    """Which places [n] lie in the middle half of the sample along each axis; of a slab, along x and z."""
    low, high = sample_of(run)
    size = high - low
    axes = [axis for axis in range(3) if size[axis] >= 0.5 * min(size[0], size[2])]
    inside = np.all((np.abs(place - 0.5 * (low + high)) <= 0.25 * size)[:, axes], axis=1)
    if inside.sum() < 8:
        raise RunError(f"{run.path}: {inside.sum()} points in the inner half of the sample; 8 at least")
    return inside


def _surface(run):
    """(x [n], height [n]) of the sand in the last snapshot: the highest point in each cell of the grid along x, and half a point's distance."""
    if not run.points_times:
        raise RunError(f"{run.path}: a snapshot of the sand is needed")
    points = run.points(max(run.points_times))
    cell = run.scene["grid"]["spacing"]
    column = np.floor(points.position[:, 0] / cell).astype(int)
    columns = np.unique(column)
    half = 0.25 * cell
    return (columns + 0.5) * cell, np.array([points.position[column == number, 2].max() + half for number in columns])


def _heap(run):
    x, height = _surface(run)
    top = height.max()
    slope = np.flatnonzero((height > 0.2 * top) & (height < 0.8 * top) & (x > x[np.argmax(height)]))
    if len(slope) < 3:
        raise RunError(f"{run.path}: {len(slope)} cells of a slope between 0.2 and 0.8 of its height; 3 at least")
    angle = math.degrees(math.atan(-np.polyfit(x[slope], height[slope], 1)[0]))
    return [Curve("repose", "heap", {"x": x, "height": height}, {"x": "m", "height": "m"}, facts={"angle_deg": angle})]


def _collapse(run):
    x, height = _surface(run)
    width = run.scene["terrain"][0]["region"]["box"][1][0]
    end = float(np.quantile(run.points(max(run.points_times)).position[:, 0], 0.99))
    return [Curve("run-out", "column", {"x": x, "height": height}, {"x": "m", "height": "m"}, width, {"run_out": end / width - 1})]


READERS = {"plate-sinkage": _plates, "cone-penetration": _cone, "direct-shear": _direct_shear, "ring-shear": _ring_shear, "triaxial": _triaxial,
           "oedometer": _oedometer, "repose": _heap, "run-out": _collapse}
