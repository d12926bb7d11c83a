"""The directory of a campaign. Nothing else is written to; cases and manifest appear together, by one rename."""

import contextlib
import fcntl
import hashlib
import json
import shutil
from dataclasses import dataclass
from pathlib import Path

from tread_jobs.errors import CampaignError
from tread_jobs.files import read_object

SCHEMA = 1
# What tasks read and write in the directory of a case.
WRITTEN = ("scene.toml", "run", "output.txt", "attempts.log")


@dataclass(frozen=True)
class Entry:
    """A case as the manifest has it."""

    number: int
    labels: dict
    values: dict
    digest: str
    is_own: bool = False  # the scene as it is, in the midst of arms

    @property
    def name(self):
        return f"{self.number:04}"


class CampaignDirectory:
    """`cases/0007/scene.toml`, `cases/manifest.json`, and `submissions/0001/`, of one campaign."""

    def __init__(self, path):
        self.path = Path(path).resolve()
        self.cases = self.path / "cases"
        self.submissions = self.path / "submissions"

    @property
    def is_expanded(self):
        return (self.cases / "manifest.json").is_file()

    def write(self, campaign, cases, cost):
        """The cases of a campaign. Into an empty directory, or one in which an earlier attempt was cut off."""
        fresh = self.path / "cases.new"
        strangers = [entry.name for entry in self.path.iterdir() if entry.name not in ("cases.new", ".lock")] if self.path.exists() else []
        if strangers:
            raise CampaignError(f"{self.path}: holds '{sorted(strangers)[0]}', which is no campaign's; --output names an empty directory")
        if fresh.exists():
            shutil.rmtree(fresh)
        for case in cases:
            folder = fresh / case.name
            folder.mkdir(parents=True)
            (folder / "scene.toml").write_text(case.scene_text, encoding="utf-8")
        (fresh / "campaign.toml").write_text(campaign.text, encoding="utf-8")
        manifest = {
            "schema": SCHEMA, "title": campaign.title, "campaign": str(campaign.path.resolve()), "digest": campaign.digest, "cost": cost,
            "axes": [{"name": axis.name, "unit": axis.unit, "keys": axis.keys, "labels": axis.labels} for axis in campaign.axes + campaign.arms],
            "cases": [{"number": case.number, "labels": case.labels, "values": case.values, "digest": case.digest, "is_own": case.is_own} for case in cases],
        }
        (fresh / "manifest.json").write_text(json.dumps(manifest, indent=1), encoding="utf-8")
        fresh.rename(self.cases)

    @property
    def manifest(self):
        manifest = read_object(self.cases / "manifest.json")
        if manifest is None:
            raise CampaignError(f"{self.path}: no campaign was expanded here; cases/manifest.json cannot be read")
        if manifest.get("schema") != SCHEMA:
            raise CampaignError(f"{self.path}: its manifest has schema {manifest.get('schema')}, known is {SCHEMA}")
        return manifest

    def entries(self):
        return [Entry(**case) for case in self.manifest["cases"]]

    def refuse_another(self, digest):
        if self.manifest["digest"] != digest:
            raise CampaignError(f"{self.path}: was expanded from another campaign file, or from this one before it changed")

    def refuse_edited(self):
        """A case whose scene is not what was expanded would stand in tables under the wrong values."""
        for entry in self.entries():
            folder = self.cases / entry.name
            scene = folder / "scene.toml"
            if not scene.is_file():
                raise CampaignError(f"{scene}: is missing; expand into a new directory")
            if not all((folder / name).resolve().is_relative_to(self.cases) for name in WRITTEN):
                raise CampaignError(f"{folder}: leads out of the campaign's directory")
            if hashlib.sha256(scene.read_bytes()).hexdigest() != entry.digest:
                raise CampaignError(f"{scene}: was edited after expand; change the campaign file and expand into a new directory")

    @contextlib.contextmanager
    def locked(self):
        """One process at a time submits or runs cases."""
        self.path.mkdir(parents=True, exist_ok=True)
        with open(self.path / ".lock", "w", encoding="utf-8") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError as error:
                raise CampaignError(f"{self.path}: another campaign.py works here") from error
            yield
