#!/usr/bin/python3
"""Measured wheels beside tread and theories: rows of finished runs, and the page of tables and figures made of them (docs/validation.md).

    postprocess/validation.py rows cmu runs/validation/cmu --output docs/validation/cmu.csv
    postprocess/validation.py page --rows docs/validation --page docs/validation.md

`tread validate` makes the runs and calls both. Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import os
import sys
from pathlib import Path

from tread_post import RunError
from tread_validation.sets import read_sets


def make_rows(options):
    """Stores the answers of the runs of a set, of any number of campaigns or run directories; 1 if no run has any."""
    from tread_validation.rows import find_runs, row_of, store_rows

    measured_set, rows = set_named(options.set), []
    for path in find_runs(options.runs):
        try:
            rows.append(row_of(measured_set, path))
        except RunError as error:
            print(f"validation: left out: {error}", file=sys.stderr)
    if not rows:
        print(f"validation: no finished run of {options.set} in {', '.join(map(str, options.runs))}", file=sys.stderr)
        return 1
    rows.sort(key=lambda row: (row.curve, row.assumed, row.spacing, row.at, row.run))
    options.output.parent.mkdir(parents=True, exist_ok=True)
    store_rows(options.output, rows)
    print(f"{options.output}: {len(rows)} runs")
    return 0


def make_page(options):
    """Writes the figures of all sets and the tables between the marks of the page."""
    from tread_post.style import write
    from tread_validation.figures import figure_of
    from tread_validation.rows import stored_rows
    from tread_validation.tables import BEGIN, END, page_text, replaced
    from tread_validation.theories import all_predictions

    sets = chosen_sets(options.sets)
    rows = [row for name in sets if (file := options.rows / f"{name}.csv").is_file() for row in stored_rows(file)]
    pictures, folder, theories = {}, options.page.parent, all_predictions(sets)
    for name, measured_set in sets.items():
        options.rows.mkdir(parents=True, exist_ok=True)
        picture = options.rows / f"{name}.png"
        write(figure_of(measured_set, rows, theories), picture)
        pictures[name] = os.path.relpath(picture.resolve(), folder.resolve())
    page = options.page.read_text(encoding="utf-8") if options.page.is_file() else f"# Validation\n\n{BEGIN}\n{END}\n"
    try:
        text = replaced(page, page_text(sets, rows, pictures, theories))
    except ValueError as error:
        raise RunError(f"{options.page}: {error}") from error
    options.page.write_text(text, encoding="utf-8")
    print(options.page)
    return 0


def set_named(name):
    return chosen_sets([name])[name]


def chosen_sets(names):
    """{name: MeasuredSet} of the names, or of all."""
    sets = read_sets()
    for name in names:
        if name not in sets:
            raise RunError(f"no set '{name}'; there are {', '.join(sets)}")
    return {name: sets[name] for name in names or sets}


def parser():
    made = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    commands = made.add_subparsers(dest="what", required=True, metavar="COMMAND")
    rows = commands.add_parser("rows", help="store the answers of finished runs")
    rows.add_argument("set", metavar="SET")
    rows.add_argument("runs", nargs="+", type=Path, metavar="DIR", help="run directories, campaigns, or folders of both")
    rows.add_argument("--output", type=Path, required=True, metavar="FILE.csv")
    page = commands.add_parser("page", help="tables and figures from stored rows")
    page.add_argument("--rows", type=Path, required=True, metavar="DIR", help="of SET.csv files; the figures go there, too")
    page.add_argument("--page", type=Path, required=True, metavar="FILE.md")
    page.add_argument("--sets", nargs="*", default=[], metavar="SET", help="default: all")
    return made


def main():
    options = parser().parse_args()
    try:
        return {"rows": make_rows, "page": make_page}[options.what](options)
    except RunError as error:
        print(f"validation: error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
