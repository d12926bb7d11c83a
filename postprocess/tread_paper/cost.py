"""What runs cost beside the paper's, which were not made, and what each stored run says of itself: tables of docs/paper.md."""

import tomllib

from tread_paper import criteria
from tread_paper.measures import was_stopped
from tread_paper.runs import IN_PARTS
from tread_post import RunError
from tread_post.verdict import headline, resolution_of, text_of

KEYS = {"case", "run", "paper", "target", "note"}
USUAL = "NVIDIA H200"


def cost_lines(path, plan, measures):
    """A row for each of a file of costs."""
    lines = ["| case | paper: s; steps/s; MB | wall, s | simulated s per s | steps/s | substeps a step | peak MB | energy error | resolution | target, s | |",
             "|---|---|---|---|---|---|---|---|---|---|---|"]
    for row in tomllib.loads(path.read_text(encoding="utf-8"))["row"]:
        if set(row) - KEYS or not {"case", "run", "paper"} <= set(row):
            raise RunError(f"{path}: {row.get('case')}: needs case, run and paper; may have target and note")
        there = [measures.run(name) for name in plan.members(row["run"]) if measures.has(name)]
        cells = _cost_of(there, measures) if there else ["-"] * 7
        cells += [str(row.get("target", "")), _met(row, there)]
        lines.append(f"| {row['case']} | {row['paper']} | {' | '.join(cells)} |")
    return lines


def _cost_of(runs, measures):
    """Wall time of all repeats; everything else of the first."""
    summary, name = runs[0].summary, runs[0].path.name
    walls = ", ".join(_wall_of(run) for run in runs)
    cards = {card for run in runs for card in run.summary.get("devices", [])} - {USUAL}
    return [walls + (f" ({', '.join(sorted(cards))})" if cards else ""), f"{summary['sim_per_wall']:.3g}",
            f"{summary['steps_per_s']:.0f}", f"{measures(f'{name} summary substeps_a_step'):.1f}", f"{measures(f'{name} summary memory_mb'):.0f}",
            f"{measures(f'{name} summary energy_error'):.0e}", text_of(resolution_of(summary).verdict)]


def _wall_of(run):
    summary = run.summary
    wall = f"{summary['wall_s']:.{1 if summary['wall_s'] < 20 else 0}f}"
    if summary.get("restarts", 0) > 0:
        wall += f" in {1 + summary['restarts']} parts"
    return f"{wall} to {summary['time']:.1f} s, stopped" if was_stopped(run) else wall


def _met(row, runs):
    if not runs:
        return "not run"
    if "target" not in row:
        return row.get("note", "")
    met = all(run.summary["wall_s"] <= row["target"] and not was_stopped(run) for run in runs)
    word = "met" if met else "missed"
    return f"{word}; {row['note']}" if "note" in row else word


def not_run_lines(plan, measures, tables):
    """Runs of the list that are not stored: what each needs, and how many rows wait for it."""
    missing = [run for run in plan.queue() if not measures.has(run.name)]
    total = sum(run.seconds for run in missing)
    lines = [f"{len(plan.queue()) - len(missing)} of the {len(plan.queue())} runs of the list are stored. The others need {total:g} s of one H200 together.", ""]
    if missing:
        lines += ["| run | s of one H200, expected | parts of 510 s | rows that wait for it |", "|---|---|---|---|"]
    waiting = {group: sum(group in criteria.groups_of(row) and verdict.startswith("not run") for row, verdict in tables) for group in plan.groups}
    for run in missing:
        parts = f"{-(-run.seconds // 510):.0f}" if run.seconds > IN_PARTS else "1"
        lines.append(f"| {run.name} | {run.seconds:g} | {parts} | {waiting[run.group] if run.name == run.group else 'a repeat'} |")
    return lines


def run_lines(plan, measures):
    """A row for each stored run: resolution, rest, where it ran, and its differences from the scene."""
    stored = [(run, measures.run(run.name)) for group in plan.groups.values() for run in group if measures.has(run.name)]
    verdicts = [resolution_of(run.summary) for _, run in stored]
    lines = [f"**{headline([one.verdict for one in verdicts], 'stored runs')}**", "",
             "| run | scene | resolution | phases | commit, device | parts | `--set` |", "|---|---|---|---|---|---|---|"]
    for (planned, run), resolution in zip(stored, verdicts):
        summary = run.summary
        worst = f": {resolution.worst_figure}" if resolution.worst_figure else ""
        rest = ", ".join(criteria.facts_of(summary)[1:-1])
        settings = " ".join(one for one in planned.set if not one.startswith("output."))
        lines.append(f"| {run.path.name} | {planned.scene.removeprefix('configs/paper/').removesuffix('.toml')} | {text_of(resolution.verdict)}{worst} | {rest} | "
                     f"{summary['commit'][:8]}, {', '.join(summary['devices']).removeprefix('NVIDIA ')} | {1 + summary['restarts']} | "
                     f"{f'`{settings}`' if settings else ''} |")
    return lines


def readings_lines(rows):
    """How many of the judged rows of each reading agree. `rows` are (row, verdict) of the readings; a reading is what stands before the colon or comma."""
    counted = {}
    for row, verdict in rows:
        word = verdict.split()[0].rstrip(";:,")
        if word in ("agrees", "differs", "undecided"):
            counted.setdefault(reading_of(row["what"]), []).append(word)
    lines = ["| reading | rows judged | agree | differ | undecided |", "|---|---|---|---|---|"]
    return lines + [f"| {name} | {len(words)} | {words.count('agrees')} | {words.count('differs')} | {words.count('undecided')} |" for name, words in counted.items()]


def reading_of(what):
    """Words of a row up to its first colon."""
    return what.partition(":")[0]

