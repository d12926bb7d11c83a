"""The --set options that the runs of a directory were made with, kept as JSON beside each run. Standard library only."""

import json

from tread_ladder.problems import PROBLEMS


class LadderError(Exception):
    """The command line is wrong or does not fit the runs that are there."""


def changes_of(settings):
    """{key: value} of KEY=VALUE settings. As in tread the last one of a key counts."""
    return {key.strip(): value.strip() for key, _, value in (setting.partition("=") for setting in settings)}


def text_of(changes):
    """The options that make these changes."""
    return " ".join(f"--set {key}={value}" for key, value in changes.items()) or "no --set"


def is_done(folder):
    """Whether a run has finished there."""
    summary = folder / "summary.json"
    return summary.is_file() and json.loads(summary.read_text(encoding="utf-8")).get("status") == "finished"


def write_arguments(folder, settings):
    """Writes the arguments of a run before it starts: a run that is killed is made anew, and its arguments with it."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    _file_of(folder).write_text(json.dumps({"set": changes_of(settings)}, indent=2) + "\n", encoding="utf-8")


def finished_runs(output):
    """{folder: changes} of all finished runs in a directory."""
    folders = sorted(path.parent for name in PROBLEMS for path in (output / name).glob("*/summary.json"))
    return {folder: _read_arguments(folder) for folder in folders if is_done(folder)}


def refuse_other_arguments(output, settings):
    """Raises a LadderError if a finished run was made with other settings."""
    asked = changes_of(settings)
    for folder, made in finished_runs(output).items():
        if made != asked:
            raise LadderError(f"{folder} was made with {text_of(made)}, this command has {text_of(asked)}: use another --output")


def common_arguments(output):
    """The changes that all finished runs share. Raises a LadderError if they differ."""
    runs = list(finished_runs(output).items())
    for folder, made in runs[1:]:
        if made != runs[0][1]:
            raise LadderError(f"{runs[0][0]} was made with {text_of(runs[0][1])}, {folder} with {text_of(made)}: they make no common table")
    return runs[0][1] if runs else {}


def _file_of(folder):
    return folder.parent / f"{folder.name}.json"


def _read_arguments(folder):
    path = _file_of(folder)
    try:
        changes = json.loads(path.read_text(encoding="utf-8"))["set"]
        if not isinstance(changes, dict):
            raise TypeError("'set' is no object")
        return changes
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise LadderError(f"{folder} has finished, but {path} does not say with which --set options ({error}): "
                          "remove the run or use another --output") from error
