"""Criteria, configs/paper/round2/CASE.toml, and the tables of docs/paper.md that they judge.

A row has `what`, `paper` (what the paper says), `source` (text, table or figure), and one of

    measure = "RUN ..." or [several]      what is computed (measures.py); RUN is a run of runs.toml, of whose repeats the mean is taken
    impossible = "why"                    the paper's number cannot be; `formula` says what it should be; a measure may stand beside
    by_eye = "what to look for"           read off a figure by a person; the answer stands in seen.toml (answers.py), not here
    elsewhere = "where it is checked"     a number that needs no run of this list

and beside a measure one of these judges, each with `basis`, one sentence on where the tolerance comes from:

    expected = number or [one each]       agrees where all are within the tolerance of it
    at_least, at_most = number            agrees where all are on that side of it, to the tolerance
    order = "<" or ">"                    agrees where each differs from the one before, in that direction, by the tolerance at least; undecided within it
    equal = true                          agrees where all are within the tolerance of their mean
    shown = "why"                         not judged

`tolerance` is absolute, in `unit`; `relative` is a share of what is expected, or of the numbers' mean. Judged is with the larger of it and twice the spread of
the repeats; spread: half of what the repeats differ by. `ratio = true` judges the first measure over the second. `window` says in words what a measure's times
are and why; `unit`, `scale` and `format` are those of the numbers. `beside` names theories and `formula` is arithmetic (formulas.py), `formula_unit` its unit.
`paper_value` is the number that an impossible row's formula must contradict, by `gap` (a share, default 0.05) at least. `grid` = pull, torque or sinkage:
whose error the runs' summaries estimate. `note` stands over the table of a file.
"""

import math
import textwrap
import tomllib
from collections import Counter
from dataclasses import dataclass

from tread_paper.formulas import arithmetic
from tread_paper.measures import Absent
from tread_paper.runs import contradicted
from tread_post import RunError
from tread_post.verdict import resolution_of, text_of

CASES = ("method", "head_on", "wheel_drop", "rolling", "slip", "spirit", "curiosity", "readings")
KINDS = {"measure", "impossible", "by_eye", "elsewhere"}
JUDGES = {"expected", "at_least", "at_most", "order", "equal", "shown"}
KEYS = {"what", "paper", "source", "tolerance", "relative", "basis", "ratio", "window", "unit", "scale", "format", "beside", "formula", "formula_unit", "formula_format",
        "paper_value", "gap", "grid"} | KINDS | JUDGES
SOURCES = {"text", "table", "figure", "nothing"}
GRID = {"pull": "pull_error", "torque": "torque_error", "sinkage": "sinkage_error"}
GAP = 0.05
GRID_IS_LARGER = "the error of the grid is larger than the tolerance"
LONGEST_SET = 90  # characters of --set in a row; longer ones stand in the table of runs alone
HEAD = ("", "paper", "criterion", "independent", "here", "runs", "verdict")


def rows_of(path):
    """Rows of a case, checked. RunError where one is unsound."""
    rows = tomllib.loads(path.read_text(encoding="utf-8")).get("row", [])
    for row in rows:
        words = _unsound(row)
        if words:
            raise RunError(f"{path}: {row.get('what', 'a row without what')}: {words}")
    if len({row["what"] for row in rows}) < len(rows):
        raise RunError(f"{path}: two rows have the same what")
    return rows


def _unsound(row):
    """What is wrong with a row; empty where nothing."""
    unknown = set(row) - KEYS
    if unknown or not {"what", "paper", "source"} <= set(row) or row["source"] not in SOURCES:
        return f"needs what, paper, source of {', '.join(sorted(SOURCES))}; unknown: {', '.join(sorted(unknown)) or 'none'}"
    kinds, judges = set(row) & KINDS, set(row) & JUDGES
    if len(kinds - {"measure"}) + ("measure" in row and "impossible" not in row) != 1:
        return f"one of {', '.join(sorted(KINDS))}"
    if ("measure" in row and "impossible" not in row) != (len(judges) == 1) or len(judges) > 1:
        return "a measure has one judge, and nothing else has any"
    judged = judges - {"shown"}
    if judged and (("tolerance" in row) == ("relative" in row) or not row.get("basis")):
        return "a judge needs tolerance or relative, and basis"
    if "impossible" in row and "paper_value" in row:
        right = arithmetic(row["formula"])
        if abs(row["paper_value"] - right) <= row.get("gap", GAP) * max(abs(right), abs(row["paper_value"])):
            return f"the formula gives {right:.6g}, which does not contradict {row['paper_value']:.6g}"
    return ""


@dataclass(frozen=True)
class Number:
    """Mean of a run and its repeats; spread is half of what they differ by, None of one run; grid is the error of the grid, None where unknown."""

    mean: float
    spread: float | None
    grid: float | None

    @property
    def scatter(self):
        return self.spread or 0.0


class Table:
    """Judges rows with the runs that are there."""

    def __init__(self, plan, measures, theories, seen, because=None):
        self.plan, self.measures, self.theories, self.seen, self.because = plan, measures, theories, seen, because or {}

    def cells(self, row):
        groups = groups_of(row)
        try:
            numbers = self._numbers(row)
            absent = ""
        except Absent as missing:
            numbers, absent = [], str(missing)
        here = self._here(row, numbers) if numbers else ""
        return (row["what"], _paper_text(row), _criterion(row), self._beside(row), here, self._facts(row, groups), self._verdict(row, numbers, absent))

    def _numbers(self, row):
        """Numbers of a row. Absent where one is not there; of rows that nobody judges, where none is: those have None for it."""
        numbers, missing = [], None
        for text in measures_of(row):
            try:
                numbers.append(self._number(row, text))
            except Absent as absent:
                if "shown" not in row and "impossible" not in row:
                    raise
                missing = absent
                numbers.append(None)
        if missing and not any(numbers):
            raise missing
        return numbers

    def _number(self, row, text):
        group, _, rest = text.partition(" ")
        values, errors = [], []
        for name in self.plan.members(group):
            try:
                values.append(row.get("scale", 1.0) * self.measures(f"{name} {rest}"))
            except Absent:
                if name == group:
                    raise
                continue
            errors.append(self._own_error(row, name, values[-1]))
        mean = sum(values) / len(values)
        errors = [error for error in errors if error is not None] + self._against_coarser(row, group, rest, mean)
        return Number(mean, 0.5 * (max(values) - min(values)) if len(values) > 1 else None, max(errors) if errors else None)

    def _own_error(self, row, name, value):
        """The error that a run estimates of this number, in the row's unit; None where it estimates none."""
        if "grid" not in row:
            return None
        error = resolution_of(self.measures.run(name).summary).errors.get(GRID[row["grid"]])
        if error is None:
            return None
        if row["grid"] == "pull":
            return error * row.get("scale", 1.0) * self.measures(f"{name} weight")
        return error * abs(value)

    def _against_coarser(self, row, group, rest, mean):
        """How far the same run in larger cells is off, as a list of none or one."""
        if group not in self.plan.coarser or "expected" in row and rest.startswith(("scene", "summary")):
            return []
        try:
            return [abs(mean - row.get("scale", 1.0) * self.measures(f"{self.plan.coarser[group]} {rest}"))]
        except Absent:
            return []

    def _here(self, row, numbers):
        shape = row.get("format", "{:.3g}")
        parts = []
        for number in numbers:
            if number is None:
                parts.append("-")
                continue
            text = shape.format(number.mean)
            if number.spread is not None:
                text += f" ± {shape.format(number.spread)}"
            if number.grid is not None:
                text += f" (grid {shape.format(number.grid)})"
            parts.append(text)
        return f"{', '.join(parts)} {row.get('unit', '')}".strip()

    def _beside(self, row):
        parts = []
        if "formula" in row:
            parts.append(f"{row.get('formula_format', '{:.4g}').format(arithmetic(row['formula']))} {row.get('formula_unit', '')}".strip())
        for text in row.get("beside", []):
            try:
                parts.append(self.theories(text))
            except Absent:
                parts.append(f"{text.split()[0].replace('_', ' ')}, after the run")
        return "; ".join(parts)

    def _facts(self, row, groups):
        """Resolution, rest, commit and differences of the runs of a row."""
        parts = []
        for group in groups:
            stored = [name for name in self.plan.members(group) if self.measures.has(name)]
            asked = [rest for one, _, rest in (text.partition(" ") for text in measures_of(row)) if one == group]
            # A repeat that was stopped may not have got as far as the row asks.
            there = [name for name in stored if all(self.measures.tells(f"{name} {rest}") for rest in asked)] or stored
            if there:
                facts = [", ".join(facts_of(self.measures.run(name).summary or {})) for name in there]
                differences = _differences(self.plan.groups[group][0].set)
                wrong = [key for run in self.plan.groups[group] if run.name in there for key in contradicted(self.measures.run(run.name).scene, _of_the_scene(run.set))]
                if wrong:
                    differences += f"; **not the run of the list: {', '.join(dict.fromkeys(wrong))}**"
                repeats = f", {len(there)} of {len(self.plan.members(group))}" if len(self.plan.members(group)) > 1 else ""
                parts.append(f"{group}{repeats}: {', '.join(dict.fromkeys(facts))}{differences}")
        return "; ".join(parts)

    def _verdict(self, row, numbers, absent):
        if "by_eye" in row:
            return self.seen[row["what"]].text if row["what"] in self.seen else "not looked at yet"
        if "impossible" in row:
            return f"impossible in the paper: {row['impossible']}"
        if "elsewhere" in row:
            return f"checked elsewhere: {row['elsewhere']}"
        if absent:
            return f"not run: {absent}"
        if "shown" in row:
            return f"not judged: {row['shown']}"
        return self._judged(row, numbers)

    def _judged(self, row, numbers):
        if row.get("ratio"):
            numbers = [ratio_of(*numbers)]
        deviation, tolerance, decided = deviation_of(row, numbers)
        unit = f" {row['unit']}" if row.get("unit") and not row.get("ratio") else ""
        if not decided:
            text = f"undecided: {abs(deviation):.1f} tolerances of {tolerance:.3g}{unit} apart"
        elif deviation <= 1:
            text = "agrees"
        else:
            text = f"differs by {deviation:.1f} tolerances of {tolerance:.3g}{unit}"
        if any(number.grid is not None and number.grid > tolerance for number in numbers):
            text += f"; {GRID_IS_LARGER}"
        return f"{text}; {self._reason(row)}" if text.startswith("differs") else text

    def _reason(self, row):
        words = self.because[row["what"]].words(number_of(self.plan, self.measures)) if row["what"] in self.because else ""
        return f"because {words}" if words else "why is open"


def lines_of(cells):
    """A table of the cells of rows, in Markdown."""
    lines = [f"| {' | '.join(HEAD)} |", "|---" * len(HEAD) + "|"]
    return lines + [f"| {' | '.join(cell or ' ' for cell in row)} |" for row in cells]


def number_of(plan, measures):
    """A function of a measure's text: the mean over the repeats of its run that are there. Absent where the run itself is not."""
    def mean(text):
        group, _, rest = text.partition(" ")
        values = []
        for name in plan.members(group):
            try:
                values.append(measures(f"{name} {rest}"))
            except Absent:
                if name == group:
                    raise
        return sum(values) / len(values)
    return mean


def _of_the_scene(settings):
    """Settings without those of output, which change no bit of an answer."""
    return [one for one in settings if not one.startswith("output.")]


def _differences(settings):
    """What a run sets beside its scene, where it is short."""
    shown = _of_the_scene(settings)
    if not shown:
        return ""
    text = f"`--set {' '.join(shown)}`"
    return f"; {text}" if len(text) <= LONGEST_SET else f"; [{len(shown)} keys set](#runs)"


def measures_of(row):
    asked = row.get("measure", [])
    return [asked] if isinstance(asked, str) else asked


def groups_of(row):
    """Runs that a row asks, each once."""
    return list(dict.fromkeys(text.partition(" ")[0] for text in measures_of(row)))


def facts_of(summary):
    """Verdict of a run on its resolution, whether its bed and wheel found rest, and its commit, from its summary.json."""
    parts = [text_of(resolution_of(summary).verdict)]
    for phase in summary.get("phases", []):
        if phase.get("settled") is not None:
            parts.append("settled" if phase["settled"] else "not settled")
        if phase.get("end") in ("lowered", "not lowered") and phase["name"] == "lower":
            parts.append(phase["end"])
    if summary.get("status", "finished") != "finished":
        parts.append(summary["status"])
    return [*parts, str(summary.get("commit", "no commit"))[:8]]


def ratio_of(first, second):
    """The first number over the second, with relative errors added in quadrature."""
    def combined(one, other):
        if one is None and other is None:
            return None
        return abs(first.mean / second.mean) * math.hypot((one or 0.0) / first.mean, (other or 0.0) / second.mean)

    return Number(first.mean / second.mean, combined(first.spread, second.spread), combined(first.grid, second.grid))


def deviation_of(row, numbers):
    """(largest deviation in tolerances, that tolerance, whether anything is decided): at most 1 agrees. An order within its tolerance decides nothing."""
    if "expected" in row:
        expected = row["expected"] if isinstance(row["expected"], list) else [row["expected"]] * len(numbers)
        if len(expected) != len(numbers):
            raise RunError(f"{row['what']}: {len(numbers)} numbers, {len(expected)} expected")
        # Means of equal repeats are off by rounding.
        distances = [abs(one.mean - right) if abs(one.mean - right) > 1e-12 * abs(right) else 0.0 for one, right in zip(numbers, expected)]
        return _worst((distance, _tolerance(row, right, one.scatter)) for distance, one, right in zip(distances, numbers, expected))
    if "at_least" in row or "at_most" in row:
        bound, sign = (row["at_least"], -1) if "at_least" in row else (row["at_most"], 1)
        return _worst((max(sign * (one.mean - bound), 0.0), _tolerance(row, bound, one.scatter)) for one in numbers)
    middle = sum(one.mean for one in numbers) / len(numbers)
    if "equal" in row:
        return _worst((abs(one.mean - middle), _tolerance(row, middle, one.scatter)) for one in numbers)
    sign = 1 if row["order"] == "<" else -1
    steps = [(sign * (other.mean - one.mean), _tolerance(row, middle, math.hypot(one.scatter, other.scatter))) for one, other in zip(numbers, numbers[1:])]
    step, tolerance = min(steps, key=lambda pair: _share(*pair))
    share = _share(step, tolerance)
    if abs(share) < 1:
        return share, tolerance, False
    return (0.0 if share > 0 else -share), tolerance, True


def _worst(pairs):
    deviation, tolerance = max(pairs, key=lambda pair: _share(*pair))
    return _share(deviation, tolerance), tolerance, True


def _share(deviation, tolerance):
    """Deviation in tolerances; with a tolerance of 0 nothing but 0 agrees."""
    if tolerance > 0:
        return deviation / tolerance
    return 0.0 if deviation == 0 else math.copysign(math.inf, deviation)


def _tolerance(row, right, scatter):
    stated = row["tolerance"] if "tolerance" in row else row["relative"] * abs(right)
    return max(stated, 2 * scatter)


def _paper_text(row):
    return row["paper"] + {"figure": " (read off the figure)", "table": " (table)"}.get(row["source"], "")


def _criterion(row):
    unit = f" {row['unit']}" if row.get("unit") and not row.get("ratio") else ""
    by = f"{row['tolerance']:g}{unit}" if "tolerance" in row else f"{100 * row.get('relative', 0):g} %"
    if "expected" in row:
        expected = row["expected"] if isinstance(row["expected"], list) else [row["expected"]]
        rule = f"{', '.join(f'{value:.10g}' for value in expected)}{unit} ± {by}" if row.get("tolerance") != 0 else f"{', '.join(f'{value:.10g}' for value in expected)}{unit} exactly"
    elif "at_least" in row or "at_most" in row:
        side = "at_least" if "at_least" in row else "at_most"
        rule = f"{side.replace('_', ' ')} {row[side]:g}{unit}, to {by}"
    elif "order" in row:
        rule = f"{'rising' if row['order'] == '<' else 'falling'}, by more than {by} each"
    elif "equal" in row:
        rule = f"equal to ± {by}"
    else:
        rule = row.get("by_eye", "")
    return "; ".join(filter(None, (rule, row.get("window"), row.get("basis"))))


VERDICTS = ("agrees", "differs, because", "differs, open", "undecided", "impossible in the paper", "not run", "not judged", "checked elsewhere",
            "by eye: agrees", "by eye: differs", "not looked at yet")


def kind_of(verdict):
    """Which one of VERDICTS a cell of a table says."""
    if verdict.startswith("differs"):
        return "differs, open" if verdict.endswith("why is open") else "differs, because"
    if verdict.startswith("read off the figure by eye: "):
        return f"by eye: {verdict.split()[6].rstrip(':')}"
    return next(kind for kind in VERDICTS if verdict.startswith(kind))


def counts_of(tables):
    """Counts of verdicts: a sentence, and a table by section. `tables` are the verdicts of each title."""
    everything = [verdict for verdicts in tables.values() for verdict in verdicts]
    counts = Counter(map(kind_of, everything))
    coarse = sum(verdict.startswith("agrees") and GRID_IS_LARGER in verdict for verdict in everything)
    judged = sum(counts[kind] for kind in VERDICTS[:4])
    sentence = (f"**{len(everything)} rows, of which runs judge {judged}: {counts['agrees']} agree, {counts['differs, because'] + counts['differs, open']} differ, "
                f"{counts['undecided']} are undecided.** Of the {counts['agrees']} that agree, {coarse} have an error of the grid that is larger than their tolerance.")
    lines = [*textwrap.wrap(sentence, 118), "", f"| section | rows | {' | '.join(VERDICTS)} |", "|---" * (len(VERDICTS) + 2) + "|"]
    for title, verdicts in [*tables.items(), ("all", everything)]:
        found = Counter(map(kind_of, verdicts))
        lines.append(f"| {title} | {len(verdicts)} | {' | '.join(str(found[kind] or '') for kind in VERDICTS)} |")
    return lines
