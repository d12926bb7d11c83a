"""From a campaign to its cases: every combination of its axes, the last axis fastest, then repeats."""

import hashlib
import itertools
import math
import tomllib
from dataclasses import dataclass

from tread_jobs.axes import SCENE
from tread_jobs.errors import CampaignError
from tread_jobs.scene_keys import canonical, value_at, with_absolute_paths, with_values
from tread_jobs.toml_text import toml_text

MOST_CASES = 100_000


@dataclass(frozen=True)
class Case:
    number: int
    labels: dict  # text by axis; with repeats, also "repeat"
    values: dict  # by axis: the value of its first key
    scene_text: str

    @property
    def name(self):
        return f"{self.number:04}"

    @property
    def digest(self):
        return hashlib.sha256(self.scene_text.encode()).hexdigest()


def make_cases(campaign):
    """All cases, numbered from 0; the same file gives the same cases. CampaignError where axes clash or name no place of the scene."""
    count = math.prod(len(axis.points) for axis in campaign.axes) * campaign.repeats.count
    if count > MOST_CASES:
        raise CampaignError(f"{campaign.path}: {count} cases; at most {MOST_CASES}")
    scenes, cases = {}, []
    for choice in itertools.product(*(range(len(axis.points)) for axis in campaign.axes)):
        chosen = list(zip(campaign.axes, choice))
        file = next((axis.points[i][axis.keys.index(SCENE)] for axis, i in chosen if SCENE in axis.keys), campaign.scene)
        if not isinstance(file, str):
            raise CampaignError(f"{campaign.path}: scene: a path is a text")
        if file not in scenes:
            scenes[file] = _read_scene(campaign, file)
        settings = _settings(campaign, scenes[file], chosen)
        for repeat in range(campaign.repeats.count):
            cases.append(_case(campaign, len(cases), scenes[file], settings, chosen, repeat))
    _refuse_equal(cases)
    return cases


def _read_scene(campaign, file):
    path = campaign.path.parent / file
    try:
        scene = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise CampaignError(f"{campaign.path}: scene {file}: {error}") from error
    return with_absolute_paths(scene, path.parent)


def _settings(campaign, base, chosen):
    """Values by canonical place, those of [set] first. Refuses two keys of which one lies in the other."""
    named = [(key, value, "[set]") for key, value in campaign.settings.items()]
    for axis, index in chosen:
        named += [(key, value, f"axis '{axis.name}'") for key, value in zip(axis.keys, axis.points[index]) if key != SCENE]
    named += [(key, None, "[repeats] seeds") for key in campaign.repeats.seeds]
    settings, owners = {}, {}
    for key, value, owner in named:
        try:
            place = canonical(base, key)
        except CampaignError as error:
            raise CampaignError(f"{campaign.path}: {owner}: {error}") from error
        for other, other_owner in owners.items():
            if place[:len(other)] == other or other[:len(place)] == place:
                raise CampaignError(f"{campaign.path}: {owner} and {other_owner} clash: both set '{key}' or a part of it")
        owners[place] = owner
        if value is not None:
            settings[place] = value
    return with_paths_of(campaign, settings)


def with_paths_of(campaign, settings):
    """Paths among the values start at the campaign file."""
    return {place: with_absolute_paths({place[-1]: value}, campaign.path.parent)[place[-1]] for place, value in settings.items()}


def _case(campaign, number, base, settings, chosen, repeat):
    labels = {axis.name: axis.labels[index] for axis, index in chosen}
    values = {axis.name: axis.points[index][0] for axis, index in chosen}
    seeds = {}
    if campaign.repeats.count > 1:
        labels["repeat"], values["repeat"] = str(repeat), repeat
        for key in campaign.repeats.seeds:
            place = canonical(base, key)
            first = value_at(base, place, 1)
            if not isinstance(first, int):
                raise CampaignError(f"{campaign.path}: [repeats] seeds: '{key}' is no integer in the scene")
            seeds[place] = first + repeat
    scene = with_values(base, {**settings, **seeds})
    scene["title"] = f"{campaign.title}: " + ", ".join(f"{name} {label}" for name, label in labels.items())
    return Case(number, labels, values, toml_text(scene))


def _refuse_equal(cases):
    seen = {}
    for case in cases:
        body = case.scene_text.partition("\n")[2] if case.scene_text.startswith("title") else case.scene_text
        if body in seen:
            raise CampaignError(f"cases {seen[body].name} and {case.name} are the same scene: {case.labels}")
        seen[body] = case
