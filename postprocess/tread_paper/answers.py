"""What stands beside the criteria and may change: what a person read off figures, seen.toml, why a row differs, because.toml, and in_short.toml.

    [[seen]]                                  the answer to a row that is judged by eye
    what   = "Track behind the wheel"         of the row
    agrees = true                             whether what is seen is what the paper says
    answer = "prints at the spacing ..."      what is seen
    figure = "slip_surface.png"               of docs/paper, where it is seen

    [[because]]                               the reason why rows differ, with the experiment that shows it
    what    = ["Torque: sand", ...]           of the rows
    text    = "with 1 kPa it does {:.2f}"     with a place for each number
    measure = ["RUN ...", ...]                measures.py, each the mean of the run's repeats; none needed where the text links a page
    scale   = 1.0                             of all numbers, or [one each]

    [[does]], [[does_not]]                    a point of docs/paper_in_short.md: text, measure and scale likewise
"""

import tomllib
from dataclasses import dataclass

from tread_paper.measures import Absent
from tread_post import RunError

SEEN, BECAUSE = {"what", "agrees", "answer", "figure"}, {"what", "text", "measure", "scale"}


@dataclass(frozen=True)
class Seen:
    agrees: bool
    answer: str
    figure: str

    @property
    def text(self):
        return f"read off the figure by eye: {'agrees' if self.agrees else 'differs'}: {self.answer} ([figure](paper/{self.figure}))"


@dataclass(frozen=True)
class Because:
    text: str
    measures: tuple
    scales: tuple

    def words(self, number_of):
        """The reason with its numbers, of which `number_of` knows each. Empty where a run is not there."""
        try:
            return self.text.format(*(scale * number_of(one) for scale, one in zip(self.scales, self.measures)))
        except Absent:
            return ""


def seen_in(path):
    """Answers by the row's `what`. Empty without the file."""
    return {one["what"]: Seen(one["agrees"], one["answer"], one["figure"]) for one in _tables(path, "seen", SEEN, SEEN)}


def because_in(path):
    """Reasons by the row's `what`. Empty without the file."""
    found = {}
    for one in _tables(path, "because", BECAUSE, {"what", "text"}):
        reason = _reason(path, one)
        for what in one["what"]:
            if what in found:
                raise RunError(f"{path}: {what}: two reasons")
            found[what] = reason
    return found


def points_in(path, name):
    """Points of docs/paper_in_short.md: `does` or `does_not`."""
    return [_reason(path, one) for one in _tables(path, name, BECAUSE - {"what"}, {"text"})]


def _reason(path, table):
    measures, scale = table.get("measure", []), table.get("scale", 1.0)
    scales = scale if isinstance(scale, list) else [scale] * len(measures)
    if len(scales) != len(measures):
        raise RunError(f"{path}: {table.get('what', table['text'])}: {len(measures)} measures, {len(scales)} scales")
    return Because(table["text"], tuple(measures), tuple(scales))


def _tables(path, name, known, needed):
    if not path.is_file():
        return []
    tables = tomllib.loads(path.read_text(encoding="utf-8")).get(name, [])
    for one in tables:
        if set(one) - known or needed - set(one):
            raise RunError(f"{path}: {one.get('what')}: needs {', '.join(sorted(needed))}; may have {', '.join(sorted(known))}")
    return tables
