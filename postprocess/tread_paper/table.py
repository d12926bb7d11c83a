"""Rows of docs/paper/CASE.toml, with what runs measured, as tables in docs/paper.md.

A row has `what` and `paper` (text), and one of

    ours = "text"                                         nothing is measured
    measure = "RUN ..." or [several], format = "..."      numbers, times `scale`, put into the format (default: {:.3g})
and
    verdict = "text"                                      whatever came out
    within = [low, high], otherwise = "text"              "agrees" where all numbers (times `scale`) are in it
    order = "<" or ">", otherwise = "text"                "agrees" where the numbers rise, or fall
"""

import tomllib

from tread_paper.measures import Absent
from tread_post.run import RunError

KEYS = {"what", "paper", "ours", "measure", "format", "scale", "verdict", "within", "order", "otherwise"}


def rows_of(path):
    """Tables of rows of a case, checked."""
    rows = tomllib.loads(path.read_text(encoding="utf-8")).get("row", [])
    for number, row in enumerate(rows, 1):
        unknown = set(row) - KEYS
        if unknown or not {"what", "paper"} <= set(row) or ("ours" in row) == ("measure" in row):
            raise RunError(f"{path}: row {number}: needs what, paper, and ours or measure; unknown: {', '.join(sorted(unknown)) or 'none'}")
        if len(set(row) & {"verdict", "within", "order"}) != 1:
            raise RunError(f"{path}: row {number}: needs one of verdict, within, order")
    return rows


class _Missing:
    """A number that is not there yet, in any format."""

    def __format__(self, _):
        return "-"


def measured(row, measures):
    """(text, the numbers that are there, times the row's scale) of a row."""
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
    there = [number for number in numbers if not isinstance(number, _Missing)]
    if not there:
        return f"not measured: {missing[0]}", []
    return row.get("format", ", ".join(["{:.3g}"] * len(numbers))).format(*numbers), there


def verdict_of(row, numbers):
    """Of the numbers that are there; an order needs two."""
    if "verdict" in row:
        return row["verdict"]
    if not numbers or ("order" in row and len(numbers) < 2):
        return "open"
    if "within" in row:
        low, high = row["within"]
        agrees = all(low <= number <= high for number in numbers)
    else:
        pairs = list(zip(numbers, numbers[1:]))
        agrees = all(one < other if row["order"] == "<" else one > other for one, other in pairs)
    return "agrees" if agrees else row.get("otherwise", "differs")


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
