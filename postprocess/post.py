#!/usr/bin/python3
"""The commands that read runs, studies and campaigns: `tread post` lists them, `tread post COMMAND ...` runs one.

    tread post                                # the list
    tread post wheel_history runs/quickstart  # the same as postprocess/wheel_history.py runs/quickstart

The package tread_post beside it reads runs from a script of your own: put this folder into PYTHONPATH and `from tread_post import Run`.
"""

import ast
import difflib
import importlib.util
import os
import re
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
PACKAGES = {"h5py": "python3-h5py", "numpy": "python3-numpy", "scipy": "python3-scipy", "matplotlib": "python3-matplotlib",
            "vtk": "python3-vtk9", "PIL": "python3-pil"}


def commands():
    """Path of each command by its name."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.py")) if path != FOLDER / "post.py"}


def purpose(path):
    """First sentence of a command's docstring."""
    text = " ".join((ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "").split("\n\n")[0].split())
    return re.split(r"(?<!Fig)(?<!Figs)\. ", text)[0].rstrip(".") + "."


def index():
    width = max(map(len, commands()))
    return "\n".join(f"  {name:{width}}  {purpose(path)}" for name, path in commands().items())


def imported(path):
    """Names of the modules that a file imports, wherever it does so."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module


def modules_of(path):
    """Names of the modules that a file imports, with those of the modules of this folder among them."""
    found, waiting = set(), [path]
    while waiting:
        for name in set(imported(waiting.pop())) - found:
            found.add(name)
            place = FOLDER / name.replace(".", "/")
            waiting += [local for local in (place.with_suffix(".py"), place / "__init__.py") if local.is_file()]
    return found


def missing_packages(path):
    """Debian's names of the packages that a command wants and this Python lacks."""
    tops = {name.split(".")[0] for name in modules_of(path)}
    return sorted(package for module, package in PACKAGES.items() if module in tops and importlib.util.find_spec(module) is None)


def main(arguments):
    if arguments[:1] == ["--tread"]:  # from the program, which no command of this folder runs
        arguments = arguments[2:]
    if arguments[:1] == ["--names"]:
        print(" ".join(commands()))
        return 0
    if not arguments or arguments[0] in ("-h", "--help"):
        print(f"{__doc__}\nCommands (each has --help):\n{index()}")
        return 0
    name = arguments[0].removesuffix(".py")
    if name not in commands():
        near = difflib.get_close_matches(name, commands(), 1)
        hint = f"; did you mean '{near[0]}'?" if near else ""
        print(f"post: there is no command '{name}'{hint}; accepted: {', '.join(commands())}", file=sys.stderr)
        return 2
    if lacking := missing_packages(commands()[name]):
        print(f"post: {name} wants what {sys.executable} lacks: {', '.join(lacking)} (Debian's names); TREAD_PYTHON names another Python",
              file=sys.stderr)
        return 4
    sys.stdout.flush()
    os.execv(sys.executable, [sys.executable, str(commands()[name]), *arguments[1:]])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
