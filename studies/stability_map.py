#!/usr/bin/python3
"""Maps of the stability matrix: what each cell of two keys was. From the CSV of tests/stability/run_matrix.py.

Needs Debian's python3-matplotlib.
"""

import argparse
import ast
import math
import sys
from dataclasses import dataclass
from pathlib import Path

from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post import RunError
from tread_post.rows import read_rows
from tread_post.style import figure_grid, write

# Okabe and Ito's colours, which the colour-blind can tell apart; letters for those who see none.
OUTCOMES = {"stable": ("#009E73", ""), "told": ("#56B4E9", "t"), "stopped": ("#E69F00", "s"), "refused": ("#999999", "r"),
            "wrong": ("#D55E00", "WRONG")}
COLUMNS = 4


@dataclass(frozen=True)
class Cell:
    name: str
    map: str
    x: str
    y: str
    x_label: str
    y_label: str
    backend: str
    outcome: str
    expected: str


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("matrix", type=Path, metavar="FILE.csv", help="of run_matrix.py")
    parser.add_argument("--output", type=Path, default=Path("stability_map.png"), metavar="FILE.png", help="default: stability_map.png")
    return parser.parse_args()


def read(path):
    cells = read_rows(path, Cell, "run_matrix.py")
    if any(cell.outcome not in OUTCOMES for cell in cells):
        raise RunError(f"{path}: outcomes that are none of {', '.join(OUTCOMES)}")
    return cells


def label(text):
    """A vector by its only component, a number as short as it goes."""
    try:
        value = ast.literal_eval(text)
    except (ValueError, SyntaxError):
        return text
    value = sum(value) if isinstance(value, list) else value
    return f"{value:g}"


def draw(axis, name, cells):
    across, up = (list(dict.fromkeys(getattr(cell, key) for cell in cells)) for key in "xy")
    outcomes = list(OUTCOMES)
    codes = [[math.nan] * len(across) for _ in up]
    for cell in cells:
        column, row = across.index(cell.x), up.index(cell.y)
        codes[row][column] = outcomes.index(cell.outcome)
        mark = OUTCOMES[cell.outcome][1] + ("" if cell.expected == "yes" else "!")
        axis.text(column, row, mark, ha="center", va="center", fontsize=8)
    colours = ListedColormap([colour for colour, _ in OUTCOMES.values()])
    axis.imshow(codes, cmap=colours, vmin=-0.5, vmax=len(outcomes) - 0.5, origin="lower", aspect="auto")
    axis.set_xticks(range(len(across)), [label(x) for x in across], fontsize=7, rotation=30)
    axis.set_yticks(range(len(up)), [label(y) for y in up], fontsize=7)
    axis.set_xticks([column + 0.5 for column in range(len(across) - 1)], minor=True)
    axis.set_yticks([row + 0.5 for row in range(len(up) - 1)], minor=True)
    axis.grid(which="minor", color="white", linewidth=1.5)
    axis.tick_params(which="minor", length=0)
    axis.set_xlabel(cells[0].x_label, fontsize=8)
    axis.set_ylabel(cells[0].y_label, fontsize=8)
    axis.set_title(name, fontsize=9)


def main():
    options = arguments()
    cells = read(options.matrix)
    maps = {}
    for cell in cells:
        if cell.map:
            maps.setdefault(cell.map, []).append(cell)
    rows = math.ceil(len(maps) / COLUMNS)
    figure, axes = figure_grid(rows, COLUMNS, 4.0 * COLUMNS, 2.8)
    for axis in axes.flat[len(maps):]:
        axis.axis("off")
    for axis, (name, of_map) in zip(axes.flat, maps.items()):
        draw(axis, name, of_map)
    counts = {outcome: sum(cell.outcome == outcome for cell in cells) for outcome in OUTCOMES}
    handles = [Patch(color=OUTCOMES[outcome][0], label=f"{outcome} ({count})") for outcome, count in counts.items()]
    figure.legend(handles=handles, loc="upper right", ncols=len(handles))
    figure.suptitle(f"{len(cells)} cells and cases, backend {cells[0].backend}\n", x=0.02, ha="left")
    write(figure, options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"stability_map: {error}")
