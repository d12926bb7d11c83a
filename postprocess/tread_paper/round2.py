"""The second round of docs/paper.md: its criteria, judged with the runs that are there."""

import tomllib

from tread_paper import criteria
from tread_paper.formulas import Theories
from tread_paper.measures import Measures
from tread_paper.runs import Plan

TITLES = {"method": "2 Method", "head_on": "3.1 Head-on collision", "wheel_drop": "3.2 Wheel drop", "rolling": "3.3 Rolling", "slip": "3.4 Slip 0.3 on Mars",
          "spirit": "4 Spirit", "curiosity": "5 Curiosity", "readings": "Readings of what the paper leaves open"}


def lines_of(folder, runs, root):
    """Lines of Markdown: a count of the verdicts, and a table a section. `folder` holds the criteria, `runs` the stored runs."""
    measures, plan = Measures(runs), Plan(folder / "runs.toml")
    table = criteria.Table(plan, measures, Theories(plan, root, measures), seen_in(folder / "seen.toml"))
    tables = {case: table.lines(criteria.rows_of(folder / f"{case}.toml")) for case in criteria.CASES}
    lines = [criteria.counts_of(tables.values())]
    for case, rows in tables.items():
        note = tomllib.loads((folder / f"{case}.toml").read_text(encoding="utf-8")).get("note")
        lines += ["", f"### {TITLES[case]}", "", *([note, ""] if note else []), *rows]
    return lines


def seen_in(path):
    """What a person read off figures, by the row's `what`: tables `seen` with what and answer. Empty without the file."""
    if not path.is_file():
        return {}
    return {one["what"]: one["answer"] for one in tomllib.loads(path.read_text(encoding="utf-8")).get("seen", [])}
