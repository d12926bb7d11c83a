"""Writes small files, good and broken, as seeds for a target of ci/fuzz: seeds.py TARGET FOLDER.

Of meshes and height maps the first byte chooses the format: 0 = STL or PGM, 1 = OBJ or CSV. Of scenes what stands before
the first zero byte is a --set.
"""

import pathlib
import struct
import sys
import tempfile

import h5py
import numpy

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]

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


def meshes():
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
        # Ten coplanar faces over each other, and a spike: their overlap was bisected all over, for 40 s.
        "covered.obj": b"\1v 0 0 0\nv 1 0 1\n\nv 5 1 6\nv 2 0 1\nv 5 1 6\nv 0 1 1\nf 1 2 3 6\nf 1 3 4 5\nf 6 5 4 1\n",
        "slashes.obj": b"\1" + obj(["1/1/1 3//1 -5 2/1", "-4 -3 -1 -2 # x"]),
    }


def scenes():
    text = (REPOSITORY / "configs" / "quickstart.toml").read_bytes()
    small = b'title = "t"\n[domain]\nsize = [1.0, 1.0, 1.0]\ngravity = [0.0, 0.0, -9.8]\n'
    settings = ["domain.gravity=[0, 0, -3.7]", "material.sand.young=1e6", "material[0].young=2e6", "title=bare word",
                "grid.spacing=nan", "phase[99].duration=1", "a.b.c.d=1", "=", "x", "output.every={}"]
    seeds = {f"set{i}": setting.encode() + b"\0" + text for i, setting in enumerate(settings)}
    seeds.update({f"file{i}": path.read_bytes() for i, path in enumerate(sorted((REPOSITORY / "configs").glob("*.toml")))})
    foreign = small + b"x = '\xfdR'\n"  # the parser would read past the string's end
    return {**seeds, "small": small, "foreign": foreign, "nested": small + b"x = " + b"[" * 200 + b"]" * 200, "brace": small + b"y = { a = 1\n"}


def rasters():
    return {
        "plain.pgm": b"\0P2\n# a remark\n3 2\n255\n0 128 255\n1 2 3\n",
        "raw.pgm": b"\0P5 2 2 255\n\x00\x80\xff\x01",
        "wide.pgm": b"\0P5 2 2 65535\n" + bytes(range(8)),
        "huge.pgm": b"\0P5 99999999 99999999 255\n",
        "heights.csv": b"\1# x, y\n0.1, 0.2, 0.3\n1e-3,-2,+3\n",
        "ragged.csv": b"\11,2\n3\n",
        "words.csv": b"\1a,b\nnan,inf\n",
    }


def bed(change=lambda file: None):
    """A bed of two rocks in contact, with three points of sand, as tread writes one."""
    columns = {"rocks": {"kind": ("i4", [0, 0]), "position": ("f8", numpy.ones((2, 3))), "orientation": ("f8", [[1, 0, 0, 0]] * 2),
                         "scale": ("f8", [1, 2]), "diameter": ("f8", [0.1, 0.2])},
               "contacts": {"pair": ("i4", [[0, 1]]), **{name: ("f8", numpy.ones((1, 3))) for name in ("tangential", "normal", "place", "rolling")},
                            **{name: ("f8", [1.0]) for name in ("torsion", "stiffness", "twist_stiffness", "rolling_stiffness")}},
               "points": {"material": ("i4", [0, 0, 0]), "position": ("f8", numpy.ones((3, 3))), "volume": ("f8", [1, 1, 1]),
                          "mass": ("f8", [1, 1, 1]), "stress": ("f8", numpy.zeros((3, 6))), "plastic_shear": ("f8", [0, 0, 0])}}
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "bed.h5"
        with h5py.File(path, "w") as file:
            file.attrs["format"] = "tread bed 1"
            for group, texts in (("kinds/0", {"shape": "clast", "member": "clast", "material": "rock", "inertia": 1.0}), ("materials/0", {"name": "sand"})):
                file.create_group(group).attrs.update({**texts, "density": 2700.0, "young": 1e6, "poisson": 0.3})
            for group, members in columns.items():
                for name, (kind, values) in members.items():
                    file.create_dataset(f"{group}/{name}", data=numpy.asarray(values, dtype=kind))
            file["points"].attrs["grid_spacing"] = 0.05
            change(file)
        return path.read_bytes()


def beds():
    def put(name, value):
        def change(file):
            file[name][0] = value
        return change

    def link(name, target):
        def change(file):
            del file[name]
            file[name] = target
        return change

    def declare(file):
        del file["points/mass"]
        file.create_dataset("points/mass", shape=(10**12,), dtype="f8")

    return {
        "good": bed(), "kind": bed(put("rocks/kind", 7)), "nan": bed(put("rocks/scale", float("nan"))), "pair": bed(put("contacts/pair", (1, 99))),
        "soft": bed(link("rocks/scale", h5py.SoftLink("/rocks/diameter"))),
        "external": bed(link("rocks/scale", h5py.ExternalLink("/dev/zero", "/x"))), "declared": bed(declare),
    }


def tables():
    return {
        "good": b"time,v\n0,1\n1,2\n3,-1\n", "spaces": b" time , w, v\n0, 0, 1\n2.5,1 , 2\n", "short": b"time,v\n0,1\n1,2\n",
        "back": b"time,v\n0,1\n1,2\n1,3\n", "wide": b"time,v\n-1e308,1\n1e308,2\n", "ragged": b"time,v\n0,1\n1\n", "nan": b"time,v\n0,nan\n9,1\n",
    }


def edits(first=b""):
    """Changes as edited_file.cpp reads them: kind, object, place, eight bytes of value."""
    values = [struct.pack("<d", value) for value in (float("nan"), float("inf"), 0.0, -1.0, 1e300, 1e-300, 0.5)]
    values += [struct.pack("<ff", value, value) for value in (float("nan"), -1.0, 1e30)]
    values += [struct.pack("<q", value) for value in (0, 1, -1, 2**31 - 1, -2**31, 2**63 - 1, 100)]
    seeds = {f"value{i}": struct.pack("<BHH", 0, i, i) + value for i, value in enumerate(values)}
    for kind in range(5, 32):
        seeds[f"kind{kind}"] = b"".join(struct.pack("<BHHQ", kind, thing, thing, thing) for thing in (0, 3, 7))
    return {name: first + seed for name, seed in seeds.items()}


def edits_of_scenes():
    return {f"{name}of{scene}": seed for scene in range(3) for name, seed in edits(bytes([scene])).items()}


SEEDS = {"edit_bed": edits, "edit_checkpoint": edits_of_scenes, "read_mesh": meshes, "read_scene": scenes, "read_raster": rasters, "read_bed": beds, "read_table": tables}

if __name__ == "__main__":
    target, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    for name, data in SEEDS[target]().items():
        (folder / name).write_bytes(data)
