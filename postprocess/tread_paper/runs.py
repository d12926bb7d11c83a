"""The list of runs, configs/paper/round2/runs.toml: what each is called, and the command that makes it."""

import re
import shlex
import tomllib
from dataclasses import dataclass

from tread_paper.measures import in_scene
from tread_post import RunError

KEYS = {"name", "scene", "set", "repeats", "values", "coarser", "stage", "seconds"}
IN_PARTS = 500.0  # s; longer runs go on from checkpoints
PART = "00:08:30"


@dataclass(frozen=True)
class Planned:
    """One run of the list; `group` is the run whose repeat it is."""

    name: str
    group: str
    scene: str
    set: tuple
    stage: int
    seconds: float

    def command(self, program, folder):
        words = [program, "run", self.scene, *(word for setting in self.set for word in ("--set", setting)), "--output", f"{folder}/{self.name}", "--quiet"]
        if self.seconds > IN_PARTS:
            words += ["--restart", "auto", "--walltime-limit", PART]
        return shlex.join(words)


class Plan:
    """All runs, and the groups of repeats that the criteria name."""

    def __init__(self, path):
        self.groups, self.coarser = {}, {}
        for run in tomllib.loads(path.read_text(encoding="utf-8"))["run"]:
            unknown = set(run) - KEYS
            if unknown or not {"name", "scene", "stage", "seconds"} <= set(run):
                raise RunError(f"{path}: {run.get('name')}: needs name, scene, stage and seconds; unknown: {', '.join(sorted(unknown)) or 'none'}")
            for name, given in _variants(run):
                if name in self.groups:
                    raise RunError(f"{path}: {name} stands twice")
                self.groups[name] = [_planned(run, name, number, [*given, *repeat]) for number, repeat in enumerate([[], *run.get("repeats", [])], 1)]
                if "coarser" in run:
                    self.coarser[name] = run["coarser"]
        strange = {name for name in self.coarser.values() if name not in self.groups}
        if strange:
            raise RunError(f"{path}: coarser: no run {', '.join(sorted(strange))}")

    def members(self, group):
        """Names of a run and of its repeats. RunError where the list has no such run."""
        if group not in self.groups:
            raise RunError(f"'{group}' is no run of the list")
        return [run.name for run in self.groups[group]]

    def queue(self, stages=None):
        """All runs in the order in which they should be made: by stage, the longest first."""
        runs = [run for group in self.groups.values() for run in group if stages is None or run.stage in stages]
        return sorted(runs, key=lambda run: (run.stage, -run.seconds))


def _variants(run):
    """(name, settings) of a run, or of each value of its key."""
    given = run.get("set", [])
    if "values" not in run:
        return [(run["name"], given)]
    key = run["values"]["key"]
    return [(f"{run['name']}_{value}", [*given, f"{key}={value}"]) for value in run["values"]["list"]]


def _planned(run, name, number, settings):
    # Later settings win; snapshots are wanted of a run's first member alone, and there only as its own settings say.
    if number > 1 or not any(one.startswith("output.snapshots_every") for one in settings):
        settings = [one for one in settings if not one.startswith("output.snapshots_every")] + ["output.snapshots_every=0"]
    return Planned(name if number == 1 else f"{name}_{number}", name, run["scene"], tuple(settings), run["stage"], run["seconds"])


def contradicted(scene, settings):
    """Keys whose value in a run's resolved scene is not that of its settings. Keys that a resolved scene does not keep, and places "on surface", say nothing."""
    wanted = dict(setting.split("=", 1) for setting in settings)
    return [key for key, text in wanted.items() if not _same(scene, re.sub(r"\[(\d+)\]", r".\1", key), text)]


def _same(scene, key, text):
    try:
        value = tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        value = text
    if "on surface" in text or isinstance(value, list) and any(isinstance(one, dict) for one in value):
        return True
    try:
        found = in_scene(scene, key)
    except RunError:
        return True
    if isinstance(value, dict):
        return all(found.get(name) == one for name, one in value.items())
    return found == value
