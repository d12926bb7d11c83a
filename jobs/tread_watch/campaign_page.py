"""The page of a campaign: how many cases are in which state, and a table of them all."""

from collections import Counter
from functools import lru_cache

from tread_jobs.files import printable
from tread_jobs.status import DONE, FAILED, STATES, case_states, read_summary
from tread_jobs.submission import past_submissions
from tread_post.page import Markup, headline_paragraph, paragraph, section, table
from tread_post.run import DAMAGE, words_of
from tread_post.verdict import headline, resolution_of, text_of
from tread_watch.progress import inside, state_of
from tread_watch.run_page import last_answer, mean_text

SHOWN = ("pull", "torque", "sinkage")
QUIET_FOR = 900  # s


def campaign_parts(directory):
    """(short text of the progress, pieces of HTML) of a campaign's directory."""
    states, entries = case_states(directory, QUIET_FOR), directory.entries()
    counts = Counter(one.state for one in states.values())
    share = counts[DONE] / max(1, len(entries))
    axes = list(dict.fromkeys(name for entry in entries for name in entry.labels))
    rows, verdicts = [], []
    for entry in entries:
        state = states[entry.name]
        verdict, *cells = _cells(directory.cases / entry.name, state.state)
        verdicts += [verdict] if state.state in (DONE, FAILED) else []
        labels = [printable(entry.labels.get(name, "")) for name in axes]
        rows.append([Markup(f'<a href="case/{entry.name}/">{entry.name}</a>'), state.state, *labels, *cells, state.reason])
    kinds = [f"state-{row[1].replace(' ', '-')}" for row in rows]
    told = headline_paragraph(", ".join(f"{counts[state]} {state}" for state in STATES if counts[state]))
    parts = [told, f'<progress max="1" value="{share:.4f}"></progress>', paragraph(headline(verdicts)) if verdicts else "",
             section("Cases", table(("case", "state", *map(printable, axes), "progress", "verdict", *SHOWN, "note"), rows, kinds))]
    return f"{counts[DONE]} of {len(entries)}", parts


def pause_of(directory):
    """s between two looks at a campaign: SLURM is not to be asked more often."""
    return 30 if any("job" in how for _, _, how in past_submissions(directory)) else 2


def _cells(case, state):
    """(verdict, progress, text of the verdict, the answers SHOWN) of a case."""
    nothing = [""] * len(SHOWN)
    if state == DONE:
        path = inside(case / "run", "summary.json")
        facts = path.stat() if path else None
        return _ended(case, facts and facts.st_mtime_ns)
    if state == FAILED:
        return [FAILED, "", "", *nothing]
    progress = state_of(case / "run").progress
    return ["", f"{progress.percent}, {progress.left} left" if progress and state == "running" else "", "", *nothing]


@lru_cache(maxsize=100_000)
def _ended(case, _written):
    """_cells of a finished case, whose summary was written at that time."""
    try:
        summary = read_summary(case) or {}
        verdict, entry = resolution_of(summary).verdict, last_answer(summary)
        return [verdict, "", printable(text_of(verdict)), *(printable(mean_text(entry, name)) for name in SHOWN)]
    except DAMAGE as error:
        return ["", "", printable(f"cannot be read: {words_of(error)}"), *[""] * len(SHOWN)]
