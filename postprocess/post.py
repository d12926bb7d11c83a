#!/usr/bin/python3
"""The commands that read runs, studies and campaigns: `post.py` lists them, `post.py COMMAND ...` runs one.

    postprocess/post.py                                # the list
    postprocess/post.py wheel_history runs/quickstart  # the same as postprocess/wheel_history.py runs/quickstart

The package tread_post beside it reads runs from a script of your own: put this folder into PYTHONPATH and `from tread_post import Run`.
"""

import ast
import os
import re
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent


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


def main(arguments):
    if not arguments or arguments[0] in ("-h", "--help"):
        print(f"{__doc__}\nCommands (each has --help):\n{index()}")
        return 0
    name = arguments[0].removesuffix(".py")
    if name not in commands():
        print(f"post: no command '{name}'; there are {', '.join(commands())}", file=sys.stderr)
        return 2
    sys.stdout.flush()
    os.execv(sys.executable, [sys.executable, str(commands()[name]), *arguments[1:]])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
