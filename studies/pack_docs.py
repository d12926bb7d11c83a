#!/usr/bin/python3
"""Packs what docs/ and studies/ keep: runs as small time series, tables by gzip, pictures with few colours.

    studies/pack_docs.py runs studies/paper_round2  # time series: rounded, equal columns of time once, no energies; snapshots rounded; summaries without spaces
    studies/pack_docs.py tables docs/studies        # CSV of more than 6 kB
    studies/pack_docs.py pictures docs              # PNG

`postprocess/paper.py all` gives the same tables from packed runs; run it after packing and look at `git diff docs/paper.md`. It packs its own pictures.
Needs Debian's python3-h5py, python3-numpy, python3-matplotlib and python3-pil.
"""

import argparse
import gzip
import json
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))

from tread_post.style import pack_picture

BITS, PLACE_BITS = 10, 17  # of the mantissa: relative errors of 5e-4, and of 4e-6 for places and sinkage
FINER = ("head_on", "wheel_drop_substeps")  # runs whose tables show four to five digits: 17 bits everywhere
WITH_ENERGY = ("head_on",)  # runs whose figures show energies and momentum
SNAPSHOT_BITS = {"displacement": 8, "plastic_rate": 8, "plastic_shear": 8}  # of their values, in colours; of places and shapes 13: 0.1 mm in a metre


def rounded(values, bits):
    """The values with a mantissa of `bits` bits, so that they compress."""
    dropped = 23 - bits
    if dropped <= 0 or values.dtype != np.float32:
        return values
    whole = np.ascontiguousarray(values).view(np.uint32).astype(np.uint64)
    near = (((whole + (1 << (dropped - 1))) >> dropped) << dropped).astype(np.uint32).view(np.float32)
    return np.where(np.isfinite(values), near, values)


def pack_run(path):
    """Rewrites a timeseries.h5 in place."""
    name = path.parent.name
    packed = path.with_suffix(".packed")
    seen = {}
    with h5py.File(path, "r") as source, h5py.File(packed, "w", libver=("v110", "v110")) as target:
        target.attrs.update(source.attrs)

        def copy(key, item):
            if key.split("/")[0] in ("energy", "balance") and not name.startswith(WITH_ENERGY):
                return
            if isinstance(item, h5py.Group):
                target.require_group(key).attrs.update(item.attrs)
                # Not visititems: it leaves out the columns that are links to one seen before, as all times of a packed file are.
                for below, part in item.items():
                    copy(f"{key}/{below}", part)
                return
            values, column = item[:], key.rpartition("/")[2]
            if column == "time":
                if values.tobytes() in seen:
                    target[key] = target[seen[values.tobytes()]]
                    return
                seen[values.tobytes()] = key
            elif column != "index":
                values = rounded(values, PLACE_BITS if column in ("position", "sinkage") or name.startswith(FINER) else BITS)
            options = {"chunks": values.shape, "compression": "gzip", "compression_opts": 9, "shuffle": True} if values.size > 64 else {}
            target.create_dataset(key, data=values, **options).attrs.update(item.attrs)

        for key, item in source.items():
            copy(key, item)
    packed.replace(path)
    for snapshot in sorted(path.parent.glob("snapshots/*.h*")):
        pack_snapshot(snapshot)
    summary = path.with_name("summary.json")
    if summary.is_file():
        summary.write_text(json.dumps(json.loads(summary.read_text(encoding="utf-8")), separators=(",", ":")) + "\n", encoding="utf-8")


def pack_snapshot(path):
    """Rewrites a file of a thinned run's snapshots in place."""
    packed = path.with_suffix(".packed")
    with h5py.File(path, "r") as source, h5py.File(packed, "w", libver=("v110", "v110")) as target:
        target.attrs.update(source.attrs)

        def copy(name, item):
            if isinstance(item, h5py.Group):
                target.require_group(name).attrs.update(item.attrs)
                return
            values = rounded(item[()].astype(np.float32), SNAPSHOT_BITS.get(name.rpartition("/")[2], 13)) if item.dtype.kind == "f" else item[()]
            options = {"compression": "gzip", "compression_opts": 9, "shuffle": True} if item.size > 64 else {}
            target.create_dataset(name, data=values, **options).attrs.update(item.attrs)

        source.visititems(copy)
    packed.replace(path)


def pack_table(path):
    """Replaces FILE.csv with FILE.csv.gz, without a date, so that equal tables give equal files."""
    if path.stat().st_size > 6000:
        Path(f"{path}.gz").write_bytes(gzip.compress(path.read_bytes(), 9, mtime=0))
        path.unlink()


KINDS = {"runs": ("timeseries.h5", pack_run), "tables": ("*.csv", pack_table), "pictures": ("*.png", pack_picture)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    pattern, pack = KINDS[options.kind]
    for path in sorted(options.folder.rglob(pattern)):
        pack(path)


if __name__ == "__main__":
    main()
