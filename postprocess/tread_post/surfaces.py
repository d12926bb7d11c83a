"""Surfaces of bodies where they are, all in one mesh."""

from dataclasses import dataclass

import numpy as np

from tread_post.geometry import rotated


@dataclass(frozen=True)
class Mesh:
    """Triangles in the world."""

    vertices: np.ndarray  # [v, 3] m, single precision
    triangles: np.ndarray  # [t, 3]
    body: np.ndarray  # [t] row of the bodies that a triangle belongs to


def mesh_of(bodies, rows, levels, chosen):
    """Mesh of `rows` of the bodies, each with the surface `levels[shape][chosen]` (tread_post.detail)."""
    vertices, triangles, owners, count = [np.zeros((0, 3), np.float32)], [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int32)], 0
    for shape, level in np.unique(np.stack((bodies.shape[rows], chosen), axis=1), axis=0):
        surface = levels[shape][level].surface
        alike = rows[(bodies.shape[rows] == shape) & (chosen == level)]
        local = surface.vertices * bodies.scale[alike, None, None]
        placed = rotated(bodies.orientation[alike], local) + bodies.position[alike, None]
        first = count + np.arange(len(alike)) * len(surface.vertices)
        vertices.append(placed.reshape(-1, 3).astype(np.float32))
        triangles.append((first[:, None, None] + surface.triangles).reshape(-1, 3))
        owners.append(np.repeat(alike.astype(np.int32), len(surface.triangles)))
        count += len(alike) * len(surface.vertices)
    return Mesh(np.concatenate(vertices), np.concatenate(triangles), np.concatenate(owners))
