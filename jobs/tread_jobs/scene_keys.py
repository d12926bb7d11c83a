"""Keys of a scene as `tread run --set` takes them: phase.drive.drive.slip, material.sand.young, terrain[0].spacing."""

import copy
import re
from pathlib import Path

from tread_jobs.errors import CampaignError

PART = re.compile(r"([A-Za-z0-9_-]+)((?:\[\d+\])*)")
# Strings that are paths; relative ones start at the scene file.
PATH_KEYS = ("file", "from")


def canonical(scene, key):
    """Where `key` leads in this scene: names of arrays of tables become indices, so that two spellings of one place are equal."""
    place, node = [], scene
    parts = _parts(key)
    for position, part in enumerate(parts):
        if isinstance(node, list):
            part = _index(node, part, key)
            if part >= len(node):
                raise CampaignError(f"key '{key}': the scene has {len(node)} of them, counted from 0")
        elif isinstance(part, int) or not isinstance(node, dict):
            raise CampaignError(f"key '{key}': '{parts[position - 1]}' is no array or table")
        place.append(part)
        # What the scene leaves to its defaults is not there yet: `tread check` knows whether it may be.
        node = node[part] if isinstance(node, list) else node.get(part, {})
    return tuple(place)


def with_values(scene, values):
    """A copy of the scene with each canonical place of `values` set."""
    scene = copy.deepcopy(scene)
    for place, value in values.items():
        node = scene
        for part in place[:-1]:
            node = node[part] if isinstance(node, list) else node.setdefault(part, {})
        node[place[-1]] = value
    return scene


def value_at(scene, place, default):
    """What stands at a canonical place."""
    node = scene
    for part in place:
        try:
            node = node[part]
        except (KeyError, IndexError, TypeError):
            return default
    return node


def with_absolute_paths(node, folder):
    """The scene with its relative paths as seen from anywhere: cases stand in other directories than their scene."""
    if isinstance(node, dict):
        return {key: str((Path(folder) / value).resolve()) if key in PATH_KEYS and isinstance(value, str)
                else with_absolute_paths(value, folder) for key, value in node.items()}
    if isinstance(node, list):
        return [with_absolute_paths(item, folder) for item in node]
    return node


def _parts(key):
    parts = []
    for text in key.split("."):
        found = PART.fullmatch(text)
        if not found:
            raise CampaignError(f"key '{key}': '{text}' is no name; a key is like material.sand.young or terrain[0].spacing")
        parts += [found[1], *map(int, re.findall(r"\d+", found[2]))]
    return parts


def _index(tables, part, key):
    if isinstance(part, int):
        return part
    names = [table.get("name") if isinstance(table, dict) else None for table in tables]
    if part not in names:
        known = ", ".join(filter(None, names)) or f"[0] to [{len(tables) - 1}]"
        raise CampaignError(f"key '{key}': no '{part}' among {known}")
    return names.index(part)
