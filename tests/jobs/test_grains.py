#!/usr/bin/python3
"""Constants of made-up grains in compression, under a sliding plate and in a bed, and the table of wheels on both: postprocess/grains.py."""

import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

from tread_post import Run, RunError  # noqa: E402
from tread_post.grain_comparison import AGREEMENT, drive_of, table_of  # noqa: E402
from tread_post.grain_constants import DEGREES, DENSITY_FACTOR, POISSON, Bed, Compression, bed_of, compression_of, plate_friction, settings_of  # noqa: E402
from tread_post.grains import Grains, overlaps, void_ratio  # noqa: E402

SIDE, SLAB, PITCH = 0.04, 0.02, 0.002  # m: edge of the sample, its thickness, distance of grains on a cubic lattice
CUBIC = 6 / math.pi - 1  # void ratio of touching spheres on it
CONFINING, MODULUS, PEAK, END, PEAK_STRAIN, DILATION = 5e3, 2e6, 40.0, 30.0, 0.04, 0.5
SCENE = """
[domain]
size = [0.1, 0.02, 0.1]
[[material]]
name = "grain"
density = 2600.0
[[shape]]
name = "ball"
generate = { kind = "sphere" }
[[shape]]
name = "lid"
generate = { kind = "box", size = [0.12, 0.03, 0.01] }
[[shape]]
name = "side"
generate = { kind = "box", size = [0.01, 0.03, 0.12] }
[[rocks]]
shape = "ball"
material = "grain"
%s
[[phase]]
name = "shear"
[reference]
form = "triaxial"
"""
PLATES = '[[body]]\nname = "top"\nshape = "lid"\n[[body]]\nname = "side_x"\nshape = "side"\n'
WHEEL = """
[grid]
spacing = %g
[[shape]]
name = "drum"
[[body]]
name = "wheel"
shape = "drum"
rolling_radius = 0.05
[[phase]]
name = "drive"
drive = { body = "wheel", angular_velocity = 2.0, slip = 0.2 }
"""


def flow(degrees):
    """Ratio of principal stresses at that friction angle."""
    return math.tan(math.radians(45 + 0.5 * degrees)) ** 2


def lattice(size):
    axes = [np.arange(0.5 * PITCH, edge, PITCH) for edge in size]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def write_bodies(path, number, time, centre, named):
    path.mkdir(exist_ok=True)
    count = named + len(centre)
    with h5py.File(path / f"bodies_{number:04}.h5", "w") as file:
        file.attrs["time"] = time
        file["position"] = np.concatenate((np.full((named, 3), 1.0), centre))
        file["orientation"], file["shape"] = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)), np.zeros(count, int)
        file["scale"] = np.full(count, PITCH)


def compressed():
    """(axial strain, volume strain, ratio of stresses), each [rows]: a straight rise, a slower one to the peak, and a fall to the end."""
    strain = np.linspace(0, 0.3, 601)
    elastic = 1 + MODULUS * strain / ((1 - POISSON**2) * CONFINING)
    softened = flow(END) + (flow(PEAK) - flow(END)) * np.exp(-np.clip(strain - PEAK_STRAIN, 0, None) / 0.02)
    softened -= 5 * np.clip(PEAK_STRAIN - strain, 0, None)
    volume = -DILATION * 0.1 * np.tanh(strain / 0.1)
    return strain, volume, np.minimum(elastic, softened)


def write_compression(path):
    path.mkdir()
    (path / "scene.toml").write_text(SCENE % PLATES, encoding="utf-8")
    strain, volume, ratio = compressed()
    edge_x, edge_z = SIDE * (1 - volume + strain), SIDE * (1 - strain)
    zero = np.zeros_like(strain)
    with h5py.File(path / "timeseries.h5", "w") as file:
        file["phases/index"], file["phases/start"] = [0], [-0.001]
        top, side = file.create_group("wheel/top"), file.create_group("wheel/side_x")
        top["time"] = side["time"] = 0.001 * np.arange(len(strain))
        top["position"] = np.stack((zero, zero, edge_z + 0.005), axis=1)
        side["position"] = np.stack((edge_x + 0.005, zero, zero), axis=1)
        top["force"] = np.stack((zero, zero, ratio * CONFINING * edge_x * SLAB), axis=1)
        side["force"] = np.stack((CONFINING * edge_z * SLAB, zero, zero), axis=1)
    for number, time, size in ((0, 0.0, (SIDE, SLAB, SIDE)), (1, 0.6, (edge_x[-1], SLAB, edge_z[-1]))):
        write_bodies(path / "snapshots", number, time, lattice(size), 2)


def write_drive(path, spacing, pull, torque, sinkage):
    path.mkdir()
    text = WHEEL % (spacing or 1.0)
    (path / "scene.toml").write_text(text + ('[[terrain]]\nmaterial = "sand"\n' if spacing else ""), encoding="utf-8")
    time = np.linspace(0, 1.6, 801)
    zero, noise = np.zeros_like(time), np.random.default_rng(1).normal(0, 0.2, len(time))
    with h5py.File(path / "timeseries.h5", "w") as file:
        file["phases/index"], file["phases/start"], file["energy/time"] = [0], [0.0], time
        wheel = file.create_group("wheel/wheel")
        wheel["time"], wheel["slip"], wheel["sinkage"] = time, zero + 0.2, zero + sinkage
        wheel["drawbar_pull"], wheel["power"] = pull + noise, zero
        wheel["force"] = np.stack((pull + noise, zero, zero + 8.0), axis=1)
        wheel["torque"] = np.stack((zero, zero - torque, zero), axis=1)
        wheel["velocity"], wheel["angular_velocity"] = np.stack((zero + 0.08, zero, zero), axis=1), np.stack((zero, zero + 2.0, zero), axis=1)


class GrainsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tread-grains-")
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)

    def check(self, what, measured, expected, tolerance, why):
        print(f"{what}: measured {measured:.6g}, expected {expected:.6g}, tolerance {tolerance:.2g}: {why}")
        self.assertLessEqual(abs(measured - expected), tolerance)

    def test_void_ratio_and_overlap_of_spheres_on_a_lattice(self):
        centre = lattice((SIDE, SLAB, SIDE))
        grains = Grains(centre, np.full(len(centre), 0.5 * PITCH))
        found = void_ratio(grains, np.full(3, 0.004), np.array([0.034, 0.014, 0.034]))
        self.check("void ratio of a cubic lattice", found, CUBIC, 0.01, "three standard errors of as many random places")
        pair = Grains(np.array([[0.0, 0.0, 0.0], [0.0019, 0.0, 0.0], [0.01, 0.0, 0.0]]), np.full(3, 0.001))
        self.assertEqual(len(overlaps(pair)), 1)
        self.check("overlap", overlaps(pair)[0], 0.05, 1e-12, "two spheres of 2 mm, 1.9 mm apart")

    def test_constants_of_a_compression(self):
        write_compression(self.path / "run")
        found, (strain, volume, ratio) = compression_of(Run(self.path / "run")), compressed()
        self.check("confining stress", found.confining, CONFINING, 1e-6 * CONFINING, "areas are those of the moment")
        self.check("peak angle", found.peak_angle, PEAK, 0.5, "the reader takes a mean over a twentieth of the rows")
        self.check("angle at the end", found.end_angle, END, 0.05, "what is left of the fall")
        self.check("modulus", found.modulus, MODULUS, 1e-6 * MODULUS, "the rise to half of the peak is a straight line")
        half = int(np.argmax(ratio - 1 >= 0.5 * (flow(PEAK) - 1)))
        self.check("mean stress", found.pressure, (1 + POISSON) / 3 * CONFINING * (1 + ratio[half]), 0.01 * CONFINING, "one row more or less")
        at = strain[np.argmax(np.convolve(ratio, np.ones(30) / 30, "valid")) + 15]
        self.check("dilation at the peak", found.dilation_rate, DILATION / np.cosh(at / 0.1) ** 2, 0.03 * DILATION, "a chord of 2 % of strain")
        late = slice(450, None)
        slope = -np.polyfit(strain[late], volume[late], 1)[0]
        self.check("dilation at the end", found.end_rate, slope, 0.02 * DILATION, "the reader drops the first rows")
        for name in ("void_ratio", "end_void_ratio"):
            self.check(name, getattr(found, name), CUBIC, 0.03 * CUBIC, "a lattice whose last layer may stand over the plate")

    def test_settings_give_back_peak_and_critical_state(self):
        dense = Compression(2e3, 40.0, 31.0, 0.8, 0.1, 1e6, 3e3, 0.55, 0.7, 0.005)
        stiffer = Compression(8e3, 38.0, 31.0, 0.8, 0.1, 2e6, 12e3, 0.55, 0.7, 0.005)
        loose = Compression(8e3, 30.0, 29.0, 0.0, 0.0, 1e6, 12e3, 0.68, 0.67, 0.005)
        found, rate = settings_of([dense, stiffer], [loose], 0.4, Bed(0.58, 1650.0, 0.005))
        low, high = found["material.sand.void_ratio_min"], found["material.sand.void_ratio_max"]

        def angle(void):
            return 29.0 + DEGREES * (DENSITY_FACTOR * (high - void) / (high - low) - 1)

        self.check("angle of dense grains", angle(0.55), 39.0, 1e-9, "Bolton's relation solved for its void ratios")
        self.check("angle of the critical state", angle(0.67), 29.0, 1e-9, "likewise")
        self.check("rate of dilation", rate, 0.3 * 10.0 / DEGREES, 1e-12, "Bolton's 0.3 I_R at ten degrees over the critical state")
        self.check("relative density of the bed", found["material.sand.relative_density"], (high - 0.58) / (high - low), 1e-12, "of the bed's own void ratio")
        self.assertEqual((found["material.sand.young"], found["material.sand.young_pressure"], found["contact[0].friction"]), (2e6, 12e3, 0.4))
        with self.assertRaisesRegex(RunError, "wants dense grains that are stronger"):
            settings_of([loose], [dense], 0.4, Bed(0.58, 1650.0, 0.005))

    def test_plate_and_bed(self):
        write_compression(self.path / "run")
        with h5py.File(self.path / "run" / "timeseries.h5", "r+") as file:
            force = file["wheel/top/force"][:]
            force[:, 0] = -0.3 * force[:, 2]
            file["wheel/top/force"][:] = force
        self.check("friction of the plate", plate_friction(Run(self.path / "run")), 0.3, 1e-12, "every row has it")
        bed = self.path / "bed"
        bed.mkdir()
        (bed / "scene.toml").write_text(SCENE % "", encoding="utf-8")
        write_bodies(bed / "snapshots", 0, 0.0, lattice((0.1, 0.02, 0.04)), 0)
        found = bed_of(Run(bed))
        self.check("void ratio of the bed", found.void_ratio, CUBIC, 0.01, "three standard errors of as many random places")
        self.check("density of the bed", found.density, 2600 * math.pi / 6, 0.005 * 2600, "a cubic lattice up to its walls")

    def test_table(self):
        write_drive(self.path / "grains", None, 0.8, 0.16, 0.005)
        write_drive(self.path / "coarse", 0.005, 3.0, 0.2, 0.012)
        write_drive(self.path / "fine", 0.0025, 2.4, 0.18, 0.006)
        done = subprocess.run([sys.executable, ROOT / "postprocess" / "grains.py", "table", *(self.path / name for name in ("fine", "grains", "coarse"))],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()[2:]]
        self.assertEqual([row[1] for row in rows], list(AGREEMENT))
        for row, expected, agrees in zip(rows, (0.2, 0.05, 0.02), ("no", "yes", "yes")):
            self.check(f"{row[1]}, finest less grains", float(row[5]), expected, 5e-4, "printed with three digits")
            self.assertEqual(row[-1], agrees)
        self.assertIn("5 mm | 2.5 mm", done.stdout)
        with self.assertRaisesRegex(RunError, "on grains and on the continuum"):
            table_of([drive_of(Run(self.path / "grains"))])


if __name__ == "__main__":
    unittest.main()
