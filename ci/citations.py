#!/usr/bin/env python3
"""Checks citations: every docs/PAGE.md#anchor in the sources and every link between pages is there, and no page that is gone is cited."""
import pathlib
import re
import sys

ROOMS = ("src", "tests", "jobs", "postprocess", "studies")
SUFFIXES = (".hpp", ".cpp", ".cu", ".cuh", ".py")
DEAD = re.compile(r"\bprototypes \d|\bverification [A-F]\d?\b|verification catalogue|\b(dem|mpm|hpc)\.md\b|\bdesign:")


def anchors(page):
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
    titles = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line) for line in re.findall(r"^#+ (.*)$", text, re.M))
    return {re.sub(r"[^\w\- ]", "", title).strip().lower().replace(" ", "-") for title in titles} | set(re.findall(r'<a id="([^"]+)"', text))


def missing(page, anchor):
    return not page.exists() or (anchor and page.suffix == ".md" and anchor not in anchors(page))


def in_sources():
    for room in ROOMS:
        for file in sorted(path for path in pathlib.Path(room).rglob("*") if path.suffix in SUFFIXES):
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                for page, anchor in re.findall(r"(docs/[\w/-]+\.md)(?:#([\w-]+))?", line):
                    if missing(pathlib.Path(page), anchor):
                        yield f"{file}:{number}: no {page}{'#' + anchor if anchor else ''}"
                if DEAD.search(line):
                    yield f"{file}:{number}: cites what the repository lacks: {line.strip()}"


def in_pages():
    for page in sorted([*pathlib.Path(".").glob("*.md"), *pathlib.Path("docs").rglob("*.md")]):
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            for target, anchor in re.findall(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]*))?\)", line):
                if missing(page.parent / target if target else page, anchor):
                    yield f"{page}:{number}: no {target}{'#' + anchor if anchor else ''}"


bad = [*in_sources(), *in_pages()]
print("\n".join(bad), end="\n" if bad else "")
sys.exit(1 if bad else 0)
