#!/usr/bin/env python3
"""Rigorous lower and upper bounds of the load that pushes a rigid tool down into a box of cohesionless Mohr-Coulomb
soil with own weight and associated flow, by finite element limit analysis: axisymmetric (a cone or disc) or plane (a
strip).

Unknown are w times stress (lower bound) and velocity (upper bound), quadratic in each triangle and private to it, as
their six Bezier ordinates; w is the radius, or 1 in plane strain. The yield cone of cohesionless soil and its dual are
convex and homogeneous, so a field is in the cone wherever w times it has all its ordinates there. w times the residual
of equilibrium is linear. Both bounds therefore hold everywhere, to the solver's tolerance.

Inside, lengths are in tool radii, stresses in unit weight x radius; compression is positive, z points up from the level
surface. The tool's shaft is as wide as its base. Tractions on rigid boundaries are free within friction and yield.

Needs numpy, scipy and the conic solver Clarabel (pip install clarabel, in a virtual environment)."""

import argparse
import math
import time
from dataclasses import dataclass

import clarabel
import numpy as np
from scipy import sparse

PAIRS = np.array([(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)])  # vertices of each ordinate
PAIR = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])  # ordinate of two vertices


@dataclass(frozen=True)
class Case:
    """Lengths in tool radii, surcharge in unit weight x radius, angles in radians; weight is 1, or 0 for none."""

    depth: float
    half_angle: float
    box_radius: float
    box_depth: float
    friction: float
    face_mu: float
    shaft_mu: float
    bottom_mu: float
    weight: float
    surcharge: float
    plane: bool

    @property
    def flow_value(self):
        """Greatest ratio of principal stresses."""
        return math.tan(math.pi / 4 + self.friction / 2) ** 2

    @property
    def bodies(self):
        """Rigid boundaries: vertical velocity when the tool's is -1, and friction coefficient, at most the soil's."""
        bodies = {"face": (-1.0, self.face_mu), "shaft": (-1.0, self.shaft_mu), "wall": (0.0, 0.0),
                  "bottom": (0.0, self.bottom_mu)} | ({"axis": (0.0, 0.0)} if self.plane else {})
        return {name: (speed, min(mu, math.tan(self.friction))) for name, (speed, mu) in bodies.items()}


def graded(count, growth):
    """count + 1 numbers from 0 to 1 with gaps that grow about exp(growth)-fold."""
    return np.expm1(growth * np.linspace(0, 1, count + 1)) / np.expm1(growth)


def rays(case, n):
    """Points along the tool from tip to surface, and the arc length along the box's bottom and wall each is joined to.
    n + 1 rays fan out of the edge of the base, where stress and velocity are singular."""
    alpha = case.half_angle
    tip, edge = np.array([0.0, -case.depth - math.cos(alpha) / math.sin(alpha)]), np.array([1.0, -case.depth])
    start = (math.pi + alpha) / 3 - (math.pi / 2 + alpha)  # a third of the way from the face to the shaft
    arcs = np.array([_hit(case, edge, angle) for angle in np.linspace(start, 0, n + 1)])
    points = [tip + (edge - tip) * (1 - graded(n, 1.2)[::-1, None]), np.repeat(edge[None], n, 0)]
    joined = [np.linspace(0, arcs[0], n + 1), arcs[1:]]
    if case.depth > 0:
        step = graded(math.ceil(n * min(2, max(0.4, math.sqrt(case.depth)))), min(1.5, 0.5 * case.depth))[1:]
        points.append(edge + step[:, None] * np.array([0, case.depth]))
        joined.append(arcs[-1] + step * case.depth)
    joined = np.concatenate(joined)
    joined[1 + np.argmin(abs(joined[1:-1] - case.box_radius))] = case.box_radius
    return np.concatenate(points), joined


def _hit(case, origin, angle):
    """Arc length along bottom and wall at which a ray meets them."""
    across = (case.box_radius - origin[0]) / max(math.cos(angle), 1e-9)
    down = (case.box_depth + origin[1]) / max(-math.sin(angle), 1e-9)
    if down < across:
        return origin[0] + down * math.cos(angle)
    return case.box_radius + case.box_depth + origin[1] + across * math.sin(angle)


def triangulate(case, n):
    """Vertices and counterclockwise triangles: quadrilaterals between tool and box, each cut along both diagonals."""
    inner, joined = rays(case, n)
    bottom = np.minimum(joined, case.box_radius)
    outer = np.column_stack([bottom, joined - bottom - case.box_depth])
    t = graded(math.ceil(1.5 * n), math.log(2.5 * case.box_radius))[:, None]
    grid = (1 - t) * inner[:, None] + t * outer[:, None]
    quads = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], 2).reshape(-1, 4, 2)
    fan = np.hypot(*(quads[:, 0] - quads[:, 3]).T) < 1e-9
    whole = quads[~fan]
    cut = [np.stack([whole[:, i], whole[:, (i + 1) % 4], whole.mean(1)], 1) for i in range(4)]
    corners = np.concatenate([quads[fan, :3], *cut])
    points, index = np.unique(np.round(corners.reshape(-1, 2), 9) + 0.0, axis=0, return_inverse=True)
    return points, index.reshape(-1, 3)


class Mesh:
    """Triangles with the gradients of their barycentric coordinates and the weight w at their vertices; inner edges in
    pairs and boundary edges by name, edge 3 t + i joining the vertices i and i + 1 of triangle t."""

    def __init__(self, case, n):
        self.points, self.triangles = triangulate(case, n)
        xy = self.points[self.triangles]
        side = np.roll(xy, -2, 1) - np.roll(xy, -1, 1)  # opposite to each vertex
        self.area = 0.5 * (side[:, 0, 0] * side[:, 1, 1] - side[:, 0, 1] * side[:, 1, 0])
        if self.area.min() <= 0:
            raise ValueError("a triangle is turned over")
        self.gradient = np.stack([-side[..., 1], side[..., 0]], -1) / (2 * self.area[:, None, None])
        self.weight = np.ones(self.triangles.shape) if case.plane else xy[..., 0]
        ends = np.stack([self.triangles, np.roll(self.triangles, -1, 1)], -1).reshape(-1, 2)
        along = self.points[ends[:, 1]] - self.points[ends[:, 0]]
        self.length = np.hypot(*along.T)
        self.tangent = along / self.length[:, None]
        self.normal = np.column_stack([self.tangent[:, 1], -self.tangent[:, 0]])
        order = np.lexsort(np.sort(ends, 1).T)
        twin = np.flatnonzero((np.diff(np.sort(ends, 1)[order], axis=0) == 0).all(1))
        self.inner = order[twin], order[twin + 1]
        alone = np.setdiff1d(np.arange(len(ends)), np.concatenate(self.inner))
        names = np.array([self._name(case, *self.points[ends[edge]].mean(0)) for edge in alone])
        self.boundary = {name: alone[names == name] for name in ("axis", "wall", "bottom", "surface", "shaft", "face")}
        self.open = np.isin(self.triangles, ends[self.boundary["surface"]])

    @staticmethod
    def _name(case, x, z):
        tests = {"axis": x < 1e-6, "wall": x > case.box_radius - 1e-6, "bottom": z < 1e-6 - case.box_depth,
                 "surface": z > -1e-6 and x > 1, "shaft": x < 1 + 1e-6 and z > -case.depth}
        return next((name for name, true in tests.items() if true), "face")

    @staticmethod
    def on_edges(edges, flip=False):
        """Triangle and three ordinates of each edge, from its first end to its second, or back."""
        i = edges % 3
        j = (i + 1) % 3
        return edges[:, None] // 3, np.column_stack([j, PAIR[i, j], i] if flip else [i, PAIR[i, j], j])

    def area_moments(self):
        """Integrals of w times the polynomial of each ordinate over each triangle."""
        total = self.weight.sum(1, keepdims=True)
        corner, middle = 2 * self.weight + total, self.weight[:, PAIRS[3:]].sum(-1) + total
        return self.area[:, None] * np.column_stack([corner, middle]) / 30

    def edge_moments(self, edges):
        """Integrals of w times the polynomial of each ordinate along each edge."""
        first, last = self.weight.ravel()[edges], self.weight[edges // 3, (edges + 1) % 3]
        return self.length[edges, None] * np.column_stack([3 * first + last, 2 * (first + last), first + 3 * last]) / 12


def scaled(terms, factor):
    """A linear expression times a factor; an expression is a list of (columns, coefficients)."""
    return [(columns, factor * values) for columns, values in terms]


def stacked(*parts):
    """Expressions as the components, along a new last axis, of one vector of them."""
    return [(columns[..., None], np.asarray(values)[..., None] * (np.arange(len(parts)) == k))
            for k, part in enumerate(parts) for columns, values in part]


class Program:
    """Minimise cost x with rows of A x = b, A x >= b, and A x in second-order cones, each of three rows."""

    def __init__(self, size):
        self.cost, self.keep = np.zeros(size), np.ones(size, bool)
        self.blocks = {"equal": [], "above": [], "cone": []}

    def add(self, kind, terms, rhs=0.0):
        """One row for each entry of the terms' and right hand side's common shape."""
        shape = np.broadcast_shapes(np.shape(rhs), *(np.broadcast_shapes(np.shape(c), np.shape(v)) for c, v in terms))
        row = np.arange(math.prod(shape)).reshape(shape)
        entries = [[np.broadcast_to(x, shape).ravel() for x in (row, columns, values)] for columns, values in terms]
        rows, columns, values = (np.concatenate(x) for x in zip(*entries))
        matrix = sparse.csr_matrix((values, (rows, columns)), (row.size, self.cost.size))
        self.blocks[kind].append((matrix, np.broadcast_to(rhs, shape).ravel()))

    def solve(self):
        """Least cost and how it was met, with unknowns not kept at 0 and empty rows left out."""
        matrices, limits, cones = [], [], []
        for kind, blocks in self.blocks.items():
            matrix = sparse.vstack([block for block, _ in blocks]).tocsr()[:, self.keep]
            matrix.eliminate_zeros()
            used = np.diff(matrix.indptr) > 0
            if kind == "cone":
                used = np.repeat(used.reshape(-1, 3).any(1), 3)
                cones += [clarabel.SecondOrderConeT(3)] * (used.sum() // 3)
            else:
                cones.append((clarabel.ZeroConeT if kind == "equal" else clarabel.NonnegativeConeT)(int(used.sum())))
            matrices.append(matrix[used])
            limits.append(np.concatenate([rhs for _, rhs in blocks])[used])
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.static_regularization_constant = 1e-7  # some rows of equilibrium depend on others
        settings.iterative_refinement_max_iter, settings.iterative_refinement_stop_ratio = 50, 1.5
        size = int(self.keep.sum())
        solution = clarabel.DefaultSolver(sparse.csc_matrix((size, size)), self.cost[self.keep],
                                          -sparse.vstack(matrices).tocsc(), -np.concatenate(limits), cones,
                                          settings).solve()
        return solution.obj_val, f"{solution.status} with residual {solution.r_prim:.0e}"


def slope(mesh, columns, direction):
    """Expression of the derivative of a quadratic field at the vertices; columns (triangles, 6) hold its ordinates."""
    return [(columns[:, PAIR[k]], np.tile(2 * mesh.gradient[:, k, direction, None], 3)) for k in range(3)]


def weighted(mesh, terms):
    """Expression of the ordinates of w times a linear field, from one of its values at the vertices."""
    i, j = PAIRS.T
    return [(columns[:, a], values[:, a] * mesh.weight[:, b] / 2) for columns, values in terms
            for a, b in ((i, j), (j, i))]


def lower_bound(case, mesh):
    """Greatest vertical force on the tool, over 2 pi or of half a strip, of stress in equilibrium and within yield.
    Unknowns: w times radial, vertical and shear stress; a bound on w times the greatest shear stress; hoop stress."""
    count = len(mesh.triangles)
    program = Program(27 * count)
    radial, vertical, shear, bound = np.arange(24 * count).reshape(4, count, 6)
    hoop = 24 * count + np.arange(3 * count).reshape(count, 3)
    ring = [] if case.plane else [(hoop, np.ones(hoop.shape))]
    program.add("equal", slope(mesh, radial, 0) + slope(mesh, shear, 1) + scaled(ring, -1))
    program.add("equal", slope(mesh, shear, 0) + slope(mesh, vertical, 1), -case.weight * mesh.weight)

    def traction(edges, direction, flip=False):
        """Along a direction, on the side of each edge's triangle."""
        at = mesh.on_edges(edges, flip)
        (nr, nz), (dr, dz) = mesh.normal[edges].T[:, :, None], direction.T[:, :, None]
        return [(radial[at], nr * dr), (vertical[at], nz * dz), (shear[at], nr * dz + nz * dr)]

    here, there = mesh.inner
    for direction in (mesh.normal[here], mesh.tangent[here]):
        program.add("equal", traction(here, direction) + traction(there, direction, flip=True))
    for name, (speed, mu) in case.bodies.items():
        edges = mesh.boundary[name]
        normal, along = (traction(edges, direction[edges]) for direction in (mesh.normal, mesh.tangent))
        if mu == 0:
            program.add("equal", along)
        else:
            program.add("above", scaled(normal, mu) + along)
            program.add("above", scaled(normal, mu) + scaled(along, -1))
        for columns, values in traction(edges, np.tile([0.0, 1.0], (len(edges), 1))):
            np.add.at(program.cost, columns, speed * values * mesh.length[edges, None] / 3)
    if case.surcharge > 0:
        edges = mesh.boundary["surface"]
        w = mesh.weight.ravel()[edges], mesh.weight[edges // 3, (edges + 1) % 3]
        program.add("equal", traction(edges, mesh.tangent[edges]))
        program.add("equal", traction(edges, mesh.normal[edges]),
                    case.surcharge * np.column_stack([w[0], (w[0] + w[1]) / 2, w[1]]))

    kp, total = case.flow_value, [(radial, 0.5), (vertical, 0.5)]
    ring = weighted(mesh, ring)
    program.add("above", scaled(total, kp - 1) + [(bound, -kp - 1)])
    if not case.plane:
        program.add("above", scaled(ring, kp) + scaled(total, -1) + [(bound, -1)])
        program.add("above", scaled(total, kp) + scaled(ring, -1) + [(bound, -kp)])
    program.add("cone", stacked([(bound, 1)], [(radial, 0.5), (vertical, -0.5)], [(shear, 1)]))

    free = mesh.open & (case.surcharge == 0)  # there stress is zero to be within yield
    zero = free[:, PAIRS].all(-1) | (mesh.weight[:, PAIRS] == 0).all(-1)
    program.keep[np.concatenate([x[zero] for x in (radial, vertical, shear, bound)])] = False
    program.keep[hoop[free | case.plane]] = False
    cost, status = program.solve()
    return -cost, status


def upper_bound(case, mesh):
    """Least force on the tool, over 2 pi or of half a strip, that balances the power of weight and surcharge in a
    velocity field that obeys the flow rule, with jumps across edges; soil and interfaces dissipate nothing.
    Unknowns: radial and vertical velocity; multipliers of the three linear conditions of yield."""
    count = len(mesh.triangles)
    program = Program(30 * count)
    radial, vertical, *factors = np.arange(30 * count).reshape(5, count, 6)
    stretch, sink = (weighted(mesh, slope(mesh, columns, d)) for d, columns in enumerate((radial, vertical)))
    shear = weighted(mesh, slope(mesh, radial, 1) + slope(mesh, vertical, 0))
    kp, use = case.flow_value, 1 if case.plane else 3
    for columns in factors[:use]:
        program.add("above", [(columns, 1)])
    program.add("equal", stretch + sink + list(zip(factors, (1 - kp, 1, -kp)))[:use])
    if not case.plane:
        program.add("equal", [(radial, 1), (factors[1], -kp), (factors[2], 1)])
    program.add("cone", stacked(list(zip(factors, (kp + 1, 1, kp)))[:use], stretch + scaled(sink, -1), shear))

    def speed_along(edges, direction, flip=False):
        at = mesh.on_edges(edges, flip)
        return [(radial[at], direction[:, :1]), (vertical[at], direction[:, 1:])]

    def opening(edges, mu):
        """Directions in which a body that parts from the edges' triangles along the flow rule has no negative speed."""
        return [mesh.normal[edges] + slip * mesh.tangent[edges] for slip in ((mu, -mu) if mu > 0 else (0,))]

    here, there = mesh.inner
    for direction in opening(here, math.tan(case.friction)):
        program.add("above", speed_along(there, direction, flip=True) + speed_along(here, -direction))
    for name, (speed, mu) in case.bodies.items():
        for direction in opening(mesh.boundary[name], mu):
            program.add("above", speed_along(mesh.boundary[name], -direction), np.tile(-speed * direction[:, 1:], 3))
    program.cost[vertical] = case.weight * mesh.area_moments()
    surface = mesh.boundary["surface"]
    np.add.at(program.cost, vertical[mesh.on_edges(surface)], case.surcharge * mesh.edge_moments(surface))

    zero = (mesh.weight[:, PAIRS] == 0).all(-1)
    program.keep[radial[zero]] = False
    for k, columns in enumerate(factors):
        program.keep[columns[zero | (k >= use)]] = False
    return program.solve()


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    for name, default, text in (
            ("depth", 0.0, "of the base below the surface, m"), ("radius", 0.010135, "of the base, or half width, m"),
            ("half-angle-deg", 15.0, "of the cone; 90 is a disc or strip"), ("friction-angle-deg", 30.0, "of the soil"),
            ("interface-friction", 0.3, "coefficient at the face; inf is rough"),
            ("shaft-friction", 0.0, "coefficient at the shaft"),
            ("bottom-friction", math.inf, "coefficient at the bottom"),
            ("radius-of-box", 0.08, "m, smooth wall"), ("depth-of-box", 0.2, "m"), ("density", 1600.0, "kg/m3"),
            ("gravity", 9.81, "m/s2"), ("surcharge", 0.0, "on the surface, Pa")):
        parser.add_argument("--" + name, type=float, default=default, help=f"{text} (default {default})")
    parser.add_argument("--plane", action="store_true", help="a strip in plane strain")
    parser.add_argument("--mesh", type=int, default=8, help="triangle pairs along the face")
    parser.add_argument("--bound", choices=("lower", "upper", "both"), default="both")
    return parser.parse_args()


def main():
    """Print mean pressure on the base, Pa: vertical force over base area."""
    given = arguments()
    weight, radius = given.density * given.gravity, given.radius
    unit = (weight or 1.0) * radius
    case = Case(given.depth / radius, math.radians(given.half_angle_deg), given.radius_of_box / radius,
                given.depth_of_box / radius, math.radians(given.friction_angle_deg), given.interface_friction,
                given.shaft_friction, given.bottom_friction, float(weight > 0), given.surcharge / unit, given.plane)
    mesh = Mesh(case, given.mesh)
    for name, bound in (("lower", lower_bound), ("upper", upper_bound)):
        if given.bound in (name, "both"):
            start = time.perf_counter()
            force, status = bound(case, mesh)
            pressure = unit * force * (1 if case.plane else 2)
            print(f"{name} bound {pressure:.6g} Pa, {len(mesh.triangles)} triangles, {status}, "
                  f"{time.perf_counter() - start:.1f} s", flush=True)


if __name__ == "__main__":
    main()
