#!/usr/bin/python3
"""The paper's figures of a case from our runs, and its numbers beside ours.

    postprocess/paper.py slip                     # pictures of section 3.4 and its table in docs/paper.md, from the runs kept in docs/paper/runs
    postprocess/paper.py all --runs runs          # of all sections, from runs of your own, named as their scenes
    postprocess/paper.py round2                   # tables of the second round, from studies/paper_round2 and the criteria in configs/paper/round2

Pictures whose runs or snapshots are not there stay as they are. Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import sys
from pathlib import Path

from tread_paper import round2, verdicts
from tread_paper.cases import FIGURES, TABLES_ALONE
from tread_paper.measures import Absent, Measures
from tread_paper.sensitivity import lines_of
from tread_paper.table import put_into, rows_of, table_of
from tread_post import RunError
from tread_post.style import write

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("case", choices=[*FIGURES, *TABLES_ALONE, "all"], help=f"{', '.join(TABLES_ALONE)} have tables alone")
    parser.add_argument("--runs", type=Path, default=DOCS / "paper" / "runs", metavar="DIR", help="default: docs/paper/runs")
    parser.add_argument("--round2-runs", type=Path, default=ROOT / "studies" / "paper_round2", metavar="DIR", help="of the second round; default: studies/paper_round2")
    parser.add_argument("--output", type=Path, default=DOCS / "paper", metavar="DIR", help="of pictures, where CASE.toml are; default: docs/paper")
    parser.add_argument("--document", type=Path, default=DOCS / "paper.md", metavar="FILE.md", help="whose tables are filled; default: docs/paper.md")
    return parser.parse_args()


def draw_case(case, measures, folder):
    for name, draw in FIGURES.get(case, {}).items():
        try:
            write(draw(measures), folder / f"{name}.png")
        except Absent as missing:
            print(f"{name}: {missing}")


def fill_case(case, measures, folder, document):
    rows = rows_of(folder / f"{case}.toml")
    text = put_into(document.read_text(encoding="utf-8"), case, table_of(rows, measures))
    document.write_text(text, encoding="utf-8")


def fill_sensitivity(folder, document):
    """From campaigns collected in sensitivity and sensitivity_sand, as far as they are there."""
    there = [path for path in (folder / "sensitivity", folder / "sensitivity_sand") if (path / "campaign.h5").is_file()]
    if there:
        document.write_text(put_into(document.read_text(encoding="utf-8"), "sensitivity", lines_of(there)), encoding="utf-8")


def main():
    options = arguments()
    measures = Measures(options.runs)
    for case in [*FIGURES, *TABLES_ALONE] if options.case == "all" else [options.case]:
        if case == "sensitivity":
            fill_sensitivity(options.output, options.document)
            continue
        if case == "verdicts":
            document = options.document.read_text(encoding="utf-8")
            options.document.write_text(put_into(document, case, verdicts.lines_of(options.runs)), encoding="utf-8")
            continue
        if case == "round2":
            lines = round2.lines_of(ROOT / "configs" / "paper" / "round2", options.round2_runs, ROOT)
            options.document.write_text(put_into(options.document.read_text(encoding="utf-8"), case, lines), encoding="utf-8")
            continue
        draw_case(case, measures, options.output)
        fill_case(case, measures, options.output, options.document)


if __name__ == "__main__":
    try:
        main()
    except (RunError, OSError) as error:
        sys.exit(f"paper: {error}")
