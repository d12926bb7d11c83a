#!/usr/bin/python3
"""The rows of docs/paper.md judged by their criteria, from made-up runs. Needs what postprocess/ needs."""

import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest
import unittest.mock
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "postprocess"), str(ROOT / "studies")]

import paper  # noqa: E402
from made_up_run import MORE, SCENE, SPEED, make_run  # noqa: E402
from tread_paper import answers, cost, criteria, formulas  # noqa: E402
from tread_paper.criteria import Number  # noqa: E402
from tread_paper.document import CAMPAIGNS, IN_SHORT, OTHERS, TITLES, Document, campaign_lines, put_into  # noqa: E402
from tread_paper.measures import Absent, Measures, in_scene  # noqa: E402
from tread_paper.runs import Plan, contradicted  # noqa: E402
from tread_post import RunError  # noqa: E402

DOCS = ROOT / "docs"
CRITERIA = ROOT / "configs" / "paper" / "round2"
PLAN = """
[[run]]
name = "mixed"
scene = "configs/paper/slip_mixed.toml"
set = ["time.contact_share=0.4", "output.snapshots_every=1"]
repeats = [["rocks[0].seed=11"]]
coarser = "mixed_coarse"
stage = 2
seconds = 600
[[run]]
name = "mixed_coarse"
scene = "configs/paper/slip_mixed.toml"
stage = 1
seconds = 10
[[run]]
name = "steps"
scene = "configs/paper/slip_sand.toml"
values = { key = "time.substeps", list = [2, 5] }
stage = 1
seconds = 20
"""
JUDGED_SUMMARY = """{"status": "finished", "commit": "abc", "phases": [{"name": "settle", "settled": true}, {"name": "lower", "settled": null, "end": "lowered"}],
 "resolution": {"verdict": "marginal", "figures": {"torque_error": {"value": 0.1, "resolved": 0.05, "marginal": 0.2, "verdict": "marginal"}}}}"""


class Judging(unittest.TestCase):
    """Criteria against made-up runs: `mixed` and its repeat, whose torques are 44 and 46 N m, and coarse ones of 55."""

    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.directory.name)
        cls.runs = cls.folder / "runs"
        for name, factor in (("mixed", 44 / 45), ("mixed_2", 46 / 45), ("mixed_coarse", 55 / 45)):
            make_run(cls.runs / name)
            scene = SCENE.replace('shape = "drum"\n[[phase]]', f'shape = "drum"\n{MORE}[[phase]]', 1)
            (cls.runs / name / "scene.toml").write_text(f"{scene}[output]\nsnapshots_every = {int(name == 'mixed')}\n", encoding="utf-8")
            (cls.runs / name / "summary.json").write_text(JUDGED_SUMMARY, encoding="utf-8")
            with h5py.File(cls.runs / name / "timeseries.h5", "r+") as file:
                file["wheel/front wheel/torque"][...] *= factor
        (cls.folder / "runs.toml").write_text(PLAN, encoding="utf-8")
        cls.plan, cls.measures = Plan(cls.folder / "runs.toml"), Measures(cls.runs)
        cls.theories = formulas.Theories(cls.plan, ROOT, cls.measures)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def verdict(self, seen=None, because=None, **row):
        return criteria.Table(self.plan, self.measures, self.theories, seen or {}, because).cells({"what": "a", "paper": "b", "source": "text", **row})[-1]

    def test_windows_of_events(self):
        measure = self.measures
        self.assertAlmostEqual(measure("mixed mean speed end-0.5 end"), SPEED, 6)
        self.assertAlmostEqual(measure("mixed mean speed way:0.05 end-0.1"), SPEED, 6)
        self.assertAlmostEqual(measure("mixed mean speed touch+1 touch+2"), SPEED, 6)
        self.assertAlmostEqual(measure("mixed kink speed 0 1"), 0.2, delta=0.05)  # where the ramp ends
        self.assertEqual(measure("mixed scene domain.gravity.2"), -3.72)
        self.assertEqual(measure("mixed scene material.sand.friction_angle_deg"), 29)
        self.assertEqual(measure("mixed settled settle"), 1)
        self.assertEqual(measure("mixed weight"), 635)
        for text in ("mixed mean speed dawn end", "mixed scene domain.colour"):
            with self.assertRaises(RunError):
                measure(text)
        with self.assertRaises(Absent):
            measure("mixed mean speed way:9 end")

    def test_a_run_that_was_cut_off_has_no_end(self):
        shutil.copytree(self.runs / "mixed", self.runs / "cut")
        (self.runs / "cut" / "summary.json").write_text('{"status": "stopped"}', encoding="utf-8")
        self.assertAlmostEqual(self.measures("cut mean speed 1 2"), SPEED, 6)
        for text in ("cut mean speed 1 end", "cut last speed", "cut summary wall_s"):
            with self.assertRaisesRegex(Absent, "cut ends after"):
                self.measures(text)

    def test_a_row_says_what_it_rests_on(self):
        table = criteria.Table(self.plan, self.measures, self.theories, {})
        row = {"what": "Torque", "paper": "about 50", "source": "figure", "measure": "mixed mean torque 1 2", "unit": "N m", "format": "{:.1f}", "expected": 50.0,
               "relative": 0.15, "basis": "about", "window": "late", "grid": "torque", "formula": "2 * 25", "formula_unit": "N m"}
        self.assertEqual(table.cells(row), (
            "Torque", "about 50 (read off the figure)", "50 N m ± 15 %; late; about", "50 N m", "44.9 ± 1.0 (grid 10.0) N m",
            "mixed, 2 of 2: marginal, settled, lowered, abc; `--set time.contact_share=0.4`",
            "agrees; the error of the grid is larger than the tolerance"))

    def test_a_repeat_counts_where_it_got(self):
        summary = self.runs / "mixed_2" / "summary.json"
        self.addCleanup(summary.write_text, JUDGED_SUMMARY, encoding="utf-8")
        summary.write_text('{"status": "stopped", "commit": "abc"}', encoding="utf-8")
        table = criteria.Table(self.plan, Measures(self.runs), self.theories, {})
        row = {"what": "a", "paper": "b", "source": "text", "expected": 45.0, "tolerance": 3.0, "basis": "c"}
        for measure, counted in (("mixed mean torque 1 2", "mixed, 2 of 2"), ("mixed mean torque 1 end", "mixed, 1 of 2"), (["mixed last way", "mixed mean torque 1 2"], "mixed, 1 of 2")):
            self.assertIn(counted, table.cells({**row, "measure": measure})[-2])

    def test_verdicts_in_tolerances(self):
        torque = {"measure": "mixed mean torque 1 2", "unit": "N m", "basis": "c"}
        self.assertEqual(self.verdict(**torque, expected=60.0, tolerance=5.0), "differs by 3.0 tolerances of 5 N m; the error of the grid is larger than the tolerance; why is open")
        # The repeats, 2 N m apart, widen a tolerance of 1 N m to 2.
        self.assertTrue(self.verdict(**torque, expected=46.5, tolerance=1.0).startswith("agrees"))
        self.assertTrue(self.verdict(**torque, at_least=49.0, tolerance=5.0).startswith("agrees"))
        self.assertTrue(self.verdict(**torque, at_most=30.0, tolerance=5.0).startswith("differs by 3.0 tolerances"))
        pair = {"measure": ["mixed mean torque 1 2", "mixed_coarse mean torque 1 2"], "unit": "N m", "basis": "c"}
        self.assertTrue(self.verdict(**pair, order="<", tolerance=5.0).startswith("agrees"))
        self.assertTrue(self.verdict(**pair, order="<", tolerance=20.0).startswith("undecided: 0.5 tolerances of 20 N m apart"))
        self.assertTrue(self.verdict(**pair, order=">", tolerance=5.0).startswith("differs by 2.0 tolerances"))
        self.assertTrue(self.verdict(**pair, equal=True, tolerance=6.0).startswith("agrees"))
        self.assertTrue(self.verdict(**pair, ratio=True, expected=45 / 55, tolerance=0.01).startswith("agrees"))
        self.assertEqual(self.verdict(measure="steps_5 last way", expected=1.0, tolerance=1.0, basis="c"), "not run: steps_5 was not run")
        self.assertEqual(self.verdict(measure="steps_5 last way", impossible="too long", formula="1"), "impossible in the paper: too long")
        self.assertEqual(self.verdict(measure=["mixed last slip", "steps_5 last way"], shown="another card"), "not judged: another card")
        self.assertEqual(self.verdict(by_eye="a track"), "not looked at yet")
        seen = {"a": answers.Seen(False, "a track, at abc", "slip.png")}
        self.assertEqual(self.verdict(seen=seen, by_eye="a track"), "read off the figure by eye: differs: a track, at abc ([figure](paper/slip.png))")

    def test_a_reason_has_the_numbers_of_runs(self):
        torque = {"measure": "mixed mean torque 1 2", "unit": "N m", "basis": "c", "expected": 60.0, "tolerance": 15.0}
        path = self.folder / "because.toml"
        path.write_text('[[because]]\nwhat = ["a"]\ntext = "coarse it is {:.0f} kN m"\nmeasure = ["mixed_coarse mean torque 1 2"]\nscale = 1e-3\n', encoding="utf-8")
        because = answers.because_in(path)
        self.assertEqual(self.verdict(because=because, **torque), "differs by 1.0 tolerances of 15 N m; because coarse it is 0 kN m")
        self.assertTrue(self.verdict(because=because, **{**torque, "tolerance": 16.0}).startswith("agrees"))
        self.assertTrue(self.verdict(because={"b": because["a"]}, **torque).endswith("; why is open"))
        gone = answers.Because("it is {:.0f}", ("steps_5 last way",), (1.0,))
        self.assertTrue(self.verdict(because={"a": gone}, **torque).endswith("; why is open"))
        self.assertEqual(answers.because_in(self.folder / "none.toml"), {})
        for bad, words in (('[[because]]\nwhat = ["a"]\n', "needs text, what"), ('[[because]]\nwhat = ["a", "a"]\ntext = "b"\n', "two reasons"),
                           ('[[because]]\nwhat = ["a"]\ntext = "b"\nmeasure = ["c"]\nscale = [1, 2]\n', "1 measures, 2 scales")):
            path.write_text(bad, encoding="utf-8")
            with self.assertRaisesRegex(RunError, words):
                answers.because_in(path)

    def test_counts(self):
        verdicts = ["agrees", "agrees; the error of the grid is larger than the tolerance", "differs by 2 tolerances of 1; why is open",
                    "differs by 2 tolerances of 1; because of x", "undecided: 0.1 tolerances of 1 apart", "not run: x was not run",
                    "read off the figure by eye: agrees: a track", "read off the figure by eye: differs: none", "not looked at yet"]
        lines = criteria.counts_of({"3.1": verdicts[:4], "3.2": verdicts[4:]})
        self.assertTrue(" ".join(lines).startswith("**9 rows, of which runs judge 5: 2 agree, 2 differ, 1 are undecided.** Of the 2 that agree, 1 have"))
        self.assertEqual(lines[-3:], ["| 3.1 | 4 | 2 | 1 | 1 |  |  |  |  |  |  |  |  |", "| 3.2 | 5 |  |  |  | 1 |  | 1 |  |  | 1 | 1 | 1 |",
                                      "| all | 9 | 2 | 1 | 1 | 1 |  | 1 |  |  | 1 | 1 | 1 |"])

    def test_runs_that_were_not_made(self):
        lines = cost.not_run_lines(self.plan, self.measures, [({"measure": "steps_5 last way"}, "not run: steps_5 was not run")])
        self.assertEqual(lines[0], "3 of the 5 runs of the list are stored. The others need 40 s of one H200 together.")
        self.assertEqual(lines[4:], ["| steps_2 | 20 | 1 | 0 |", "| steps_5 | 20 | 1 | 1 |"])

    def test_rows_are_counted_by_reading(self):
        rows = [({"what": "Gravity 9.8: torque"}, "agrees; coarse"), ({"what": "Gravity 9.8: speed"}, "differs by 2"), ({"what": "Crust: slip"}, "not judged: x")]
        self.assertEqual(cost.readings_lines(rows)[2:], ["| Gravity 9.8 | 2 | 1 | 1 | 0 |"])

    def test_the_worst_number_decides(self):
        numbers = [Number(10.0, None, None), Number(14.0, 1.0, None), Number(13.0, None, None)]
        row = {"what": "a", "tolerance": 1.5}
        self.assertEqual(criteria.deviation_of({**row, "order": "<"}, numbers), (-0.5, 2.0, False))
        self.assertEqual(criteria.deviation_of({**row, "order": "<"}, numbers[:2]), (0.0, 2.0, True))
        self.assertEqual(criteria.deviation_of({**row, "expected": [10, 14, 16]}, numbers), (2.0, 1.5, True))
        exact = {"what": "a", "expected": 10, "tolerance": 0}
        self.assertEqual(criteria.deviation_of(exact, numbers[:1])[0], 0.0)
        self.assertEqual(criteria.deviation_of(exact, numbers[2:])[0], np.inf)
        with self.assertRaises(RunError):
            criteria.deviation_of({**row, "expected": [10, 14]}, numbers)
        self.assertAlmostEqual(criteria.ratio_of(Number(10.0, 1.0, None), Number(5.0, 0.0, 0.5)).spread, 0.2)

    def test_unsound_rows(self):
        path = self.folder / "unsound.toml"
        for bad, words in (('measure = "a b c"', "one judge"), ('measure = "a b c"\nexpected = 1', "tolerance or relative"),
                           ('measure = "a b c"\nexpected = 1\ntolerance = 1', "basis"), ('by_eye = "x"\nimpossible = "y"', "one of"),
                           ('by_eye = "x"\nexpected = 1\ntolerance = 1\nbasis = "c"', "one judge"), ('by_eye = "x"\nverdict = "agrees"', "unknown: verdict"),
                           ('impossible = "x"\npaper_value = 2\nformula = "1 + 1"', "does not contradict")):
            path.write_text(f'[[row]]\nwhat = "a"\npaper = "b"\nsource = "text"\n{bad}\n', encoding="utf-8")
            with self.assertRaisesRegex(RunError, words):
                criteria.rows_of(path)

    def test_arithmetic(self):
        self.assertAlmostEqual(formulas.arithmetic("sqrt(2 * 0.7 / 9.8)"), 0.378, 3)
        self.assertAlmostEqual(formulas.arithmetic("-300000 * pi / 6 * 0.01 ** 3"), -0.157, 3)
        for bad in ("__import__('os')", "1 +", "1 / 0", "x"):
            with self.assertRaises(RunError):
                formulas.arithmetic(bad)

    def test_theories_beside_our_numbers(self):
        self.assertRegex(self.theories("bearing_capacity steps_2"), r"^bearing capacity 2\d mm$")
        for text in ("wong_reece sinkage steps_2 0.3", "resistive_force torque steps_2 0.3", "resistive_force speed_share steps_2 free",
                     "wong_reece_at torque mixed own 1 2"):
            self.assertRegex(self.theories(text), r" -?\d")
        # Pressure that carries the weight at the sinkage that the formula itself gives is the formula.
        wheel, soil = formulas.wong_reece.Wheel(0.26, 0.33, 635.0), formulas.wong_reece.PUBLISHED[0]
        alone = formulas.wong_reece.predict(wheel, soil, 0.3)
        again = formulas._at_sinkage(wheel, soil, 0.3, alone.sinkage)
        self.assertAlmostEqual(again.torque, alone.torque, 1)
        with self.assertRaises(RunError):
            self.theories("guess torque mixed 0.3")

    def test_the_queue(self):
        queue = self.plan.queue()
        self.assertEqual([run.name for run in queue], ["steps_2", "steps_5", "mixed_coarse", "mixed", "mixed_2"])
        self.assertEqual(queue[3].command("tread", "runs"), "tread run configs/paper/slip_mixed.toml --set time.contact_share=0.4 --set output.snapshots_every=1 "
                         "--output runs/mixed --quiet --restart auto --walltime-limit 00:08:30")
        self.assertIn("--set 'rocks[0].seed=11' --set output.snapshots_every=0 --output runs/mixed_2", queue[4].command("tread", "runs"))
        self.assertIn("--set time.substeps=5 ", queue[1].command("tread", "runs"))
        done = subprocess.run([ROOT / "studies" / "paper_queue.py", "--list", self.folder / "runs.toml", "--stages", "1"], capture_output=True, text=True, check=True)
        self.assertTrue(done.stdout.startswith("steps_2|20|tread run configs/paper/slip_sand.toml "))
        self.assertEqual(len(done.stdout.splitlines()), 3)
        for bad in (PLAN.replace("stage = 2", "hue = 2"), PLAN + PLAN, PLAN.replace('coarser = "mixed_coarse"', 'coarser = "none"')):
            (self.folder / "bad.toml").write_text(bad, encoding="utf-8")
            with self.assertRaises(RunError):
                Plan(self.folder / "bad.toml")

    def test_a_run_that_is_not_that_of_the_list(self):
        scene = {"time": {"substeps": 100}, "rocks": [{"seed": 11}], "phase": [{"name": "lower", "duration": 2.0}], "numerics": {"point_motion": "frozen"},
                 "body": [{"name": "wheel", "position": [0.3, 0.4, 0.7]}]}
        settings = ["time.substeps=50", "time.substeps=100", "rocks[0].seed=11", 'phase.lower={name="lower",duration=2.0}', "numerics.point_motion=frozen",
                    'body.wheel.position=[0.3,0.4,"on surface"]', "body.wheel.gap=0.5"]
        self.assertEqual(contradicted(scene, settings), [])
        self.assertEqual(contradicted(scene, ["rocks[0].seed=1", "time.substeps=5"]), ["rocks[0].seed", "time.substeps"])

    def test_criteria_ask_what_there_is(self):
        plan, asked = Plan(CRITERIA / "runs.toml"), set()
        for case in criteria.CASES:
            for row in criteria.rows_of(CRITERIA / f"{case}.toml"):
                asked.update(criteria.measures_of(row))
                for text in row.get("beside", []):
                    plan.members(text.split()[2] if text.split()[0] != "bearing_capacity" else text.split()[1])
        with tempfile.TemporaryDirectory() as folder:
            measures = Measures(Path(folder))
            for text in asked:
                group, what, *rest = text.split()
                plan.members(group)
                scene = tomllib.loads((ROOT / plan.groups[group][0].scene).read_text(encoding="utf-8"))
                if what == "scene":
                    in_scene(scene, rest[0])
                    continue
                if not (Path(folder) / group).exists():
                    (Path(folder) / group).symlink_to(self.runs / "mixed")
                if what not in ("summary", "impact"):
                    try:
                        measures(text)
                    except Absent:
                        pass
        # Each run of the list is asked for, or is the coarser one of another.
        unused = set(plan.groups) - {text.split()[0] for text in asked} - set(plan.coarser.values())
        self.assertEqual(unused, set())

    def test_answers_are_those_of_rows(self):
        rows = [row for case in criteria.CASES for row in criteria.rows_of(CRITERIA / f"{case}.toml")]
        seen, because = answers.seen_in(CRITERIA / "seen.toml"), answers.because_in(CRITERIA / "because.toml")
        self.assertLessEqual(set(seen), {row["what"] for row in rows if "by_eye" in row})
        self.assertLessEqual(set(because), {row["what"] for row in rows if "measure" in row})
        for one in seen.values():
            self.assertTrue((DOCS / "paper" / one.figure).is_file(), one.figure)
        self.assertNotIn("agrees", "".join(one.text for one in because.values()))

    def test_the_document_is_made_of_the_criteria(self):
        text = (DOCS / "paper.md").read_text(encoding="utf-8")
        paper = Document(CRITERIA, ROOT / "studies" / "paper_round2", ROOT)
        for name in [*TITLES, *OTHERS]:
            self.assertEqual(put_into(text, name, paper.part(name)), text, name)
        if all((DOCS / "paper" / name / "campaign.h5").is_file() for name in CAMPAIGNS):
            self.assertEqual(put_into(text, "sensitivity", campaign_lines(DOCS / "paper")), text)
        short = (DOCS / "paper_in_short.md").read_text(encoding="utf-8")
        for name in IN_SHORT:
            self.assertEqual(put_into(short, name, paper.part(name)), short, name)
        for path in (DOCS / "paper").glob("*.png"):
            self.assertIn(f"](paper/{path.name})", text)
        for name in re.findall(r"\]\(paper/(\w+\.png)\)", text):
            self.assertTrue((DOCS / "paper" / name).is_file(), name)


if __name__ == "__main__":
    unittest.main()
