#!/usr/bin/python3
"""A picture of meshes, side by side and to one scale, each with its name and size.

Takes STL and OBJ in metres, as `tread sdf --write-stl` writes them. Needs Debian's python3-numpy and python3-vtk9, and
xvfb where there is no display.
"""

import argparse
import sys
from pathlib import Path

from tread_post import RunError
from tread_post.display import ensure_display


def at_least_one(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text}: at least 1")
    return number


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("meshes", type=Path, nargs="+", metavar="MESH", help="STL or OBJ, metres")
    parser.add_argument("--output", type=Path, required=True, metavar="FILE.png")
    parser.add_argument("--columns", type=at_least_one, metavar="N", help="default: up to four")
    parser.add_argument("--width", type=at_least_one, default=1600, metavar="W", help="pixels; default: 1600")
    return parser.parse_args()


def main():
    options = arguments()
    ensure_display()
    from tread_post.gallery import draw_shapes, read_shape

    shapes = [read_shape(path) for path in options.meshes]
    draw_shapes(shapes, options.columns or min(4, len(shapes)), options.output, options.width)
    print(options.output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"shapes: {error}")
