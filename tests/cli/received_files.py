#!/usr/bin/env python3
"""Files that come from elsewhere: links, storage in other files, pipes, sizes that nothing can hold, damaged HDF5."""

import os
import random
import re
import shutil
import unittest

import h5py
import numpy

from checkpoint_file import edited
from command import SCENE
from restart_test import EVERY_FEW_STEPS, RestartTest

SECRET = b"nobody else's business\n" * 50

ROCKS = SCENE[: SCENE.index("[[terrain]]")] + """
[[rocks]]
shape     = "ball"
material  = "steel"
count     = 3
diameter  = 0.08
placement = "rain"
region    = { box = [[0.0, 0.0, 0.0], [0.4, 0.4, 0.4]] }

[[shape]]
name     = "ball"
generate = { kind = "sphere", nodes = 42 }

""" + SCENE[SCENE.index("[[phase]]"):].replace("[output]", '[output]\nbed_after = "rest"')
ON_BED = re.sub(r"count .*?region[^\n]*\n", 'from = "bed.h5"\n', ROCKS, flags=re.S).replace('bed_after = "rest"\n', "")


def replace(name, make):
    """Puts make(file, name, values) in the place of a data set, with its attributes."""
    def change(file):
        values, attributes = file[name][...], dict(file[name].attrs)
        del file[name]
        made = make(file, name, values)
        if made is not None:
            made.attrs.update(attributes)
    return change


def link(to):
    def make(file, name, _):
        file[name] = to
    return make


class ReceivedFiles(RestartTest):
    def setUp(self):
        super().setUp()
        self.secret = self.directory / "secret"
        self.secret.write_bytes(SECRET)
        self.pipe = self.directory / "pipe"
        os.mkfifo(self.pipe)
        self.other = self.directory / "other.h5"
        with h5py.File(self.other, "w") as file:
            file["values"] = numpy.zeros(100)

    def ways(self):
        """Word that the refusal has, and what is put in the place of a data set."""
        def external(file, name, values):
            return file.create_dataset(name, shape=(len(SECRET) // values.dtype.itemsize,), dtype=values.dtype,
                                       external=[(str(self.secret), 0, len(SECRET))])

        def virtual(file, name, values):
            layout = h5py.VirtualLayout(shape=values.shape, dtype=values.dtype)
            layout[...] = h5py.VirtualSource(str(self.other), "values", shape=values.shape)
            return file.create_virtual_dataset(name, layout)

        def compressed(file, name, values):
            return file.create_dataset(name, data=values, compression="gzip")

        def declared(file, name, values):
            return file.create_dataset(name, shape=(10**12, *values.shape[1:]), dtype=values.dtype)

        return {"another file": external, "link to another file": link(h5py.ExternalLink(str(self.other), "/values")),
                "to another file": link(h5py.ExternalLink(str(self.pipe), "/values")), "soft link": link(h5py.SoftLink("/somewhere")),
                "virtual": virtual, "filters": compressed, "(first_row|declares|rows)": declared}

    def checkpoint(self):
        self.run_scene(SCENE, self.directory / "whole", EVERY_FEW_STEPS)
        return self.checkpoints(self.directory / "whole")[-1]

    def refuse(self, path, word):
        """In a new directory, of which nothing stays, and in one that was there."""
        new, old = self.directory / "new" / "er", self.directory / "old"
        old.mkdir(exist_ok=True)
        for output in (new, old):
            result = self.run_scene(SCENE, output, "--restart", path, code=4)
            self.assertRegex(result.stderr, f"(?s){path}.*{word}")
        self.assertFalse(new.parent.exists())
        self.assertEqual([file.name for file in old.iterdir() if file.name != ".lock"], [])

    def test_a_checkpoint_that_leads_elsewhere_is_refused(self):
        original, forged = self.checkpoint(), self.directory / "forged.h5"
        for word, make in self.ways().items():
            for name in ("run/timeseries", "surface/height", "points/position_0"):
                with self.subTest(word, name=name):
                    with edited(original, forged) as file:
                        replace(name, make)(file)
                    self.refuse(forged, word)

    def test_a_time_series_that_leads_elsewhere_is_refused(self):
        original, forged, inner = self.checkpoint(), self.directory / "forged.h5", self.directory / "inner.h5"

        def series(change):
            with edited(original, forged) as file:
                inner.write_bytes(file["run/timeseries"][...].tobytes())
                change(inner)
                with open(inner, "rb") as changed:
                    values = numpy.frombuffer(changed.read(), dtype=numpy.uint8)
                attribute = file["run/timeseries"].attrs["first_row"].copy()
                attribute[-1] = len(values)
                del file["run/timeseries"]
                file["run/timeseries"] = values
                file["run/timeseries"].attrs["first_row"] = attribute

        def within(change):
            def apply(path):
                with h5py.File(path, "r+") as file:
                    change(file)
            return apply

        cases = {word: within(replace("energy/total", make)) for word, make in self.ways().items() if "declares" not in word}
        cases["schema"] = within(lambda file: file.attrs.modify("schema", "another"))
        cases["does not grow"] = within(replace("energy/total", lambda file, name, values: file.create_dataset(name, data=values)))
        cases["run/timeseries"] = lambda path: path.write_bytes(b"no HDF5" * 99)
        for word, change in cases.items():
            with self.subTest(word):
                series(change)
                self.refuse(forged, word)

    def test_a_run_that_goes_on_keeps_its_files_when_its_checkpoint_is_refused(self):
        checkpoint = self.stop_after_a_checkpoint(SCENE.replace("duration = 0.02", "duration = 100.0"), self.output)
        with edited(checkpoint, self.directory / "forged.h5") as file:
            file["points/id_0"][0] = 4_000_000_000
        shutil.copy(self.directory / "forged.h5", checkpoint)

        def kept():
            return {path: path.read_bytes() for path in self.output.rglob("*") if path.is_file() and path.name not in ("log.txt", ".lock")}

        before = kept()
        text = SCENE.replace("duration = 0.02", "duration = 100.0")
        result = self.run_scene(text, self.output, "--restart", "auto", code=4)
        self.assertRegex(result.stderr, "points/id_0 row 0: 4000000000; accepted: ")
        self.assertEqual(before.keys(), kept().keys())
        self.assertEqual([path for path in before if before[path] != kept()[path]], [])

    def test_what_is_no_file_is_not_waited_for(self):
        for path, word in ((self.pipe, "pipe"), ("/dev/zero", "device"), (self.directory, "directory")):
            self.refuse(path, word)
            result = self.tread("info", path)
            self.assertEqual((result.returncode, result.stdout), (2, ""), result.stderr)
            self.assertIn(word, result.stderr)
            bed = ON_BED.replace("bed.h5", str(path))
            self.assertIn("accepted: bed.h5 of a run", self.run_scene(bed, self.directory / "new", code=2).stderr)

    def test_a_run_directory_of_pipes_is_not_waited_for(self):
        self.run_scene(SCENE, self.output, EVERY_FEW_STEPS)
        for name in ("summary.json", "scene.toml"):
            (self.output / name).unlink()
            os.mkfifo(self.output / name)
        for checkpoint in self.checkpoints():
            checkpoint.unlink()
            os.mkfifo(checkpoint)
        result = self.run_scene(SCENE, self.output, "--restart", "auto", code=4)
        self.assertIn("pipe", result.stderr)

    def test_every_value_of_a_bed_is_checked(self):
        self.run_scene(ROCKS, self.directory / "rocks")
        original, bed = self.directory / "rocks" / "bed.h5", self.directory / "bed.h5"
        shutil.copy(original, bed)
        self.run_scene(ON_BED, self.output)
        cases = [("rocks/scale", replace("rocks/scale", make), word) for word, make in self.ways().items()]

        def put(name, place, value):
            def change(file):
                file[name][place] = value
            return change

        with h5py.File(original) as file:
            names = []
            file.visititems(lambda name, item: names.append((name, item.dtype, item.shape)) if isinstance(item, h5py.Dataset) and item.size else None)
        self.assertGreater(len(names), 4)
        for name, dtype, shape in names:
            floats = dtype.kind == "f"
            for value in (float("nan"), float("inf")) if floats else (numpy.iinfo(dtype).min, numpy.iinfo(dtype).max):
                cases.append((name, put(name, (0,) * len(shape), value), "accepted: "))
            cases.append((name, replace(name, lambda file, at, values: file.create_dataset(at, data=values[:-1])), "(accepted|columns)"))
        for name, change, word in cases:
            with self.subTest(name, word=word):
                shutil.copy(original, bed)
                with h5py.File(bed, "r+") as file:
                    change(file)
                result = self.run_scene(ON_BED, self.directory / "new", code=2)
                self.assertRegex(result.stderr, f"(?s)bed.h5.*{word}")
                self.assertFalse((self.directory / "new").exists())

    def test_info_survives_damage(self):
        dice = random.Random(5)
        original = self.checkpoint()
        self.assertIn("schema = tread-checkpoint", self.tread("info", original).stdout)
        codes = set()
        for turn in range(60):
            body = bytearray(original.read_bytes())
            for _ in range(dice.choice((1, 4, 40))):
                body[dice.randrange(512, min(len(body), 20000))] = dice.randrange(256)
            damaged = self.directory / f"damaged{turn}.h5"
            damaged.write_bytes(body[: dice.randrange(len(body))] if dice.random() < 0.2 else body)
            result = self.tread("info", damaged)
            self.assertIn(result.returncode, (0, 2), f"{turn}: {result.stderr}")
            self.assertEqual(result.returncode == 2, f"error: {damaged}" in result.stderr, result.stderr)
            codes.add(result.returncode)
        self.assertEqual(codes, {0, 2})

    def test_info_shows_no_control_characters(self):
        with h5py.File(self.other, "r+") as file:
            file.attrs["title"] = "\x1b]0;mine\x07 and \x1b[2J"
        result = self.tread("info", self.other)
        self.assertIn("\\x1b]0;mine\\x07", result.stdout)
        self.assertNotIn("\x1b", result.stdout)


if __name__ == "__main__":
    unittest.main()
