#!/usr/bin/env python3
"""Checkpoints with right checksums in which one value is out of its range, or one data set of another length."""

import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import h5py
import numpy

from checkpoint_file import edited
from command import TREAD
from restart_test import ASLEEP, BODIES, EVERY_FEW_STEPS, MIXED, MPIRUN, RestartTest, lasting

NAN, INF = float("nan"), float("inf")

# What is wrong with one shows at another.
SAID_OF = {"pairs/first_node": "pairs/"}

# Columns without terrain have no height; received_files.py looks into the series.
ALLOWED = {("surface/height", "nan"), ("run/timeseries", "high")}

def datasets(path):
    """Kind and columns of data sets by name, of those with values."""
    found = {}

    def note(name, item):
        if isinstance(item, h5py.Dataset) and item.size:
            found[name] = (item.dtype, item.shape[1] if len(item.shape) == 2 else 1)

    with h5py.File(path, "r") as file:
        file.visititems(note)
    return found


def spoil(value, column=0):
    """Puts a value into the middle row."""
    def change(file, name):
        data = file[name]
        row = data.shape[0] // 2
        data[(row, column) if len(data.shape) == 2 else row] = value
    return change


def resize(by):
    """Takes rows away or adds some, and says so in first_row."""
    def change(file, name):
        values, first = file[name][...], file[name].attrs["first_row"]
        del file[name]
        rows = len(values) + by
        file[name] = values[:rows] if by < 0 else numpy.concatenate([values, values[-by:]])
        file[name].attrs["first_row"] = numpy.array([*first[:-1], rows], dtype=numpy.int64)
    return change


def changes_of(dtype, columns):
    """Name and change of everything that a data set of this kind must not be. Of numbers that are not finite, one stands in its last column."""
    if dtype.kind == "f":
        return {"nan": spoil(NAN), "inf at the end": spoil(INF, columns - 1)}
    numbers = numpy.iinfo(dtype)
    return {"high": spoil(numbers.max), **({"low": spoil(numbers.min)} if numbers.min < 0 else {})}


class Forged(RestartTest):
    def forge(self, original, name, change):
        """A copy in which change(file, name) was done; its checksum is right."""
        handle, path = tempfile.mkstemp(suffix=".h5", dir=self.directory)
        os.close(handle)
        with edited(original, path) as file:
            change(file, name)
        return path

    def start_from(self, scene, path, launcher=()):
        """What `tread run --restart` of that file says; whether it left anything where it was to write."""
        output = pathlib.Path(str(path) + ".run")
        result = subprocess.run([*launcher, TREAD, "run", scene, "--output", output / "deep" / "er", "--backend", "cpu",
                                 "--threads", "1", "--restart", path],
                                cwd=self.directory, capture_output=True, text=True, timeout=100)
        left = output.exists()
        shutil.rmtree(output, ignore_errors=True)
        return result, left

    def faults_of(self, scene, original, name, word, change, launcher=(), said_of=None):
        """What is wrong with how a forged data set is refused; nothing if it is refused as it should be."""
        path = self.forge(original, name, change)
        result, left = self.start_from(scene, path, launcher)
        os.remove(path)
        case = f"{name} {word}: exit code {result.returncode}, {result.stderr[-400:]}"
        named = re.escape(said_of or SAID_OF.get(name, name))
        said = re.search(f"{re.escape(str(path))}.*{named}.*accepted: ", result.stderr)
        refused = result.returncode == 4 and said
        return None if refused and not left else f"{case} {'something is left' if left else ''}"

    def check_all(self, text, original, cases, launcher=(), said_of=lambda name: None):
        scene = self.write("scene.toml", text)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            faults = pool.map(lambda case: self.faults_of(scene, original, *case, launcher, said_of(case[0])), cases)
        faults = [fault for fault in faults if fault]
        self.assertEqual(faults, [], "\n".join(faults))
        print(f"  {len(cases)} forged files refused")

    def write_checkpoint(self, text, launcher=()):
        self.run_scene(text, self.directory / "whole", EVERY_FEW_STEPS, launcher=launcher)
        return self.checkpoints(self.directory / "whole")[-1]

    def check_every_value(self, text, launcher=(), of=""):
        """Checks the data sets whose names begin so: each in one scene that has it, and once more on two ranks."""
        original = self.write_checkpoint(text, launcher)
        cases = [(name, word, change) for name, kind in datasets(original).items() if name.startswith(of)
                 for word, change in changes_of(*kind).items() if (name, word) not in ALLOWED]
        self.check_all(text, original, cases, launcher)
        return original

    def test_every_data_set_of_sand_and_a_rock_is_checked(self):
        original = self.check_every_value(lasting(MIXED, 0.03))
        for name in ("bodies/material", "bodies/shape", "candidates/body", "candidates/point", "pages/first_point", "pages/point_at",
                     "pages/node_page_of", "pages/point_page_of", "points/id_0", "bodies/scale", "contact/key"):
            self.assertIn(name, datasets(original))

    def test_every_data_set_of_rocks_is_checked(self):
        original = self.check_every_value(lasting(BODIES, 0.1), of=("bodies/", "pairs/"))
        for name in ("pairs/key", "pairs/node", "pairs/first_node"):
            self.assertIn(name, datasets(original))

    def test_every_data_set_of_sleeping_sand_is_checked(self):
        self.assertIn("asleep/id_0", datasets(self.check_every_value(ASLEEP, of=("asleep/", "sleep/"))))

    def test_every_data_set_of_sleeping_rocks_is_checked(self):
        rocks = '[[rocks]]\nshape = "roller"\nmaterial = "steel"\ncount = 1\ndiameter = 0.04\nplacement = "grid"\n' \
            'region = { box = [[0.0, 0.0, 0.0], [0.08, 0.08, 0.06]] }\n'
        original = self.check_every_value(lasting(BODIES, 0.5) + rocks + "[sleep]\nrock_speed = 0.1\nrock_rest = 0.02\n", of="rock_sleep/")
        for name in ("rock_sleep/asleep", "rock_sleep/position", "rock_sleep/orientation", "rock_sleep/quiet", "rock_sleep/moves", "rock_sleep/load", "rock_sleep/key", "rock_sleep/contact"):
            self.assertIn(name, datasets(original))

    def test_every_data_set_of_sleeping_sand_and_rocks_is_checked(self):
        rocks = '[[rocks]]\nshape = "roller"\nmaterial = "steel"\ncount = 1\ndiameter = 0.06\nplacement = "replace"\n' \
            'region = { box = [[0.8, 0.0, 0.02], [1.0, 0.2, 0.1]] }\n'
        text = ASLEEP.replace("[sleep]", rocks + "[sleep]") + "rock_speed = 1.0\nrock_rest = 0.001\n"
        original = self.check_every_value(text, of=("contact/asleep_", "rock_sleep/bed"))
        for name in ("key", "tangential", "response", "material"):
            self.assertIn(f"contact/asleep_{name}", datasets(original))

    def test_every_data_set_of_two_ranks_is_checked(self):
        text = re.sub(r"\[\[body\]\].*?velocity[^\n]*\n", "", lasting(MIXED, 0.02), flags=re.S)
        self.assertIn("ranks/page_owner", datasets(self.check_every_value(text, (*MPIRUN, "-n", "2"))))

    def test_sizes_agree_with_each_other(self):
        text = lasting(MIXED, 0.04)
        original = self.write_checkpoint(text)
        free = {"run/timeseries", "run/snapshots", "contact/key"}  # others follow the last; a file and times are as long as they are
        cases = [(name, word, resize(by)) for name in datasets(original) if name not in free
                 for word, by in (("shorter", -1), ("longer", 1))]
        self.check_all(text, original, cases, said_of=lambda name: name.split("/")[0])  # or of what is beside it


if __name__ == "__main__":
    unittest.main()
