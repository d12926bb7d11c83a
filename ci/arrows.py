#!/usr/bin/env python3
"""Includes point down only: each room of src names rooms of its own line or of lines below it, as ARCHITECTURE.md draws them."""
import pathlib
import re
import sys

# What a room may include, beside itself. `kernels` stands for its shared headers; sub-rooms of mpm, of dem and of solver see each other.
BELOW = {
    "base": [],
    "backend": ["base"],
    "scene": ["base"],
    "shape": ["scene", "base"],
    "kernels": ["backend"],
    "kernels/mpm": ["kernels", "backend"],
    "kernels/dem": ["kernels", "backend"],
    "kernels/contact": ["kernels/mpm", "kernels/dem", "kernels", "backend"],
    "decomp": ["kernels/mpm", "kernels/contact", "backend", "base"],
    "io": ["shape", "base"],
    "world": ["io", "kernels/mpm", "kernels/dem", "kernels/contact", "backend", "scene", "shape", "base"],
    "solver": ["world", "decomp", "io", "kernels/mpm", "kernels/dem", "kernels/contact", "backend", "scene", "shape", "base"],
    "run": ["solver", "world", "decomp", "io", "kernels/mpm", "kernels/dem", "backend", "scene", "shape", "base"],
    "python": ["run", "io", "scene", "base"],
    "": ["run", "decomp", "io", "scene", "shape", "base"],  # main.cpp
}


def room_of(folder):
    """kernels/mpm/laws is a sub-room of kernels/mpm, solver/bodies one of solver."""
    parts = folder.split("/")
    return "/".join(parts[:2]) if parts[0] == "kernels" else parts[0]


def upward(file):
    """Lines of a file that include what its room may not know."""
    room = room_of(file.parent.relative_to("src").as_posix().removeprefix("."))
    for number, line in enumerate(file.read_text().splitlines(), 1):
        included = re.match(r'#include "([\w/]+)/\w+\.\w+"', line)
        if included and room_of(included[1]) not in [room, *BELOW[room]]:
            yield f"{file}:{number}: {room or 'main'} may not include {room_of(included[1])}"


bad = [line for file in sorted(pathlib.Path("src").rglob("*")) if file.suffix in (".hpp", ".cpp", ".cu", ".cuh") for line in upward(file)]
print("\n".join(bad), end="\n" if bad else "")
sys.exit(1 if bad else 0)
