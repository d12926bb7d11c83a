"""Surfaces with fewer triangles: a hundred thousand rocks of 5120 triangles each are more than any desk shows."""

from dataclasses import dataclass

import numpy as np

from tread_post.run import Shape

FEWEST = 20  # triangles of the coarsest surface, as of an icosahedron
SMALLEST = 0.5  # of a shape's volume: surfaces that lose more before their scaling are not used
FINER = 2**0.5  # each level has edges so much longer than the one before


@dataclass(frozen=True)
class Level:
    """A surface of a shape at scale 1."""

    surface: Shape
    edge: float  # m, mean length of an edge


def volume_of(shape):
    """Volume (m3) inside a closed surface."""
    corners = shape.vertices[shape.triangles]
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6)


def levels_of(shape):
    """Levels from the true surface to the coarsest, each of the same volume."""
    edge = _edge_of(shape)
    levels, cell, whole = [Level(shape, edge)], edge * FINER, volume_of(shape)
    while cell < np.ptp(shape.vertices, axis=0).max():
        coarse = _clustered(shape, cell)
        share = volume_of(coarse) / whole if len(coarse.triangles) >= FEWEST and whole > 0 else 0.0
        if share < SMALLEST:
            break
        if len(coarse.triangles) < len(levels[-1].surface.triangles):
            scaled = Shape(shape.name, coarse.vertices * share ** (-1 / 3), coarse.triangles)
            levels.append(Level(scaled, _edge_of(scaled)))
        cell *= FINER
    return levels


def choose_levels(levels, bodies, rows, most):
    """Number of the level for each of `rows` of the bodies, so that all have edges of about one length and `most` triangles together, or the
    coarsest where that does not suffice. `levels` has a list of Level for each shape."""
    deepest = max(map(len, levels))
    edges = np.array([[level.edge for level in of_shape] + [np.inf] * (deepest - len(of_shape)) for of_shape in levels])[bodies.shape[rows]]
    edges = edges * bodies.scale[rows, None]
    counts = np.array([[len(level.surface.triangles) for level in of_shape] + [0] * (deepest - len(of_shape)) for of_shape in levels])
    counts = counts[bodies.shape[rows]]
    each = np.arange(len(rows))

    def chosen(edge):
        return np.maximum((edges <= edge).sum(axis=1) - 1, 0)

    def total(edge):
        return int(counts[each, chosen(edge)].sum())

    lengths = np.unique(edges[np.isfinite(edges)])
    short, long = -1, len(lengths) - 1  # the shortest edge that suffices is after `short`, at `long` at the latest
    if len(rows) == 0 or total(0.0) <= most:
        return np.zeros(len(rows), int)
    while long - short > 1:
        middle = (short + long) // 2
        short, long = (short, middle) if total(lengths[middle]) <= most else (middle, long)
    return chosen(lengths[long])


def _edge_of(shape):
    corners = shape.vertices[shape.triangles]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean())


def _clustered(shape, cell):
    """The surface with all vertices of a cubic cell (side in m) at their mean (J. Rossignac and P. Borrel, 1993)."""
    places = np.floor((shape.vertices - shape.vertices.min(axis=0)) / cell).astype(np.int64)
    _, cluster, count = np.unique(places, axis=0, return_inverse=True, return_counts=True)
    cluster = cluster.reshape(-1)
    means = np.stack([np.bincount(cluster, column) / count for column in shape.vertices.T], axis=1)
    triangles = cluster[shape.triangles]
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return Shape(shape.name, means, triangles[proper].astype(np.int32))
