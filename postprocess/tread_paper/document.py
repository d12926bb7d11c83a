"""The parts of docs/paper.md that are made: tables of the criteria judged with stored runs, counts, costs, figures. Each stands between two marks."""

import textwrap
import tomllib

from tread_paper import cost, criteria, sensitivity
from tread_paper.answers import because_in, points_in, seen_in
from tread_paper.formulas import Theories
from tread_paper.measures import Measures
from tread_paper.runs import Plan
from tread_post import RunError

TITLES = {"method": "2 Method", "head_on": "3.1 Head-on collision", "wheel_drop": "3.2 Wheel drop", "rolling": "3.3 Rolling", "slip": "3.4 Slip 0.3 on Mars",
          "spirit": "4 Spirit", "curiosity": "5 Curiosity", "readings": "Readings"}
IN_SHORT = ("in_short", "does", "does_not")  # of docs/paper_in_short.md
OTHERS = ("counts", "compared", "cost", "not_run", "runs")  # parts that need all tables or none
CAMPAIGNS = ("sensitivity", "sensitivity_sand")


class Document:
    """Makes each part. `folder` holds the criteria, `runs` the stored runs; scenes are of `root`."""

    def __init__(self, folder, runs, root):
        self.folder, self.plan, self.measures = folder, Plan(folder / "runs.toml"), Measures(runs)
        theories = Theories(self.plan, root, self.measures)
        self.table = criteria.Table(self.plan, self.measures, theories, seen_in(folder / "seen.toml"), because_in(folder / "because.toml"))
        self._cells = {}

    def run(self, name):
        return self.measures.run(name)

    def repeats(self, name):
        """A run and its repeats, as far as they are there."""
        return [self.run(one) for one in self.plan.members(name) if self.measures.has(one)]

    def rows(self, case):
        """(row, cells) of a case."""
        if case not in self._cells:
            self._cells[case] = [(row, self.table.cells(row)) for row in criteria.rows_of(self.folder / f"{case}.toml")]
        return self._cells[case]

    def verdicts(self, case):
        return [cells[-1] for _, cells in self.rows(case)]

    def part(self, name):
        """Lines of Markdown of a case or of one of OTHERS."""
        if name in TITLES:
            note = tomllib.loads((self.folder / f"{name}.toml").read_text(encoding="utf-8")).get("note")
            return [*(note.strip("\n").split("\n") + [""] if note else []), *criteria.lines_of(cells for _, cells in self.rows(name))]
        everything = [(row, cells[-1]) for case in TITLES for row, cells in self.rows(case)] if name == "not_run" else []
        return {
            "counts": lambda: criteria.counts_of({title: self.verdicts(case) for case, title in TITLES.items()}),
            "compared": lambda: cost.readings_lines((row, cells[-1]) for row, cells in self.rows("readings")),
            "cost": lambda: cost.cost_lines(self.folder / "cost.toml", self.plan, self.measures),
            "not_run": lambda: cost.not_run_lines(self.plan, self.measures, everything),
            "runs": lambda: cost.run_lines(self.plan, self.measures),
            "in_short": self._in_short,
            "does": lambda: self._points("does"),
            "does_not": lambda: self._points("does_not"),
        }[name]()

    def _in_short(self):
        """The sentences that count verdicts and targets."""
        verdicts = [line for line in self.part("counts") if line and not line.startswith("|")]
        targets = [line.rpartition(" | ")[2].split()[0].rstrip(";") for line in self.part("cost")[2:] if line.split(" | ")[-2]]
        missed, open_yet = targets.count("missed"), targets.count("not")
        return [*verdicts, *textwrap.wrap(f"Of {len(targets)} targets of wall time, {targets.count('met')} are met, {missed} missed and {open_yet} not tried "
                                          "([cost](paper.md#cost)).", 118)]

    def _points(self, name):
        """A list of the points whose runs are there."""
        words = [point.words(criteria.number_of(self.plan, self.measures)) for point in points_in(self.folder / "in_short.toml", name)]
        return [line for text in words if text for line in textwrap.wrap(f"- {text}", 118, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)]


def campaign_lines(pictures):
    """The table of collected campaigns in `pictures`, as far as they are there."""
    return sensitivity.lines_of([path for path in (pictures / name for name in CAMPAIGNS) if (path / "campaign.h5").is_file()])


def figure_lines(figures, missing, folder):
    """Links to the pictures of a case, {name: caption}; a line for each that is `missing`, {name: why}."""
    lines = []
    for name, caption in figures.items():
        text = f"(No picture {name}: {missing[name]}.)" if name in missing else f"![{caption}]({folder}/{name}.png)"
        lines += ["", *(textwrap.wrap(text, 118) if name in missing else [text])]
    return lines[1:]


def put_into(document, name, lines):
    """The document's text with `lines` between its marks of that name. RunError where it has none."""
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    if document.count(begin) != 1 or document.count(end) != 1:
        raise RunError(f"the document has no single pair of marks '{begin}', '{end}'")
    before, _, rest = document.partition(begin)
    return before + begin + "\n" + "\n".join(lines) + "\n" + end + rest.partition(end)[2]
