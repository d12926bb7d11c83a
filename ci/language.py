#!/usr/bin/env python3
"""Checks words: names and phrases that the field has better words for, and docstrings that open without a verb or a noun."""
import pathlib
import re
import sys

ROOMS = ("src", "tests", "jobs", "postprocess", "studies", "ci")
SUFFIXES = (".hpp", ".cpp", ".cu", ".cuh", ".py")
# A pattern of what is gone, and the word to use.
GONE = (
    (r"^(class|struct) Moment\b", "Event"),
    (r"\bSecondLane\b", "SecondaryStream"),
    (r"\b(told|asked|ask)_\w*", "pending_*, *_on_host, request_*"),
    (r"\b(Strays?|strays|look_ahead|unwatched_\w+)\b", "DisplacementTracker, excess displacement, *_without_check"),
    (r"\b(Letters?|Parcels?)\b(?=[<&{>])", "Message, MessageBuffer, packed rows"),
    (r"\bTerritory\b", "PageOwnership"),
    (r"\b(deal|dealt|deals) out\b", "partition, repartition, assign"),
    (r"\b[Bb]ooks\b|\bBooksOf\w*", "ledger, energy balance"),
    (r"\bheed\w*", "apply"),
    (r"\b(look_outside|look_up\w*|look_who_\w+|look_within_\w+)\b", "check_*, update_*, evaluate_*, find_*"),
    (r"\b(grant_travel|travel_bound)\b", "allow_displacement, displacement_bound"),
    (r"\b(Patience|patience)\b", "timeout, attempts"),
    (r"\b(Said|said_|say_\w+)\b", "log_*, messages"),
    (r"\bgive_back\b", "release_memory"),
    (r"\brole_guest\b", "role_ghost"),
    (r"\b(book_\w+|booked\w*|unbooked)\b", "account_*, tally_*"),
    (r"\b(more_travel|travel_of|\w*wanted_travel|reach_of)\b", "allowed displacement, search radius"),
)
BARE = re.compile(r'^\s*(?:///|(?:\w+ )?""")\s*(Of|Those|As|By)\b')


def gone(line):
    """Words of a line that are gone, each with its replacement."""
    for pattern, instead in GONE:
        found = re.search(pattern, line)
        if found:
            yield f'"{found[0]}": say {instead}'


def complaints(path):
    """Complaints about a source file."""
    before = ""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        for complaint in gone(line):
            yield f"{path}:{number}: {complaint}"
        opener = BARE.match(line)
        if opener and not before.lstrip().startswith("///"):
            yield f'{path}:{number}: a docstring opens with "{opener[1]}": begin with a verb or a noun'
        before = line


files = (path for room in ROOMS for path in sorted(pathlib.Path(room).rglob("*")) if path.suffix in SUFFIXES)
bad = [line for path in files if path != pathlib.Path("ci/language.py") for line in complaints(path)]
print("\n".join(bad), end="\n" if bad else "")
sys.exit(1 if bad else 0)
