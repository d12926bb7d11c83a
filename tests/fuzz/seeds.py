"""Writes small meshes, good and broken, as seeds for tests/fuzz/read_mesh.cpp: seeds.py FOLDER.

The first byte chooses the format: 0 = STL, 1 = OBJ.
"""

import pathlib
import struct
import sys

CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
TRIANGLES = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
             (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


def binary_stl(triangles, header=b"seed"):
    records = b"".join(struct.pack("<12fH", 0, 0, 0, *[value for corner in triangle for value in CORNERS[corner]], 0)
                       for triangle in triangles)
    return header.ljust(80) + struct.pack("<I", len(triangles)) + records


def text_stl(triangles):
    facets = "".join("facet normal 0 0 0\nouter loop\n"
                     + "".join("vertex {} {} {}\n".format(*CORNERS[corner]) for corner in triangle)
                     + "endloop\nendfacet\n" for triangle in triangles)
    return f"solid seed\n{facets}endsolid seed\n".encode()


def obj(faces):
    vertices = "".join("v {} {} {}\n".format(*corner) for corner in CORNERS)
    return (vertices + "".join(f"f {face}\n" for face in faces)).encode()


def seeds():
    turned = [TRIANGLES[0][::-1]] + TRIANGLES[1:]
    swapped = bytearray(binary_stl(TRIANGLES))
    swapped[80:84] = struct.pack(">I", len(TRIANGLES))
    huge = bytearray(binary_stl(TRIANGLES))
    huge[80:84] = b"\xff\xff\xff\xff"
    return {
        "cube.stl": b"\0" + binary_stl(TRIANGLES),
        "solid.stl": b"\0" + binary_stl(TRIANGLES, b"solid"),
        "open.stl": b"\0" + binary_stl(TRIANGLES[:-1]),
        "turned.stl": b"\0" + binary_stl(turned),
        "twice.stl": b"\0" + binary_stl(TRIANGLES + TRIANGLES[:3]),
        "swapped.stl": b"\0" + bytes(swapped),
        "huge.stl": b"\0" + bytes(huge),
        "cube.text": b"\0" + text_stl(TRIANGLES),
        "open.text": b"\0" + text_stl(TRIANGLES[:5]),
        "cube.obj": b"\1" + obj(["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"]),
        "slashes.obj": b"\1" + obj(["1/1/1 3//1 -5 2/1", "-4 -3 -1 -2 # x"]),
    }


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, data in seeds().items():
        (folder / name).write_bytes(data)
