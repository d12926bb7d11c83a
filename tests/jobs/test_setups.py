#!/usr/bin/python3
"""Pictures of the paper's set-ups, from states of the small twins in configs/paper/reduced. Needs what postprocess/ needs, VTK, and the program in TREAD."""

import contextlib
import io
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import paper  # noqa: E402
from campaign_fixture import TREAD  # noqa: E402
from made_up_run import colours_of  # noqa: E402
from tread_paper.setups import SETUPS, Setup, State, figure_of, made  # noqa: E402
from tread_post import RunError  # noqa: E402
from tread_post.display import ensure_display  # noqa: E402
from tread_post.occlusion import seen_rows  # noqa: E402
from tread_post.style import write_shaded  # noqa: E402

TWINS = ROOT / "configs" / "paper" / "reduced"


class Setups(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.folder = Path(directory.name)

    def test_every_setup_is_drawn(self):
        for setups in SETUPS.values():
            for name, setup in setups.items():
                path = self.folder / f"{name}.png"
                with contextlib.redirect_stdout(io.StringIO()):
                    write_shaded(figure_of(setup, TREAD, TWINS), path)
                self.assertGreater(colours_of(path), 20, name)
                self.assertLess(path.stat().st_size, 250_000, name)

    def test_states_are_the_first_and_scenes_keep_their_phases(self):
        with made(SETUPS["slip"]["slip_setup"], TREAD, TWINS) as runs:
            for one in runs:
                self.assertEqual(one.run.bodies(one.run.snapshots[0]).time, 0)
                self.assertLess(one.run.summary["time"], 1e-6)
                self.assertEqual(one.scene["phase"][-1]["drive"]["slip"], 0.3)
            self.assertFalse(one.run.scene["phase"][-1].get("drive"))
        self.assertFalse(one.run.path.exists())

    def test_a_place_is_where_the_camera_sees_it(self):
        from tread_paper.stills import still

        box = np.array([(x, y, z) for x in (0.0, 0.9) for y in (0.0, 0.48) for z in (0.0, 0.5)])
        with made(Setup("", (State("slip_sand"),), ""), TREAD, TWINS) as runs:
            pixels, where = still(runs[0].run, 0, box, (320, 200))
        self.assertEqual(pixels.shape[:2], (200, 320))
        seen = where(box)
        self.assertTrue(((seen > 0) & (seen < (320, 200))).all(), seen)
        column, row = np.rint(where([(0.45, 0.0, 0.06)])[0]).astype(int)  # on the near side of the sand
        self.assertLess(pixels[row, column, 2], 0.9 * pixels[row, column, 0])
        column, row = np.rint(where([(0.88, 0.0, 0.48)])[0]).astype(int)  # in the air
        self.assertEqual(list(pixels[row, column, :3]), [1, 1, 1])

    def test_bodies_behind_others_are_not_seen(self):
        # Of two layers the second stands exactly behind the first; one body of it stands apart.
        layer = np.stack(np.meshgrid(np.arange(5.0), np.arange(4.0)), axis=-1).reshape(-1, 2)
        places = np.concatenate((layer, layer, [(9.0, 9.0)]))
        depths = np.concatenate((np.full(20, 2.0), np.full(20, 1.0), [2.0]))
        self.assertEqual(list(seen_rows(places, depths, 0.5)), [*range(20, 40), 40])
        self.assertEqual(len(seen_rows(places[:0], depths[:0], 0.5)), 0)

    def test_a_page_keeps_its_setup_without_the_program(self):
        with unittest.mock.patch.dict(paper.FIGURES, {"slip": {}}):
            self.assertEqual(paper.drawn("slip", None, self.folder), ["(No picture slip_setup: drawn with --tread PROGRAM.)"])
            (self.folder / "slip_setup.png").write_bytes(b"drawn before")
            line, = paper.drawn("slip", None, self.folder)
        self.assertTrue(line.endswith(f"]({self.folder.name}/slip_setup.png)"), line)
        self.assertEqual((self.folder / "slip_setup.png").read_bytes(), b"drawn before")

    def test_a_run_that_fails_says_why(self):
        wrong = Setup("", (State("slip_sand", ("grid.colour=1",)),), "slips")
        with self.assertRaisesRegex(RunError, "colour"), made(wrong, TREAD, TWINS):
            pass


if __name__ == "__main__":
    ensure_display()
    unittest.main()
