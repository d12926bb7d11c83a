#!/usr/bin/env python3
"""Writes what edit_bed and edit_checkpoint change: originals.py FOLDER. Wants the program (TREAD, or `tread` on PATH)."""

import pathlib
import shutil
import sys
import tempfile

from fuzz_checkpoint import originals
from seeds import bed

if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bed.h5").write_bytes(bed())
    with tempfile.TemporaryDirectory(prefix="tread-fuzz-") as name:
        # One step before the end, since steps take longer than reading.
        for number, (scene, checkpoint) in enumerate(originals(pathlib.Path(name), every_steps=1)):
            shutil.copy(scene, folder / f"{number}.toml")
            shutil.copy(checkpoint, folder / f"{number}.h5")
