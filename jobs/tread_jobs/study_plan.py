"""From the options of a study to a campaign: what varies, and how."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from tread_jobs.errors import CampaignError
from tread_jobs.scene_keys import canonical, value_at
from tread_jobs.toml_text import toml_text

DESIGNS = ("grid", "star")
# The axis of repeats; what else is called by keys has dots.
PERTURBATION = "perturbation"
SHIFT = 1e-9  # m: of a body, at the start of a repeat. Positions resolve 1e-10 m.


@dataclass(frozen=True)
class Variation:
    key: str
    values: tuple


def read_scene(path):
    """The scene file as TOML; what its keys may hold is for `tread check` to say."""
    try:
        return tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise CampaignError(f"{path}: {error}") from error


def read_setting(text):
    """(key, value) of KEY=VALUE, as `tread run --set` takes it."""
    key, equals, value = text.partition("=")
    if not equals or not key:
        raise CampaignError(f"--set {text}: KEY=VALUE")
    return key, _value(value)


def read_variation(text):
    """KEY=A,B,C with TOML values; a bare word is a string."""
    key, equals, values = text.partition("=")
    if not equals or not key:
        raise CampaignError(f"--vary {text}: KEY=VALUE,VALUE,...")
    found = tuple(_value(part) for part in _parts(values))
    if len(found) < 2:
        raise CampaignError(f"--vary {key}: at least two values, with commas between")
    return Variation(key, found)


def campaign_text(scene_path, variations, design, settings, repeats, resources):
    """A campaign file (docs/campaigns.md) of the study of a scene. `repeats`: (number, "position" or "seed") of the perturbed ones of the scene as
    it is."""
    scene = read_scene(scene_path)
    tables = [{"key": variation.key, "name": variation.key, "values": list(variation.values)} for variation in variations]
    for variation in variations:
        canonical(scene, variation.key)  # says what is wrong with the key before a campaign file is named that the user never wrote
    campaign = {"title": f"Study of {scene.get('title', Path(scene_path).stem)}", "scene": str(Path(scene_path).resolve())}
    if settings:
        campaign["set"] = settings
    campaign["axis" if design == "grid" else "arm"] = tables
    count, what = repeats
    if count:
        campaign["arm"] = campaign.get("arm", []) + [_perturbation(scene, settings, count, what)]
    campaign["resources"] = resources
    return toml_text(campaign)


def default_repeats(scene):
    """Beds of rocks are chaotic: what differs by rounding ends up differently."""
    return 3 if scene.get("rocks") and scene.get("body") else 0


def _perturbation(scene, settings, count, what):
    if what == "seed":
        rocks = [index for index, rocks in enumerate(scene.get("rocks", [])) if "from" not in rocks]
        if not rocks:
            raise CampaignError("--perturb seed: the scene draws no [[rocks]]")
        first = [_own(scene, settings, f"rocks[{index}].seed", 1) for index in rocks]
        values = [[seed + 100 * number for seed in first] for number in range(1, count + 1)]
        labels = [f"seeds + {100 * number}" for number in range(1, count + 1)]
        keys = [f"rocks[{index}].seed" for index in rocks]
        # One key takes bare values.
        values = values if len(keys) > 1 else [value for value, in values]
        return {"keys": keys, "name": PERTURBATION, "values": values, "labels": labels}
    if not scene.get("body"):
        raise CampaignError("--repeats: the scene has no [[body]] whose position could be perturbed")
    place = _own(scene, settings, "body[0].position", None)
    values = [[place[0] + number * SHIFT, *place[1:]] for number in range(1, count + 1)]
    return {"key": "body[0].position", "name": PERTURBATION, "values": values,
            "labels": [f"{number * SHIFT:g} m" for number in range(1, count + 1)]}


def _own(scene, settings, key, default):
    place = canonical(scene, key)
    return next((value for other, value in settings.items() if canonical(scene, other) == place), value_at(scene, place, default))


def _parts(text):
    """Split at the commas that stand outside of brackets, braces and quotes."""
    parts, depth, quote = [""], 0, ""
    for letter in text:
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        depth += (letter in "[{") - (letter in "]}") if not quote else 0
        if letter == "," and depth == 0 and not quote:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts]


def _value(text):
    if not text:
        raise CampaignError("an empty value: two commas, or one at an end")
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text
