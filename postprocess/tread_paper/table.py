"""Rows of docs/paper/CASE.toml, with what runs measured, as tables in docs/paper.md.

A row has `what` and `paper` (text), and one of

    ours = "text"                                         nothing is measured
    measure = "RUN ..." or [several], format = "..."      numbers, times `scale`, put into the format (default: {:.3g})

and at most one of these, of the first `first` numbers (default: all), from which its verdict is computed:

    within = [low, high]                                  agrees where all are in it
    expected = number or [one each], tolerance = share    agrees where all are within this share of what is expected
    order = "<", ">" or "="                               agrees where they rise, or fall; "=": equal to `tolerance`, a share of their mean
    target = number                                       met where the first is at most that
    by_eye = "text"                                       read off figures by a person: the cell says so

`otherwise` follows a verdict that is not "agrees"; `remark` follows any, and stands alone, as "not judged", where nothing is computed. No remark may say
"agrees" or "differs".
"""

import re
import tomllib

from tread_paper.measures import Absent
from tread_post.run import RunError

JUDGES = {"within", "expected", "order", "target", "by_eye"}
KEYS = {"what", "paper", "ours", "measure", "format", "scale", "first", "tolerance", "otherwise", "remark"} | JUDGES
TYPED = re.compile(r"\b(agree|differ)(s|ed)?\b")


def rows_of(path):
    """Tables of rows of a case, checked."""
    rows = tomllib.loads(path.read_text(encoding="utf-8")).get("row", [])
    for number, row in enumerate(rows, 1):
        unknown = set(row) - KEYS
        if unknown or not {"what", "paper"} <= set(row) or ("ours" in row) == ("measure" in row):
            raise RunError(f"{path}: row {number}: needs what, paper, and ours or measure; unknown: {', '.join(sorted(unknown)) or 'none'}")
        judges = set(row) & JUDGES
        if len(judges) > 1:
            raise RunError(f"{path}: row {number}: {', '.join(sorted(judges))}: at most one")
        if judges - {"by_eye"} and "measure" not in row:
            raise RunError(f"{path}: row {number}: {judges.pop()} judges what is measured, and nothing is")
        if ("expected" in row or row.get("order") == "=") != ("tolerance" in row):
            raise RunError(f"{path}: row {number}: tolerance belongs to expected, and to order = \"=\"")
        if TYPED.search(row.get("remark", "")):
            raise RunError(f"{path}: row {number}: the remark says what only a computed verdict may: {row['remark']}")
    return rows


class _Missing:
    """A number that is not there yet, in any format."""

    def __format__(self, _):
        return "-"


def measured(row, measures):
    """(text, the numbers that the row judges and that are there, times its scale) of a row."""
    if "ours" in row:
        return row["ours"], []
    asked = [row["measure"]] if isinstance(row["measure"], str) else row["measure"]
    numbers, missing = [], []
    for text in asked:
        try:
            numbers.append(row.get("scale", 1.0) * measures(text))
        except Absent as absent:
            numbers.append(_Missing())
            missing.append(str(absent))
    there = [number for number in numbers[:row.get("first", len(numbers))] if not isinstance(number, _Missing)]
    if len(missing) == len(asked):
        return f"not measured: {missing[0]}", []
    return row.get("format", ", ".join(["{:.3g}"] * len(numbers))).format(*numbers), there


def verdict_of(row, numbers):
    """Verdict on the numbers that exist; an order needs two."""
    remark = row.get("remark", "")
    if "by_eye" in row:
        return f"read off by eye: {row['by_eye']}"
    if not set(row) & JUDGES:
        return f"not judged: {remark}" if remark else ""
    if not numbers or ("order" in row and len(numbers) < 2):
        return "open"
    agrees, rule = _judged(row, numbers)
    word = ("met" if agrees else "missed") if "target" in row else "agrees" if agrees else "differs"
    parts = [f"{word} [{rule}]", *([] if agrees else [re.sub(r"^differs[:;,]? ?", "", row.get("otherwise", ""))]), remark]
    return "; ".join(filter(None, parts))


def _judged(row, numbers):
    """(whether the numbers agree, by which rule)"""
    if "within" in row:
        low, high = row["within"]
        return all(low <= number <= high for number in numbers), f"{low:g} to {high:g}"
    if "target" in row:
        return numbers[0] <= row["target"], f"at most {row['target']:g}"
    tolerance = row.get("tolerance", 0.0)
    if "expected" in row:
        expected = row["expected"] if isinstance(row["expected"], list) else [row["expected"]] * len(numbers)
        rule = f"{', '.join(f'{value:g}' for value in dict.fromkeys(expected))} within {100 * tolerance:g} %"
        return len(expected) == len(numbers) and all(abs(one - value) <= tolerance * abs(value) for one, value in zip(numbers, expected)), rule
    if row["order"] == "=":
        mean = sum(numbers) / len(numbers)
        return all(abs(number - mean) <= tolerance * abs(mean) for number in numbers), f"equal to {100 * tolerance:g} %"
    pairs = list(zip(numbers, numbers[1:]))
    rises = row["order"] == "<"
    return all(one < other if rises else one > other for one, other in pairs), "rising" if rises else "falling"


def table_of(rows, measures):
    """Lines of Markdown."""
    lines = ["| | paper | here | verdict |", "|---|---|---|---|"]
    for row in rows:
        text, numbers = measured(row, measures)
        lines.append(f"| {row['what']} | {row['paper']} | {text} | {verdict_of(row, numbers)} |")
    return lines


def put_into(document, name, lines):
    """The document's text with `lines` between its marks of that name. RunError where it has none."""
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    if document.count(begin) != 1 or document.count(end) != 1:
        raise RunError(f"the document has no single pair of marks '{begin}', '{end}'")
    before, _, rest = document.partition(begin)
    return before + begin + "\n" + "\n".join(lines) + "\n" + end + rest.partition(end)[2]
