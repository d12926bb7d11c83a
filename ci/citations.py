#!/usr/bin/env python3
"""Every docs/PAGE.md#anchor cited in the sources is a heading of that page, and no page is cited that the repository lacks."""
import pathlib
import re
import sys

ROOMS = ("src", "tests", "jobs", "postprocess")
DEAD = re.compile(r"\bprototypes \d|\bverification [A-F]\d?\b|verification catalogue|\b(dem|mpm|hpc)\.md\b|\bdesign:")
DEAD_ALLOWED = ("tests",)  # until their citations point to docs


def anchors(page):
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.S)
    names = [re.sub(r"[^\w\- ]", "", line).strip().lower().replace(" ", "-") for line in re.findall(r"^#+ (.*)$", text, re.M)]
    return set(names) | set(re.findall(r'<a id="([^"]+)"', text))


bad = []
for room in ROOMS:
    for file in sorted(p for p in pathlib.Path(room).rglob("*") if p.suffix in (".hpp", ".cpp", ".cu", ".cuh", ".py")):
        for number, line in enumerate(file.read_text().splitlines(), 1):
            for page, anchor in re.findall(r"(docs/[\w/]+\.md)(?:#([\w-]+))?", line):
                path = pathlib.Path(page)
                if not path.exists() or (anchor and anchor not in anchors(path)):
                    bad.append(f"{file}:{number}: no {page}{'#' + anchor if anchor else ''}")
            if room not in DEAD_ALLOWED and DEAD.search(line):
                bad.append(f"{file}:{number}: cites what the repository lacks: {line.strip()}")
print("\n".join(bad))
sys.exit(1 if bad else 0)
