"""From a set of measured wheels and the user's wishes to a campaign: configs/validation/sets.toml names the campaign files."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from tread_jobs.campaign_file import parse_campaign
from tread_jobs.errors import CampaignError
from tread_jobs.toml_text import toml_text

SETS = Path(__file__).resolve().parents[2] / "configs" / "validation" / "sets.toml"
ASSUMED = "assumed"  # the axis of what a source does not give; its first value is that of the scene


@dataclass(frozen=True)
class SetEntry:
    name: str
    title: str
    source: str
    campaign: Path
    quick: Path


def read_entries():
    """{name: SetEntry} of all sets."""
    try:
        table = tomllib.loads(SETS.read_text(encoding="utf-8"))
        return {entry["name"]: SetEntry(entry["name"], entry["title"], entry["source"], SETS.parent / entry["campaign"], SETS.parent / entry["quick"])
                for entry in table["set"]}
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise CampaignError(f"{SETS}: {error!r}") from error


def chosen_entries(names):
    """The SetEntries of the names, or all."""
    entries = read_entries()
    for name in names:
        if name not in entries:
            raise CampaignError(f"no set '{name}'; accepted: {', '.join(entries)}")
    return [entries[name] for name in dict.fromkeys(names or entries)]


def campaign_of(entry, form, settings, resources, path):
    """The campaign of a set as it is run here. `form`: "full", "nominal" (what is assumed stays as in the scene) or "quick"."""
    source = entry.quick if form == "quick" else entry.campaign
    try:
        table = tomllib.loads(source.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise CampaignError(f"{source}: {error}") from error
    if form == "nominal":
        table["axis"] = [axis for axis in table["axis"] if axis.get("name") != ASSUMED]
    # Tables come last in TOML, so that plain keys are set first.
    campaign = {"title": table["title"], "scene": str((source.parent / table["scene"]).resolve())}
    if table.get("set") or settings:
        campaign["set"] = table.get("set", {}) | settings
    return parse_campaign(path, toml_text(campaign | {"axis": table["axis"], "resources": resources}))
