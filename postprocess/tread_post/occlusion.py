"""Which of many small bodies can be seen: of 300,000 scattered rocks nine tenths stand behind others."""

import numpy as np

CELLS = 6  # across a body, of the map in which bodies hide each other
SHARE = 0.95  # of a body's radius, within which nothing is seen past it


def seen_rows(places, depths, radius):
    """Rows of the bodies of which something is seen. `places` [n, 2] across and up and `radius` in one unit; depths [n] grow away from the eye."""
    if not len(places):
        return np.zeros(0, int)
    cell = 2 * radius / CELLS
    middle = ((places - places.min(axis=0)) / cell).astype(np.int64) + CELLS
    size = middle.max(axis=0) + CELLS + 1
    rank = np.empty(len(depths), np.int64)
    rank[np.argsort(depths, kind="stable")] = np.arange(len(depths))  # 0 is nearest
    nearest = np.full(size[0] * size[1], len(depths), np.int64)
    reach = int(0.5 * CELLS * SHARE)
    for across, up in np.ndindex(2 * reach + 1, 2 * reach + 1):
        off = np.array((across, up)) - reach
        if np.hypot(*off) <= 0.5 * CELLS * SHARE:
            np.minimum.at(nearest, (middle[:, 0] + off[0]) * size[1] + middle[:, 1] + off[1], rank)
    found = np.unique(nearest)
    return np.argsort(rank)[found[found < len(depths)]]
