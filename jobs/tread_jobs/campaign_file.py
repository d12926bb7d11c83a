"""Reads a campaign file: docs/campaigns.md says what may stand there."""

import hashlib
import tomllib
from dataclasses import dataclass
from pathlib import Path

from tread_jobs.axes import Axis, read_axis
from tread_jobs.errors import CampaignError
from tread_jobs.resources import Resources, read_resources

TABLES = ("title", "scene", "axis", "arm", "repeats", "set", "resources")


@dataclass(frozen=True)
class Repeats:
    """The same case again with other random numbers: the seeds at `seeds` grow by one from repeat to repeat."""

    count: int = 1
    seeds: tuple[str, ...] = ()


@dataclass(frozen=True)
class Campaign:
    path: Path
    text: str
    title: str
    scene: str  # as the file has it; relative to the file
    settings: dict  # keys that all cases share, over those of the scene
    axes: tuple[Axis, ...]  # every combination of their values
    arms: tuple[Axis, ...]  # each value alone, around the scene as it is
    repeats: Repeats
    resources: Resources

    @property
    def digest(self):
        return hashlib.sha256(self.text.encode()).hexdigest()


def read_campaign(path):
    """The campaign in the file at `path`; CampaignError says what is wrong with it."""
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise CampaignError(f"{path}: {error}") from error
    return parse_campaign(path, text)


def parse_campaign(path, text):
    """The campaign that `text` is, as if it stood in the file at `path`."""
    try:
        return _campaign(path, text, tomllib.loads(text))
    except (CampaignError, tomllib.TOMLDecodeError) as error:
        raise CampaignError(f"{path}: {error}") from error


def _campaign(path, text, table):
    unknown = sorted(set(table) - set(TABLES))
    if unknown:
        raise CampaignError(f"unknown key '{unknown[0]}'; known are {', '.join(TABLES)}")
    title, scene, settings = table.get("title", path.stem), table.get("scene", ""), table.get("set", {})
    if not isinstance(title, str) or not isinstance(scene, str) or not isinstance(settings, dict):
        raise CampaignError("title and scene are texts, set is a table")
    axes, arms = _axes(table, "axis"), _axes(table, "arm")
    if not axes and not arms:
        raise CampaignError("no [[axis]] and no [[arm]]: a campaign varies something")
    if arms and any("scene" in axis.keys for axis in axes + arms):
        raise CampaignError("[[arm]]s vary the keys of one scene: no axis and no arm is called scene beside them")
    names = [axis.name for axis in axes + arms]
    if len(set(names)) < len(names):
        raise CampaignError(f"two axes are called '{max(names, key=names.count)}': give one of them another name")
    if not scene and not any("scene" in axis.keys for axis in axes):
        raise CampaignError("scene is missing: the file that all cases start from")
    return Campaign(path, text, title, scene, settings, axes, arms, _repeats(table.get("repeats", {})), read_resources(table.get("resources", {})))


def _axes(table, kind):
    tables = table.get(kind, [])
    if not isinstance(tables, list) or not all(isinstance(axis, dict) for axis in tables):
        raise CampaignError(f"{kind} is no [[{kind}]]")
    return tuple(read_axis(axis, f"[[{kind}]] {number}") for number, axis in enumerate(tables, 1))


def _repeats(table):
    if not isinstance(table, dict) or set(table) - {"count", "seeds"}:
        raise CampaignError("[repeats]: count and seeds")
    count, seeds = table.get("count", 1), table.get("seeds", [])
    if not isinstance(count, int) or count < 1:
        raise CampaignError("[repeats] count: an integer of at least 1")
    if not isinstance(seeds, list) or not all(isinstance(seed, str) for seed in seeds):
        raise CampaignError("[repeats] seeds: a list of keys")
    if count > 1 and not seeds:
        raise CampaignError("[repeats] seeds: which keys change; a run repeated with the same seeds gives the same bits")
    return Repeats(count, tuple(seeds))
