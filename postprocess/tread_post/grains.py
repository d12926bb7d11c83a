"""Spheres of a snapshot: void ratio and overlaps. Lengths in metres."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from tread_post.run import RunError

# Spheres whose centres are nearest to a place; one that holds it is among them unless sizes differ by far more than a factor of two.
_NEAREST = 12
# An additive recurrence fills a box evenly: powers of 1/g with g^4 = g + 1.
_PLACES, _STEPS = 200_000, 1.2207440846057596 ** -np.arange(1.0, 4.0)


@dataclass(frozen=True)
class Grains:
    centre: np.ndarray  # [n, 3]
    radius: np.ndarray  # [n]

    @property
    def diameter(self):
        """Mean diameter."""
        return 2 * float(self.radius.mean())


def grains_of(run, snapshot):
    """Grains of a snapshot of a scene whose [[rocks]] are spheres; named bodies are left out."""
    names = {rocks["shape"] for rocks in run.scene.get("rocks", [])}
    kinds = {shape.get("generate", {}).get("kind") for shape in run.scene.get("shape", []) if shape["name"] in names}
    if kinds != {"sphere"}:
        raise RunError(f"{run.path}: its [[rocks]] are no spheres; the void ratio is that of spheres")
    bodies, named = run.bodies(snapshot), len(run.scene.get("body", []))
    return Grains(bodies.position[named:], 0.5 * bodies.scale[named:])


def void_ratio(grains, low, high):
    """Volume of voids over that of grains in the box from `low` to `high`, by places of even spread: 0.003 of a ratio of 0.6 is what random ones leave."""
    if np.any(high - low < grains.diameter):
        raise RunError(f"a box of {high - low} m is too small for the void ratio of grains of {grains.diameter:g} m")
    places = low + (high - low) * np.mod(np.arange(1, _PLACES + 1)[:, None] * _STEPS, 1.0)
    distance, index = cKDTree(grains.centre).query(places, min(_NEAREST, len(grains.radius)))
    filled = int(np.any(distance < grains.radius[index], axis=1).sum())
    if not filled:
        raise RunError(f"no grain lies between {low} and {high} m")
    return (_PLACES - filled) / filled


def overlaps(grains):
    """Overlaps [contacts] of touching grains over the mean diameter."""
    pairs = cKDTree(grains.centre).query_pairs(2 * grains.radius.max(), output_type="ndarray")
    apart = np.linalg.norm(grains.centre[pairs[:, 0]] - grains.centre[pairs[:, 1]], axis=1)
    depth = grains.radius[pairs].sum(axis=1) - apart
    return depth[depth > 0] / grains.diameter
