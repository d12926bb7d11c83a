#!/usr/bin/python3
"""The paper's numbers beside ours and its figures from our runs: docs/paper.md.

    postprocess/paper.py all                      # every table and picture of docs/paper.md and paper_in_short.md, from the runs in studies/paper_round2
    postprocess/paper.py slip                     # table and pictures of section 3.4
    postprocess/paper.py slip --tread build/cpu-release/bin/tread             # and the picture of its set-up, from states that the program makes anew
    postprocess/paper.py slip --runs runs --output . --document mine.md       # the same from runs of your own, named as in configs/paper/round2/runs.toml

The criteria are configs/paper/round2/CASE.toml. A picture whose runs or snapshots are not there is removed, and the page says why; that of a set-up stays
as it is without --tread. Needs Debian's python3-h5py, python3-numpy and python3-matplotlib, for set-ups also python3-vtk9, and xvfb where there is no display.
"""

import argparse
import sys
from pathlib import Path

from tread_paper.cases import FIGURES
from tread_paper.document import IN_SHORT, OTHERS, TITLES, Document, campaign_lines, figure_lines, put_into
from tread_paper.measures import Absent
from tread_paper.setups import SETUPS, figure_of
from tread_post import RunError
from tread_post.display import ensure_display
from tread_post.style import pack_picture, write, write_shaded

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("case", choices=[*TITLES, *OTHERS, "sensitivity", "in_short", "all"])
    parser.add_argument("--runs", type=Path, default=ROOT / "studies" / "paper_round2", metavar="DIR", help="default: studies/paper_round2")
    parser.add_argument("--output", type=Path, default=DOCS / "paper", metavar="DIR", help="of pictures; default: docs/paper")
    parser.add_argument("--document", type=Path, default=DOCS / "paper.md", metavar="FILE.md", help="whose parts are filled; default: docs/paper.md")
    parser.add_argument("--in-short", type=Path, default=DOCS / "paper_in_short.md", metavar="FILE.md", help="likewise; default: docs/paper_in_short.md")
    parser.add_argument("--tread", type=Path, metavar="PROGRAM", help="draws the set-ups of the case anew, of all in about a quarter of an hour on two cores")
    return parser.parse_args()


def drawn(case, paper, folder, program=None):
    """Draws a case's pictures, those of set-ups only with a `program`. Returns lines that link them."""
    setups, missing = SETUPS.get(case, {}), {}
    for name, setup in setups.items():
        path = folder / f"{name}.png"
        if program:
            write_shaded(figure_of(setup, program, ROOT / "configs" / "paper"), path)
        elif not path.is_file():
            missing[name] = "drawn with --tread PROGRAM"
    for name, (_, draw) in FIGURES[case].items():
        path = folder / f"{name}.png"
        try:
            write(draw(paper), path)
            pack_picture(path)
        except Absent as absent:
            missing[name] = str(absent)
            path.unlink(missing_ok=True)
            print(f"{name}: {absent}")
    captions = {name: setup.caption for name, setup in setups.items()} | {name: caption for name, (caption, _) in FIGURES[case].items()}
    return figure_lines(captions, missing, folder.name)


def main():
    options = arguments()
    if options.tread:
        ensure_display()
    paper = Document(ROOT / "configs" / "paper" / "round2", options.runs, ROOT)
    text = options.document.read_text(encoding="utf-8")
    for name in [*TITLES, *OTHERS, "sensitivity"] if options.case == "all" else {options.case} - {"in_short"}:
        text = put_into(text, name, campaign_lines(DOCS / "paper") if name == "sensitivity" else paper.part(name))
        if name in FIGURES:
            text = put_into(text, f"figures of {name}", drawn(name, paper, options.output, options.tread))
    options.document.write_text(text, encoding="utf-8")
    if options.case in ("in_short", "all"):
        short = options.in_short.read_text(encoding="utf-8")
        for name in IN_SHORT:
            short = put_into(short, name, paper.part(name))
        options.in_short.write_text(short, encoding="utf-8")


if __name__ == "__main__":
    try:
        main()
    except (RunError, OSError) as error:
        sys.exit(f"paper: {error}")
