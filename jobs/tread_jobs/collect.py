"""One table of a campaign: axes, answers, what it cost, where it ran. Needs h5py and numpy, and reads runs with postprocess/tread_post."""

import csv
import datetime
import io
import json
import math
import sys
from pathlib import Path

from tread_jobs.errors import MachineError
from tread_jobs.files import number_of, printable, write_text
from tread_jobs.status import DONE, CaseState, read_summary

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "postprocess"))
try:
    from tread_post.answers import answers_of
    from tread_post.campaign import write_campaign_table
    from tread_post.run import DAMAGE, Run, words_of
    from tread_post.verdict import FAILED, UNKNOWN, Resolution, resolution_of
except ImportError as missing:
    raise MachineError(f"collect needs h5py and numpy ({missing}): on Debian /usr/bin/python3 with python3-h5py") from missing

# Of summary.json, with units; errors are those of the run's ledger.
NUMBERS = {"time": "s", "steps": "1", "substeps": "1", "points": "1", "bodies": "1", "wall_s": "s", "restarts": "1"}
ERRORS = {"mass": "1", "momentum": "1", "energy": "1"}
PROVENANCE = ("scene_hash", "version", "commit", "backend", "devices", "ranks", "start", "end")


def collect_campaign(directory, states, dry_run):
    """Writes campaign.h5 and campaign.csv, or with `dry_run` gives the CSV back, in lines. One row a case, done or not."""
    manifest, entries = directory.manifest, directory.entries()
    rows = [_row(directory.cases / entry.name, states[entry.name]) for entry in entries]
    groups = {
        "case": {
            "number": ([entry.number for entry in entries], "1"),
            "state": ([row["state"].state for row in rows], "1"),
            "reason": ([printable(row["state"].reason) for row in rows], "1"),
            "tail": ([row["state"].tail for row in rows], "1"),
            "verdict": ([printable(_verdict(row)) for row in rows], "1"),
            "worst_figure": ([printable(row["resolution"].worst_figure) for row in rows], "1"),
            "warning_text": ([printable("\n".join(row["resolution"].warnings)) for row in rows], "1"),
        },
        "labels": {name: ([entry.labels[name] for entry in entries], "1") for name in entries[0].labels},
        "axes": {name: column for name in entries[0].labels if (column := _numbers(entries, manifest, name))},
        "answers": _columns([row["answers"] for row in rows]),
        "summary": _columns([row["summary"] for row in rows]),
        "provenance": {name: ([row["provenance"].get(name, "") for row in rows], "1") for name in PROVENANCE},
    }
    table = _csv_text(groups)
    if dry_run:
        return table.splitlines()
    attributes = {
        "title": manifest["title"], "campaign": (directory.cases / "campaign.toml").read_text(encoding="utf-8"),
        "axes": json.dumps(manifest["axes"]), "cost": json.dumps(manifest["cost"]),
        "collected": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
    }
    write_campaign_table(directory.path / "campaign.h5", attributes, groups)
    write_text(directory.path / "campaign.csv", table)
    return [f"{directory.path / name}: {len(entries)} cases" for name in ("campaign.h5", "campaign.csv")]


def _row(case, state):
    """State, answers, numbers and texts of a case; empty where it has none. A case that is done and damaged has failed: it costs its own row alone."""
    answers, told, damage = {}, {"summary": {}, "provenance": {}, "resolution": Resolution(UNKNOWN)}, []
    try:
        told = _told(read_summary(case) or {})
    except DAMAGE as error:
        damage.append(f"summary.json: {words_of(error)}")
    try:
        values, units = answers_of(Run(case / "run"))
        answers = {name: (value, units[name]) for name, value in values.items()}
    except DAMAGE as error:
        damage.append(words_of(error))
    if damage and state.state == DONE:
        answers, state = {}, CaseState(FAILED, f"cannot be read: {damage[0]}", state.tail)
    return {"state": state, "answers": answers, **told}


def _told(summary):
    """What a summary.json says."""
    numbers = {name: (number_of(summary[name]), unit) for name, unit in NUMBERS.items() if name in summary}
    errors = summary.get("errors") or {}
    numbers |= {f"{name}_error": (number_of(errors[name]), unit) for name, unit in ERRORS.items() if name in errors}
    resolution = resolution_of(summary)
    numbers |= {name: (number_of(value), "1") for name, value in resolution.errors.items()}
    if summary:
        numbers["warnings"] = (len(resolution.warnings), "1")
    texts = {name: printable(_text(summary[name])) for name in PROVENANCE if summary.get(name) is not None}
    return {"summary": numbers, "provenance": texts, "resolution": resolution}


def _verdict(row):
    """A case that was killed has failed, too, although its summary, if any, is one of before."""
    return FAILED if row["state"].state == FAILED else row["resolution"].verdict


def _columns(rows):
    """Columns of all names that any row has; NaN where one has none."""
    units = {name: unit for row in rows for name, (_, unit) in row.items()}
    return {name: ([row[name][0] if name in row else math.nan for row in rows], unit) for name, unit in units.items()}


def _numbers(entries, manifest, name):
    """The column of an axis whose values are numbers; None for others, and for linked keys, whose labels have to do."""
    axis = next((axis for axis in manifest["axes"] if axis["name"] == name), {"unit": "1", "keys": [name]})
    values = [entry.values[name] for entry in entries]
    are_numbers = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values)
    return (values, axis["unit"]) if are_numbers and len(axis["keys"]) == 1 else None


def _text(value):
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


def _csv_text(groups):
    """Returns the contents of campaign.h5 as CSV, with units in the header, without tails of logs and texts of warnings. Axes are numbers where they can be, else labels."""
    axes = {f"axis_{name}": groups["axes"].get(name, column) for name, column in groups["labels"].items()}
    parts = (groups["case"], axes, groups["answers"], groups["summary"], groups["provenance"])
    columns = [(name, *column) for part in parts for name, column in part.items() if name not in ("tail", "warning_text")]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([name if unit == "1" else f"{name} [{unit}]" for name, _, unit in columns])
    for row in zip(*(values for _, values, _ in columns)):
        writer.writerow([_cell(value) for value in row])
    return text.getvalue()


def _cell(value):
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.7g}"
    return value
