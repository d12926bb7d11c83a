#!/usr/bin/env python3
"""Checks the weight and form of the docs: at most 6 MB, no file over 300 kB, pages linked from README, lines of 120 columns,
and that lines of code which a page names, `scene/load.cpp:202`, `load_scene`, have that name."""
import pathlib
import re
import sys

MOST, MOST_EACH, COLUMNS = 6_000_000, 300_000, 120
GENERATED = ("docs/scene.md",)  # written by unit_scene


def too_long(page):
    """Lines over COLUMNS outside tables."""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if len(line) > COLUMNS and not line.lstrip().startswith("|"):
            yield f"{page}:{number}: {len(line)} columns"


def astray(page):
    """Names that do not stand in the line of src that the page gives for them."""
    for place, number, name in re.findall(r"`([\w/]+\.\w+):(\d+)`, `(\w+)`", page.read_text(encoding="utf-8")):
        source = pathlib.Path("src") / place
        lines = source.read_text(encoding="utf-8").splitlines() if source.exists() else []
        if name not in "".join(lines[int(number) - 1:int(number)]):
            yield f"{page}: {source}:{number} has no {name}"


files = sorted(path for path in pathlib.Path("docs").rglob("*") if path.is_file())
pages = [*pathlib.Path(".").glob("*.md"), *(path for path in files if path.suffix == ".md")]
readme = pathlib.Path("README.md").read_text(encoding="utf-8")
linked = {(pathlib.Path(target)).as_posix().rstrip("/") for target in re.findall(r"\]\(([^)#\s]+)", readme)}

bad = [f"{path}: {path.stat().st_size} bytes; at most {MOST_EACH}" for path in files if path.stat().st_size > MOST_EACH]
total = sum(path.stat().st_size for path in files)
if total > MOST:
    bad.append(f"docs: {total} bytes; at most {MOST}")
bad += [f"README.md links no {page}" for page in pages if page.parent.name == "docs" and page.as_posix() not in linked]
bad += [line for page in pages if page.as_posix() not in GENERATED for line in too_long(page)]
bad += [line for page in pages for line in astray(page)]
print("\n".join(bad), end="\n" if bad else "")
sys.exit(1 if bad else 0)
