"""From a campaign to its cases: every combination of its axes, the last axis fastest, then each value of its arms alone; repeats within."""

import hashlib
import itertools
import math
import tomllib
from dataclasses import dataclass, replace

from tread_jobs.axes import SCENE, label_of
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
    varied: tuple[str, ...]  # the axes that set something
    is_own: bool = False  # the scene as it is, in the midst of arms

    @property
    def name(self):
        return f"{self.number:04}"

    @property
    def digest(self):
        return hashlib.sha256(self.scene_text.encode()).hexdigest()


def make_cases(campaign):
    """All cases, numbered from 0; the same file gives the same cases. CampaignError where axes clash or name no place of the scene."""
    count = (math.prod(len(axis.points) for axis in campaign.axes) + sum(len(arm.points) for arm in campaign.arms)) * campaign.repeats.count
    if count > MOST_CASES:
        raise CampaignError(f"{campaign.path}: {count} cases; at most {MOST_CASES}")
    scenes, cases = {}, []
    for chosen in _combinations(campaign.axes):
        cases += _cases_of(campaign, chosen, scenes, len(cases))
    _refuse_equal(cases)
    for chosen in _single_values(campaign.arms):
        cases = without_repetition(cases + _cases_of(campaign, chosen, scenes, len(cases)), _body)
    return cases


def without_repetition(cases, identity):
    """The first of all cases of which `identity` is equal, numbered anew; the one that stays is the scene as it is if any of them was."""
    kept = {}
    for case in cases:
        first = kept.setdefault(identity(case), case)
        kept[identity(case)] = replace(first, is_own=first.is_own or case.is_own)
    return [replace(case, number=number) for number, case in enumerate(kept.values())]


def _combinations(axes):
    """Lists of (axis, index of its value); nothing where there are no axes."""
    return [list(zip(axes, choice)) for choice in itertools.product(*(range(len(axis.points)) for axis in axes))] if axes else []


def _single_values(arms):
    """Likewise: the scene as it is, then each value alone."""
    return [[], *([(arm, index)] for arm in arms for index in range(len(arm.points)))] if arms else []


def _cases_of(campaign, chosen, scenes, number):
    """The repeats of one choice; `scenes` keeps those that were read."""
    file = next((axis.points[i][axis.keys.index(SCENE)] for axis, i in chosen if SCENE in axis.keys), campaign.scene)
    if not isinstance(file, str):
        raise CampaignError(f"{campaign.path}: scene: a path is a text")
    if file not in scenes:
        scenes[file] = _read_scene(campaign, file)
    settings = _settings(campaign, scenes[file], chosen)
    return [_case(campaign, number + repeat, scenes[file], settings, chosen, repeat) for repeat in range(campaign.repeats.count)]


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
    labels, values = {}, {}
    for axis in campaign.axes + campaign.arms:
        index = next((index for other, index in chosen if other is axis), None)
        values[axis.name] = _own_value(base, settings, axis) if index is None else axis.points[index][0]
        labels[axis.name] = label_of(values[axis.name]) if index is None else axis.labels[index]
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
    return Case(number, labels, values, toml_text(scene), tuple(axis.name for axis, _ in chosen), is_own=not chosen)


def _own_value(base, settings, axis):
    """What the scene itself says, or [set] for it; the word "default" where neither does."""
    place = canonical(base, axis.keys[0])
    return settings.get(place, value_at(base, place, "default"))


def _refuse_equal(cases):
    seen = {}
    for case in cases:
        if _body(case) in seen:
            raise CampaignError(f"cases {seen[_body(case)].name} and {case.name} are the same scene: {case.labels}")
        seen[_body(case)] = case


def _body(case):
    """The scene but for its title, which is the first line."""
    return case.scene_text.partition("\n")[2] if case.scene_text.startswith("title") else case.scene_text
