#!/usr/bin/python3
"""What postprocess/ makes to look at, from a made-up run: files for ParaView, and pictures of sand as a surface, cut open, lit by the sun."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

from made_up_run import RADIUS, SURFACE, colours_of, make_run, octahedron  # noqa: E402
from tread_post import Run, RunError  # noqa: E402
from tread_post.detail import choose_levels, levels_of, volume_of  # noqa: E402
from tread_post.display import ensure_display  # noqa: E402
from tread_post.geometry import point_spacings  # noqa: E402
from tread_post.run import Bodies, Points, Shape  # noqa: E402

SINGLE = 1e-7  # m: rounding of a metre in single precision


def turn_of(quaternion):
    """Rotation matrix of a unit quaternion w x y z."""
    w, x, y, z = quaternion
    return np.array([(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                     (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                     (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))])


def ball(rings):
    """A sphere of diameter 1, as a closed surface of quadrilaterals cut in two."""
    heights, angles = np.linspace(0, np.pi, rings + 1)[1:-1], np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)
    circles = [(np.sin(h) * np.cos(a), np.sin(h) * np.sin(a), np.cos(h)) for h in heights for a in angles]
    vertices = 0.5 * np.array([*circles, (0, 0, 1), (0, 0, -1)])
    around, top = 2 * rings, len(circles)
    triangles = []
    for here in range(around):
        after = (here + 1) % around
        triangles += [(top, here, after), (top + 1, top - around + after, top - around + here)]
        for ring in range(0, top - around, around):
            triangles += [(ring + here, ring + around + here, ring + after), (ring + after, ring + around + here, ring + around + after)]
    return Shape("ball", vertices, np.array(triangles))


class LookingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.path = Path(cls.directory.name) / "run"
        make_run(cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def command(self, name, *options):
        program = [sys.executable, str(ROOT / "postprocess" / name), *map(str, options)]
        return subprocess.run(program, capture_output=True, text=True, timeout=240, check=False)

    def near(self, what, measured, expected, tolerance):
        """`tolerance` is absolute."""
        off = np.abs(np.asarray(measured) - np.asarray(expected)).max()
        print(f"{what}: measured {np.ravel(measured)[:3]}, expected {np.ravel(expected)[:3]}, off by {off:.2g}, tolerance {tolerance:.2g}")
        self.assertLessEqual(off, tolerance, what)


class ParaViewTest(LookingTest):
    """Files for ParaView, read as VTK reads them."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = cls.path / "paraview"
        cls.done = cls.command(cls, "paraview_files.py", cls.path)

    def read(self, name):
        import vtk

        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(self.folder / name))
        reader.Update()
        self.assertEqual(reader.GetErrorCode(), 0)
        return reader.GetOutput()

    def listed(self, part):
        """[(time, file)] of a .pvd."""
        return [(float(row.get("timestep")), row.get("file")) for row in ElementTree.parse(self.folder / f"{part}.pvd").iter("DataSet")]

    def columns(self, data):
        from vtk.util.numpy_support import vtk_to_numpy

        cells = data.GetCellData()
        return {cells.GetArrayName(index): vtk_to_numpy(cells.GetArray(index)) for index in range(cells.GetNumberOfArrays())}

    def volume(self, data):
        import vtk

        properties = vtk.vtkMassProperties()
        properties.SetInputData(data)
        properties.Update()
        return properties.GetVolume()

    def test_each_time_is_listed_and_read(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.assertIn("bodies.pvd: 1 bodies, 2 snapshots", self.done.stdout)
        self.assertIn("rocks.pvd: 60 rocks, 2 snapshots", self.done.stdout)
        self.assertIn("points.hdf.series", self.done.stdout)
        for part in ("bodies", "rocks"):
            self.assertEqual(self.listed(part), [(0.0, f"{part}_0000.vtp"), (3.0, f"{part}_0007.vtp")])
            for time, name in self.listed(part):
                self.assertEqual(self.read(name).GetFieldData().GetArray("TimeValue").GetValue(0), time)
        self.assertEqual(self.read("bodies_0007.vtp").GetFieldData().GetAbstractArray("name").GetValue(0), "front wheel")

    def test_a_wheel_is_where_it_is_and_carries_what_acts_on_it(self):
        data, wheel = self.read("bodies_0007.vtp"), Run(self.path).wheel("front wheel")
        centre = np.array((0.62, 0.25, SURFACE + RADIUS - 0.03))
        reach = np.array((RADIUS, 0.1, RADIUS))
        self.near("bounds", np.reshape(data.GetBounds(), (3, 2)), np.stack((centre - reach, centre + reach), axis=1), SINGLE)
        prism = 0.5 * 48 * np.sin(2 * np.pi / 48) * RADIUS**2 * 0.2  # 48 sides
        self.near("volume", self.volume(data), prism, 20 * SINGLE * prism)
        columns = self.columns(data)
        self.near("force", columns["force"][0], wheel["force"][-1], 1e-6 * np.abs(wheel["force"][-1]).max())
        self.near("torque", columns["torque"][0], wheel["torque"][-1], 1e-6 * np.abs(wheel["torque"][-1]).max())
        self.assertEqual(columns["material"].tolist(), [1] * data.GetNumberOfPolys())

    def test_rocks_are_where_they_are(self):
        from vtk.util.numpy_support import vtk_to_numpy

        data, bodies = self.read("rocks_0007.vtp"), Run(self.path).bodies(7)
        corners = vtk_to_numpy(data.GetPoints().GetData()).reshape(60, 6, 3)
        expected = [position + scale * octahedron()[0] @ turn_of(quaternion).T
                    for position, quaternion, scale in zip(bodies.position[1:], bodies.orientation[1:], bodies.scale[1:])]
        self.near("corners", corners, expected, SINGLE)
        volume = 4 / 3 * 0.6 * (bodies.scale[1:] ** 3).sum()  # of an octahedron, 4/3 a b c
        self.near("volume", self.volume(data), volume, 1e-5 * volume)  # single precision over the size of a rock
        columns = self.columns(data)
        self.assertEqual(columns["id"].tolist(), np.repeat(np.arange(1, 61), 8).tolist())
        self.assertNotIn("force", columns)
        self.near("velocity", columns["velocity"][::8], bodies.fields["velocity"][1:], 4 * SINGLE)
        self.assertEqual(set(columns["material"]), {2})

    def test_nothing_is_replaced_unless_asked(self):
        note = self.folder / "note.txt"
        note.write_text("mine", encoding="utf-8")
        before = (self.folder / "bodies.pvd").stat().st_mtime_ns
        refused = self.command("paraview_files.py", self.path)
        self.assertEqual(refused.returncode, 1)
        self.assertRegex(refused.stderr, r"bodies\.pvd: exists; --overwrite replaces it")
        self.assertEqual((self.folder / "bodies.pvd").stat().st_mtime_ns, before)
        again = self.command("paraview_files.py", self.path, "--overwrite")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertGreater((self.folder / "bodies.pvd").stat().st_mtime_ns, before)
        self.assertEqual(note.read_text(encoding="utf-8"), "mine")
        self.assertEqual([path.name for path in self.folder.iterdir() if path.suffix not in (".pvd", ".vtp", ".txt")], [])
        empty = self.command("paraview_files.py", self.path / "absent")
        self.assertEqual(empty.returncode, 1)
        self.assertIn("no scene.toml", empty.stderr)
        for wrong in ("many", "999", "inf"):
            few = self.command("paraview_files.py", self.path, "--triangles", wrong)
            self.assertEqual(few.returncode, 2)
            self.assertIn("--triangles", few.stderr)
            self.assertNotIn("Traceback", few.stderr)


class DetailTest(LookingTest):
    def test_coarser_surfaces_have_the_same_volume(self):
        shape = ball(32)
        levels = levels_of(shape)
        counts = [len(level.surface.triangles) for level in levels]
        self.assertEqual(counts[0], len(shape.triangles))
        self.assertEqual(counts, sorted(counts, reverse=True))
        self.assertLess(counts[-1], 100)
        for level in levels:
            self.near("volume", volume_of(level.surface), volume_of(shape), 1e-12)

    def test_many_rocks_share_a_number_of_triangles(self):
        random, count = np.random.default_rng(4), 2000
        levels = [levels_of(ball(32))]
        turns = np.tile((1.0, 0, 0, 0), (count, 1))
        bodies = Bodies(0.0, random.uniform(0, 1, (count, 3)), turns, 0.01 * np.exp(random.normal(0, 0.7, count)), np.zeros(count, int), {})
        rows = np.arange(count)
        triangles = np.array([len(level.surface.triangles) for level in levels[0]])
        self.assertEqual(choose_levels(levels, bodies, rows, count * triangles[0]).max(), 0)
        most = 400_000
        chosen = choose_levels(levels, bodies, rows, most)
        total = triangles[chosen].sum()
        print(f"triangles: {total} of at most {most}")
        # One edge longer would be one rock coarser, out of at least as many as have the commonest level.
        self.assertLessEqual(total, most)
        self.assertGreater(total, 0.95 * most)
        edges = np.array([level.edge for level in levels[0]])[chosen] * bodies.scale
        unbound = (chosen > 0) & (chosen < len(triangles) - 1)
        self.assertLess(edges[unbound].max() / edges[unbound].min(), 2)  # levels are a factor of about 1.4 apart
        fewest = choose_levels(levels, bodies, rows, 1000)
        self.assertEqual(set(fewest), {len(triangles) - 1})


class PictureTest(LookingTest):
    def bed(self, spacing):
        """A bed [1, 0.5, 0.15] m of points on a lattice."""
        axes = [np.arange(0.5 * spacing, size, spacing) for size in (1.0, 0.5, 0.15)]
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)

    def without_bodies(self):
        """A copy of the run that has sand only."""
        path = self.path.parent / "sand"
        make_run(path)
        for file in (path / "snapshots").glob("bodies_*.h5"):
            file.unlink()
        return path

    def test_the_surface_of_a_level_bed_is_level(self):
        from tread_post.sand import surface_of
        from tread_post.vtk_data import normals_of, positions_of

        spacing = 0.01
        position, box = self.bed(spacing), np.array([(0, 0, 0), (1.0, 0.5, 0.6)])
        even = np.full(len(position), spacing)
        surface = surface_of(position, position[:, 0], even, box)
        # The grid fits the box: its cells are 3 % lower than the points are apart, and points do not stand in their middles.
        self.near("bounds", np.reshape(surface.GetBounds(), (3, 2)), [(0, 1), (0, 0.5), (0, 0.15)], 0.02 * spacing)
        places = positions_of(surface)
        top = (places[:, 2] > 0.145) & (np.abs(places[:, :2] - (0.5, 0.25)) < (0.45, 0.2)).all(axis=1)
        self.assertGreater(top.sum(), 1000)
        self.near("normal of the top", normals_of(surface)[top], np.tile((0.0, 0, 1), (top.sum(), 1)), 1e-5)
        from vtk.util.numpy_support import vtk_to_numpy

        self.near("values", vtk_to_numpy(surface.GetPointData().GetArray("shade"))[top], places[top, 0], 1e-5)
        # Half of the bed has points half as wide, as where the grid is refined. It lies as high.
        small = self.bed(0.5 * spacing)
        mixed = np.concatenate((position[position[:, 0] < 0.5], small[small[:, 0] > 0.5]))
        scene = {"grid": {"spacing": 2 * spacing, "refine": [[(0.51, 0, 0), (1, 0.5, 0.15)]]}, "terrain": [{"points_per_cell": 8}]}
        sizes = point_spacings(scene, Points(0.0, mixed, {"displacement": np.zeros_like(mixed)}, {}))  # the box begins a cell of 20 mm lower, at 0.5
        self.assertEqual(sizes.tolist(), np.where(mixed[:, 0] < 0.5, spacing, 0.5 * spacing).tolist())
        refined = surface_of(mixed, mixed[:, 0], sizes, box)
        self.near("bounds, refined", np.reshape(refined.GetBounds(), (3, 2)), [(0, 1), (0, 0.5), (0, 0.15)], 0.05 * spacing)
        # Cut open at y = 0.2 it ends there in a plane.
        behind = position[position[:, 1] >= 0.2]
        opened = surface_of(behind, behind[:, 0], even[:len(behind)], np.array([(0, 0.2, 0), (1.0, 0.5, 0.6)]))
        self.near("cut", opened.GetBounds()[2], 0.2, 0.02 * spacing)

    def test_hidden_beads_are_left_out(self):
        from tread_post.sand import outer_rows

        position, spacing = self.bed(0.01), 0.01
        kept = outer_rows(position, np.full(len(position), spacing))
        depth = np.minimum(position, (1.0, 0.5, 0.15) - position).min(axis=1) / spacing
        hidden = np.setdiff1d(np.arange(len(position)), kept)
        print(f"beads: {len(kept)} of {len(position)}, hidden ones are {depth[hidden].min():.1f} spacings deep at least")
        self.assertGreater(depth[hidden].min(), 2)
        self.assertGreater(len(hidden), 0.5 * len(position))

    def test_sunlight_and_shadow(self):
        import tread_post.sunlight as sunlight
        from tread_post.vtk_data import positions_of, smooth_surface

        def plate(half, height, cells):
            line = np.linspace(-half, half, cells + 1)
            vertices = np.stack([*np.meshgrid(line, line, indexing="ij"), np.full((cells + 1, cells + 1), height)], axis=-1).reshape(-1, 3)
            first = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
            triangles = np.concatenate([np.stack((first, first + cells + 1, first + 1), axis=1),
                                        np.stack((first + 1, first + cells + 1, first + cells + 2), axis=1)])
            return smooth_surface(vertices, triangles)

        sun = sunlight.sun_of((-0.62, -1.0, 0.72))
        floor, roof = plate(2.0, 0.0, 80), plate(0.5, 0.3, 20)
        light, _ = sunlight.illuminance([floor, roof], sun)
        place = positions_of(floor)[:, :2]
        shade = -0.3 * sun[:2] / sun[2]  # the middle of the roof's shadow
        in_shadow = np.abs(place - shade).max(axis=1) < 0.3
        far = np.linalg.norm(place, axis=1) > 1.9
        level = sunlight.AMBIENT + sunlight.SKY + sunlight.DIRECT * sun[2]
        # The sun is a disc of 16 directions, whose mean height is off by the square of its radius; of the sky the roof takes a hundredth.
        self.near("in the open", light[far & (np.abs(place).max(axis=1) < 1.95)].mean(), level, 0.02)
        self.assertLess(light[in_shadow].max(), sunlight.AMBIENT + sunlight.SKY)
        between = light[np.abs(place - shade).max(axis=1) < 0.7]
        middle = (between > 0.5 * (light[in_shadow].mean() + level) - 0.1) & (between < 0.5 * (light[in_shadow].mean() + level) + 0.1)
        print(f"shadow: {light[in_shadow].mean():.3f}, in the open {level:.3f}, half-lit vertices {middle.sum()}")
        self.assertGreater(middle.sum(), 20)  # soft edges

    def test_a_cut_leaves_what_is_behind_it(self):
        from tread_post.camera import around
        from tread_post.picture import Look, shown, view_of, views_around

        run = Run(self.path)
        points, bodies = shown(run, 7, Look(cut=(1, 0.2)))
        self.assertGreaterEqual(points.position[:, 1].min(), 0.2)
        self.assertEqual(len(points.position), len(points.fields["displacement"]))
        whole = run.bodies(7)
        self.assertEqual(len(bodies.shape), 1 + (whole.position[1:, 1] >= 0.2).sum())
        self.assertTrue((bodies.position[0] == whole.position[0]).all())
        with self.assertRaisesRegex(RunError, "snapshot 7 nothing lies behind the cut"):
            shown(Run(self.without_bodies()), 7, Look(cut=(1, 0.5)))
        above, _ = shown(run, 7, Look(view="top", cut=(2, 0.1)))
        self.assertLessEqual(above.position[:, 2].max(), 0.1)
        views = views_around(run, [0, 7], 0, view_of(run, [0, 7]))
        self.assertTrue(np.allclose(views[1].content, around(whole, 0, run.shapes)))
        self.near("middle", views[1].content.mean(axis=0)[:2], whole.position[0, :2], 1e-12)

    def test_pictures(self):
        output = self.path.parent / "picture.png"
        for options in (("--sand", "surface", "--light", "sun", "--cut", "y", "--follow", "front wheel"),
                        ("--sand", "surface", "--colour", "plain", "--view", "top", "--cut", "z=0.1"), ("--view", "side", "--cut", "y=0.25")):
            done = self.command("render.py", self.path, "--output", output, "--size", 640, 400, *options)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertGreater(colours_of(output), 40, "a picture of something")

    def test_a_film_by_two_processes_is_the_film_of_one(self):
        films = []
        for jobs in (1, 2):
            films.append(self.path.parent / f"film{jobs}.gif")
            done = self.command("render.py", self.path, "--film", "--jobs", jobs, "--size", 320, 200, "--follow", "front wheel", "--sand", "surface",
                                "--output", films[-1])
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(films[0].read_bytes(), films[1].read_bytes())

    def test_errors_name_what_is_wrong(self):
        for code, options, words in ((1, ("--follow", "rear"), "--follow rear: accepted: front wheel"),
                                     (1, ("--cut", "w"), "--cut w: accepted: x, y or z"), (1, ("--cut", "y=wide"), "--cut y=wide: accepted"),
                                     (1, ("--cut", "y=0.6"), "--cut y=0.6: accepted: 0 to 0.5 m"), (1, ("--cut", "y=nan"), "--cut y=nan: accepted"),
                                     (2, ("--light", "sun"), "--light sun: needs --sand surface"), (2, ("--jobs", "0"), "--jobs 0: at least 1"),
                                     (2, ("--sand", "surface", "--colour", "rank"), "--colour rank: needs --sand beads")):
            done = self.command("render.py", self.path, *options)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
        with self.assertRaisesRegex(RunError, "snapshot 3 has neither"):
            from tread_post.picture import Look, shown

            shown(Run(self.path), 3, Look())


if __name__ == "__main__":
    ensure_display()
    unittest.main()
