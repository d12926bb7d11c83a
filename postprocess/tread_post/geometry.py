"""Places and turns, for pictures and sections alike."""

import numpy as np


def point_spacing(scene, points):
    """Spacing (m) of neighbouring points at the start: from the scene, or from the volume of the points."""
    spacing = scene.get("grid", {}).get("spacing")
    for terrain in scene.get("terrain", []):
        if "spacing" in terrain:
            return terrain["spacing"]
        if spacing and "points_per_cell" in terrain:
            return spacing / terrain["points_per_cell"] ** (1 / 3)
    return (np.prod(np.ptp(points.position, axis=0)) / len(points.position)) ** (1 / 3)


def point_spacings(scene, points):
    """Spacing (m) of each point to its neighbours at the start, [n]: less where the grid is refined, unless the terrain gives a spacing."""
    spacings = np.full(len(points.position), point_spacing(scene, points))
    grid = scene.get("grid", {})
    if any("spacing" in terrain for terrain in scene.get("terrain", [])):
        return spacings
    start, cell = points.position - points.fields["displacement"], grid.get("spacing")
    for box in grid.get("refine", []):
        low, high = np.floor(np.array(box[0]) / cell) * cell, np.ceil(np.array(box[1]) / cell) * cell
        spacings[((start >= low) & (start <= high)).all(axis=1)] *= 0.5
        cell *= 0.5
    return spacings


def rotated(orientation, vectors):
    """Vectors [n, k, 3] turned by unit quaternions [n, 4], w x y z: v + 2 q x (q x v + w v)."""
    w, q = orientation[:, None, :1], orientation[:, None, 1:]
    return vectors + 2 * np.cross(q, np.cross(q, vectors) + w * vectors)
