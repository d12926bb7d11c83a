"""From the options of a calibration to campaigns: which keys are fitted, and the runs of each round as one axis of linked keys."""

import re
import tomllib

from tread_jobs.campaign_file import parse_campaign
from tread_jobs.errors import CampaignError
from tread_jobs.fit import Parameter
from tread_jobs.scene_keys import canonical, value_at
from tread_jobs.toml_text import toml_text

AXIS = "parameters"


def read_parameter(text, scene):
    """The Parameter of KEY=LOW..HIGH or KEY=LOW..HIGH:log. CampaignError for what is none, or for a place that holds no number."""
    found = re.fullmatch(r"([^=]+)=([^=:]+?)\.\.([^=:]+?)(:log|:linear)?", text)
    if not found:
        raise CampaignError(f"--fit {text}: accepted: KEY=LOW..HIGH, with :log behind it for a logarithmic scale")
    key, scale = found[1].strip(), (found[4] or ":linear")[1:]
    try:
        low, high = float(found[2]), float(found[3])
    except ValueError as error:
        raise CampaignError(f"--fit {text}: LOW and HIGH are numbers") from error
    if not low < high or scale == "log" and low <= 0:
        raise CampaignError(f"--fit {text}: LOW is under HIGH, and over 0 on a logarithmic scale")
    own = value_at(scene, canonical(scene, key), None)
    if own is not None and (isinstance(own, bool) or not isinstance(own, (int, float))):
        raise CampaignError(f"--fit {key}: the scene has {own!r} there, which is no number")
    return Parameter(key, low, high, scale)


def campaign_text(title, scene, settings, parameters, points, resources):
    """A campaign file with a case for each of `points`, values of the parameters in their order."""
    keys = [parameter.key for parameter in parameters]
    rows = [[float(f"{value:.9g}") for value in point] for point in points]
    # One key takes bare values.
    values = rows if len(keys) > 1 else [value for value, in rows]
    campaign = {"title": title, "scene": str(scene)}
    if settings:
        campaign["set"] = settings
    axis = {"keys": keys, "name": AXIS, "values": values, "labels": [f"{number}: {', '.join(f'{value:.6g}' for value in row)}" for number, row in enumerate(rows)]}
    return toml_text(campaign | {"axis": [axis], "resources": resources})


def round_campaign(path, *parts):
    """The Campaign of a round, as if it stood in the file at `path`."""
    return parse_campaign(path, campaign_text(*parts))


def read_scene(path):
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise CampaignError(f"{path}: {error}") from error
