"""Writes triangles for ParaView: PolyData of VTK's XML formats, and collections of them over time. Layout:
https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html and, of compressed data, https://vtk.org/Wiki/VTK_XML_Formats
"""

import os
import struct
import zlib
from xml.sax.saxutils import quoteattr

import numpy as np

BLOCK = 1 << 20  # bytes that are compressed at once
TYPES = {np.dtype(np.float32): "Float32", np.dtype(np.float64): "Float64", np.dtype(np.int32): "Int32", np.dtype(np.uint8): "UInt8"}


def write_triangles(path, time, vertices, triangles, cell_fields, names=()):
    """Writes `vertices` [v, 3] (m) and `triangles` [t, 3] at `time` (s), with fields [t] or [t, components] by name, and `names`, texts that the
    data set keeps. The file gets its name once it is complete."""
    appended = _Appended()
    polys = [appended.array("connectivity", triangles.astype(np.int32).ravel()),
             appended.array("offsets", np.arange(3, 3 * len(triangles) + 1, 3, dtype=np.int32))]
    cells = [appended.array(name, values) for name, values in cell_fields.items()]
    points = appended.array("Points", vertices)
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">', "<PolyData>",
        f'<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{time!r}</DataArray>{_texts("name", names)}</FieldData>',
        f'<Piece NumberOfPoints="{len(vertices)}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="{len(triangles)}">',
        f"<Points>{points}</Points>", f'<Polys>{"".join(polys)}</Polys>', f'<CellData>{"".join(cells)}</CellData>',
        "</Piece>", "</PolyData>", '<AppendedData encoding="raw">', "_"]
    _write(path, ["\n".join(lines).encode(), *appended.parts, b"\n</AppendedData>\n</VTKFile>\n"])


def write_collection(path, files):
    """Writes a .pvd that lists (time in s, name of a file beside it)."""
    rows = [f"<DataSet timestep={quoteattr(repr(time))} part=\"0\" file={quoteattr(name)}/>\n" for time, name in files]
    text = ('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n<Collection>\n'
            f'{"".join(rows)}</Collection>\n</VTKFile>\n')
    _write(path, [text.encode()])


class _Appended:
    """Arrays behind the XML, each a header of sizes and its compressed blocks."""

    def __init__(self):
        self.parts, self.size = [], 0

    def array(self, name, values):
        """Appends an array and returns the element that describes it."""
        values = np.ascontiguousarray(values)
        data = values.astype(values.dtype.newbyteorder("<"), copy=False).tobytes()
        blocks = [zlib.compress(data[start:start + BLOCK], 1) for start in range(0, len(data), BLOCK)]
        header = struct.pack(f"<{3 + len(blocks)}Q", len(blocks), BLOCK, len(data) % BLOCK, *map(len, blocks))
        components = values.shape[1] if values.ndim == 2 else 1
        element = (f'<DataArray type="{TYPES[values.dtype]}" Name={quoteattr(name)} NumberOfComponents="{components}" format="appended" '
                   f'offset="{self.size}"/>')
        self.parts += [header, *blocks]
        self.size += len(header) + sum(map(len, blocks))
        return element


def _texts(name, texts):
    codes = " ".join(str(code) for text in texts for code in (*text.encode(), 0))
    return f'<Array type="String" Name={quoteattr(name)} NumberOfTuples="{len(texts)}" format="ascii">{codes}</Array>' if texts else ""


def _write(path, parts):
    partial = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        with open(partial, "wb") as file:
            file.writelines(parts)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)
