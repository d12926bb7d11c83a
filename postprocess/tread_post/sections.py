"""Where a plane cuts bodies."""

import numpy as np

from tread_post.geometry import rotated


def outline_of(bodies, shapes, axis, at):
    """Segments [n, 2, 3], m, in which the plane `axis` = `at` (m) cuts the surfaces of all bodies."""
    reach = np.array([np.linalg.norm(shape.vertices, axis=1).max() for shape in shapes])
    near = np.abs(bodies.position[:, axis] - at) <= reach[bodies.shape] * bodies.scale
    parts = [_cut(_corners(bodies, shapes[bodies.shape[index]], index), axis, at) for index in np.flatnonzero(near)]
    return np.concatenate([np.zeros((0, 2, 3)), *parts])


def _corners(bodies, shape, index):
    """Corners of the triangles of one body in the world: [t, 3, 3]."""
    vertices = rotated(bodies.orientation[index:index + 1], (bodies.scale[index] * shape.vertices)[None])[0] + bodies.position[index]
    return vertices[shape.triangles]


def _cut(corners, axis, at):
    """Segments of the triangles that have corners on both sides."""
    height = corners[:, :, axis] - at
    above = height > 0
    cut = above.any(axis=1) & ~above.all(axis=1)
    corners, height, above = corners[cut], height[cut], above[cut]
    # The corner that is alone on its side: both edges of the cut start there.
    alone = np.where(above.sum(axis=1) == 1, np.argmax(above, axis=1), np.argmin(above, axis=1))
    rows = np.arange(len(corners))
    ends = []
    for step in (1, 2):
        other = (alone + step) % 3
        share = height[rows, alone] / (height[rows, alone] - height[rows, other])
        ends.append(corners[rows, alone] + share[:, None] * (corners[rows, other] - corners[rows, alone]))
    return np.stack(ends, axis=1)
