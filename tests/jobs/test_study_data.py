#!/usr/bin/python3
"""What `tread study` makes of its variants: limits, fronts, judgements and answers of made-up data with known answers."""

import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "jobs"), str(ROOT / "postprocess")]

import work_precision  # noqa: E402
from made_up_run import colours_of, make_run  # noqa: E402
from tread_post import Run  # noqa: E402
from tread_post.closed_forms import FORMS  # noqa: E402
from tread_post.convergence import limit_of  # noqa: E402
from tread_post.fronts import pareto_front  # noqa: E402
from tread_post.orders import order_sentences  # noqa: E402
from tread_post.quantities import QUANTITIES, Quantity, window_of  # noqa: E402
from tread_post.references import Variant, from_file, judge, known_value  # noqa: E402
from tread_post.study_table import Row, Study, read_study, study_text  # noqa: E402


class Limits(unittest.TestCase):
    def test_orders_and_limits_are_found(self):
        for order in (0.7, 1.0, 1.5, 2.0):
            for sizes in ((0.1, 0.05, 0.025), (0.09, 0.04, 0.03), (0.03, 0.02, 0.4, 0.015)):
                found = limit_of(sizes, [3 - 5 * size**order for size in sizes])
                self.assertAlmostEqual(found.order, order, 9)
                self.assertAlmostEqual(found.value, 3, 9)
                finest = 5 * min(sizes) ** order
                self.assertAlmostEqual(found.uncertainty, 1.25 * finest, 9)

    def test_orders_that_nobody_believes_are_taken_with_care(self):
        for order, used in ((0.2, 0.5), (4.0, 2.0), (9.0, 2.0)):
            found = limit_of((4, 2, 1), [size**order for size in (4, 2, 1)])
            correction = (2**order - 1) / (2**used - 1)
            self.assertAlmostEqual(found.order, order, 9)
            self.assertAlmostEqual(found.uncertainty, 3 * correction, 9)
            # An order under 0.5 or over 4 leads nowhere that could be named: the finest value stays.
            self.assertAlmostEqual(found.value, 1 - correction if order == 4 else 1.0, 9)
            self.assertEqual(found.is_limit, order == 4)
            self.assertEqual(found.text, {0.2: "unconverged: order 0.2, under 0.5", 4.0: "extrapolated, order 4, taken as 2", 9.0: "unconverged: order 9, over 4"}[order])

    def test_more_than_three_are_fitted_and_state_their_range(self):
        """5 - 2 h + 30 h^3: of first order at the fine end, but not in the coarse three."""
        sizes = (0.08, 0.06, 0.04, 0.02)
        found = limit_of(sizes, [5 - 2 * size + 30 * size**3 for size in sizes])
        self.assertTrue(found.is_limit)
        low, high = found.order_range
        coarse = limit_of(sizes[:3], [5 - 2 * size + 30 * size**3 for size in sizes[:3]])
        fine = limit_of(sizes[1:], [5 - 2 * size + 30 * size**3 for size in sizes[1:]])
        self.assertAlmostEqual(low, min(coarse.order, fine.order, found.order))
        self.assertAlmostEqual(high, max(coarse.order, fine.order, found.order))
        print(f"5 - 2 h + 30 h^3: {found.text}, {found.value:.5f} +- {found.uncertainty:.5f}; right: 5")
        self.assertLess(abs(found.value - 5), found.uncertainty)
        self.assertGreaterEqual(found.uncertainty, abs(coarse.value - found.value))

    def test_noise_widens_both_and_takes_an_order_away(self):
        """5 - 2 h with three values, exactly of first order: the range is that of the stated noise alone."""
        sizes = (0.04, 0.02, 0.01)
        values = np.array([5 - 2 * size for size in sizes])
        quiet, noisy = (limit_of(sizes, values, noise=[noise] * 3) for noise in (1e-4, 1e-3))
        for found, noise in ((quiet, 1e-4), (noisy, 1e-3)):
            low, high = found.order_range
            # p = log2((f3 - f2)/(f2 - f1)): d p = sqrt(e^2/d32^2 + e^2 (1/d32 + 1/d21)^2 + e^2/d21^2) / ln 2, to first order in e.
            expected = noise * math.hypot(1 / 0.04, 1 / 0.04 + 1 / 0.02, 1 / 0.02) / math.log(2)
            print(f"noise {noise}: order {found.order:.4f} ({low:.4f} to {high:.4f}); expected +- {expected:.4f}; tolerance 10 %, as noise is finite")
            self.assertAlmostEqual(found.order, 1, 9)
            self.assertLess(abs((high - low) / 2 / expected - 1), 0.1)
        self.assertGreater(noisy.uncertainty, quiet.uncertainty)
        lost = limit_of(sizes, values, noise=[0.02] * 3)
        self.assertTrue(lost.text.startswith("unconverged"), lost)
        self.assertFalse(lost.is_limit)

    def test_noisy_series_of_known_order_hold_the_limit(self):
        """The stated uncertainty must hold the right limit in most of 200 noisy series: 1.25 |f0 - f1| is meant for 95 % (Roache)."""
        random, sizes = np.random.default_rng(7), np.array((0.04, 0.03, 0.02, 0.015, 0.01))
        for order in (0.7, 1.0, 2.0):
            held = named = 0
            for _ in range(200):
                values = 50 + 40 * (sizes / 0.04) ** order + random.normal(0, 0.2, len(sizes))
                found = limit_of(sizes, values, noise=[0.2] * len(sizes))
                named += found.is_limit
                held += found.is_limit and abs(found.value - 50) <= found.uncertainty
            print(f"order {order}: named in {named} of 200, limit held in {held}; expected 95 % of the named ones; tolerance: at least 90 %")
            self.assertGreater(named, 100)
            self.assertGreaterEqual(held, 0.9 * named)

    def test_without_monotone_convergence_the_spread_is_told(self):
        for values in ((1.0, 1.4, 1.1), (1.0, 1.1, 1.3), (1.0, 1.1, 1.2)):  # back and forth; ever faster away; as fast, which is order 0
            found = limit_of((0.4, 0.2, 0.1), values)
            self.assertIsNone(found.order)
            self.assertEqual(found.value, values[2])
            self.assertAlmostEqual(found.uncertainty, max(values) - min(values))
            self.assertIn("unconverged: no monotone convergence", found.text)
            self.assertIsNone(found.order_range)
        self.assertIn("unconverged", limit_of((0.8, 0.4, 0.2, 0.1), (1.5, 1.0, 1.4, 1.1)).text)
        coarse = limit_of((0.8, 0.4, 0.2, 0.1), (-1.0, 1.4, 1.2, 1.1))
        self.assertEqual((coarse.text, round(coarse.value, 9)), ("extrapolated, order 1, without the 1 coarsest", 1.0))

    def test_too_little_and_noise(self):
        self.assertTrue(math.isnan(limit_of((0.1,), (1.0,)).uncertainty))
        two = limit_of((0.1, 0.2), (1.0, 1.3))
        self.assertEqual((two.value, two.order), (1.0, None))
        self.assertAlmostEqual(two.uncertainty, 0.3)
        noisy = limit_of((4, 2, 1), (1.04, 1.02, 1.01), scatter=0.02)
        self.assertEqual((noisy.value, noisy.uncertainty, noisy.order), (1.01, 0.04, None))
        self.assertAlmostEqual(limit_of((4, 2, 1), (1.3, 1.0, 1.0)).uncertainty, 0.3)


class Fronts(unittest.TestCase):
    def test_front(self):
        rows = [(1, 0.5), (2, 0.5), (3, 0.1), (2.5, 0.2), (4, 0.15), (5, math.nan), (6, 0.1), (0.5, math.inf)]
        self.assertEqual(pareto_front(rows, lambda row: row[0], lambda row: row[1]), [(1, 0.5), (2.5, 0.2), (3, 0.1)])
        self.assertEqual(pareto_front([], lambda row: row, lambda row: row), [])

    def rows(self, errors, quantity="torque", uncertainty=0.004, scatter=math.nan):
        """Spacings 0.04, 0.03, 0.02, of 1, 5 and 41 s."""
        return [Row(f"{number:04}", {"grid.spacing": spacing, "time.substeps": "12"}, "", "done", "", 1e3, 1, 100, 100, wall, 1e6, quantity, "N m", 1.0, 1.0,
                    uncertainty, scatter, error, "order 1")
                for number, (spacing, wall, error) in enumerate(zip(("0.04", "0.03", "0.02"), (1, 5, 41), errors))]

    def test_sentences(self):
        rows = self.rows((0.08, 0.015, 0.002), scatter=0.003)
        self.assertEqual(work_precision.sentence(rows, 0.02),
                         "torque within 2 %: spacing 0.03, substeps 12; 8.2 times cheaper than the dearest (5 s against 41 s); "
                         "what is right is known to 0.4 % (order 1); perturbed repeats scatter by 0.3 %")
        self.assertIn("spacing 0.04, substeps 12; 41 times cheaper", work_precision.sentence(rows, 0.1))
        self.assertEqual(work_precision.sentence(rows, 0.001),
                         "torque: nothing can be said within 0.1 %: what is right is known to 0.4 % (order 1)")
        none = work_precision.sentence(self.rows((0.08, 0.07, 0.06)), 0.02)
        self.assertIn("no variant is within 2 %; the best of the others is off by 6 % (spacing 0.02", none)
        self.assertIn("nothing can be said", work_precision.sentence(self.rows((0.01, 0.01, 0.01), uncertainty=math.nan), 0.02))

    def test_the_runs_own_verdict_is_passed_on(self):
        rows = [Row(**{**vars(row), "verdict": verdict}) for row, verdict in zip(self.rows((0.01, 0.01, 0.01)), ("under-resolved", "resolved", ""))]
        self.assertTrue(work_precision.sentence(rows, 0.02).endswith("; the run calls itself under-resolved"))
        self.assertTrue(work_precision.sentence(rows[1:], 0.02).endswith("(order 1)"))

    def test_sentence_of_all(self):
        both = Study([], ["grid.spacing"], self.rows((0.01, 0.03, 0.001)) + self.rows((0.09, 0.01, 0.02), "sinkage"))
        self.assertEqual(work_precision.sentence_of_all(both, 0.035),
                         "torque, sinkage together within 3.5 %: spacing 0.03, substeps 12; 8.2 times cheaper than the dearest (5 s against 41 s)")
        unknown = Study([], ["grid.spacing"], self.rows((0.01, 0.03, 0.001)) + self.rows((0.09, 0.01, 0.02), "sinkage", uncertainty=0.5))
        self.assertEqual(work_precision.sentence_of_all(unknown, 0.05), "")

    def test_repeats_and_failures_are_no_candidates(self):
        rows = self.rows((0.01, 0.01, 0.01))
        spoilt = [Row(**{**vars(rows[0]), "repeat": "1e-09 m"}), Row(**{**vars(rows[1]), "state": "failed"}), rows[2]]
        self.assertIn("spacing 0.02, substeps 12; the dearest variant", work_precision.sentence(spoilt, 0.02))

    def test_sentences_of_order(self):
        """Torque 10 + 50 h + what is asked for; pull back and forth."""
        def study(torque, verdict="marginal", noise=0.0):
            rows = []
            for name, values in (("torque", torque), ("drawbar_pull", (3.0, 5.0, 4.0))):
                rows += [Row(**{**vars(row), "measured": value, "quantity": name, "verdict": verdict, "noise": noise})
                         for row, value in zip(self.rows((0.1, 0.1, 0.1)), values)]
            return Study([], ["grid.spacing", "time.substeps"], rows)

        lines = order_sentences(study([10 + 50 * size for size in (0.04, 0.03, 0.02)], noise=0.01))
        self.assertRegex(lines[0], r"^torque in spacing: order 1 \(0\.86 to 1\.1\), of 3 values; extrapolated 10\.0 \+- 1\.3 N m; "
                                   r"11\.000 \+- 0\.010 N m at spacing 0\.02; the finest run calls itself marginal$")
        self.assertRegex(lines[1], r"^drawbar_pull in spacing: unconverged: no monotone convergence.*; 4\.000 \+- 0\.010 N m at spacing 0\.02, in doubt by 2;")
        self.assertEqual(len(lines), 2)  # substeps do not vary
        slow = order_sentences(study([10 + 50 * size**0.3 for size in (0.04, 0.03, 0.02)], verdict="resolved"))[0]
        self.assertRegex(slow, r"^torque in spacing: unconverged: order 0\.3, under 0\.5; \S+ N m at spacing 0\.02, in doubt by [\d.]+$")

    def test_table_and_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "study.csv"
            rows = self.rows((0.08, math.nan, 0.002)) + self.rows((0.02, 0.01, 1e-12), "sinkage")
            path.write_text(study_text(["Of a wheel", "on sand"], ["grid.spacing", "time.substeps"], rows), encoding="utf-8")
            study = read_study(path)
            self.assertEqual((study.comments, study.keys, study.quantities), (["Of a wheel", "on sand"], ["grid.spacing", "time.substeps"], ["torque", "sinkage"]))
            skipped = {"error": 0, "scatter": 0, "noise": 0}  # NaN is not itself
            self.assertEqual([vars(row) | skipped for row in study.rows], [vars(row) | skipped for row in rows])
            self.assertTrue(math.isnan(study.rows[1].error))
            done = subprocess.run([sys.executable, str(ROOT / "postprocess" / "work_precision.py"), str(path), "--within", "0.02"], capture_output=True,
                                  text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, r"\* 0002 +0.02 +12 .* 0.2 %")
            self.assertGreater(colours_of(path.with_suffix(".png")), 10)
            for text in ("", "a,b\n1,2\n"):
                path.write_text(text, encoding="utf-8")
                done = subprocess.run([sys.executable, str(ROOT / "postprocess" / "work_precision.py"), str(path)], capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 1)
                self.assertRegex(done.stderr, "no table of a study|no rows")


class Judgement(unittest.TestCase):
    """Variants whose answer is 7 + 3 h + 0.5 dt^2, and 0.01 more in single precision."""

    number = Quantity("N", lambda run: run, "")

    def variant(self, name, h, dt, precision, own=False, perturbed=False, shift=0.0):
        value = 7 + 3 * h + 0.5 * dt**2 + (0.01 if precision == "single" else 0.0) + shift
        return Variant(name, {"grid.spacing": h, "time.dt": dt, "numerics.precision": precision}, value, own, perturbed)

    def grid(self):
        return [self.variant(f"{h} {dt} {p}", h, dt, p) for h in (0.4, 0.2, 0.1) for dt in (0.8, 0.4, 0.2) for p in ("single", "double")]

    def test_corrections_of_a_grid_add_up(self):
        judged = judge(self.grid(), self.number, None, "grid")
        self.assertAlmostEqual(judged.reference.value, 7, 9)
        self.assertAlmostEqual(judged.errors["0.4 0.8 single"], (1.2 + 0.32 + 0.01) / 7, 9)
        self.assertIn("variant 0.1 0.2 double; grid.spacing: extrapolated, order 1; time.dt: extrapolated, order 2", judged.reference.text)
        self.assertAlmostEqual(judged.reference.uncertainty, 1.25 * math.hypot(0.3, 0.02), 9)

    def test_corrections_of_a_star_add_up_around_the_scene_itself(self):
        star = [self.variant("own", 0.2, 0.4, "single", own=True), self.variant("h", 0.1, 0.4, "single"), self.variant("H", 0.4, 0.4, "single"),
                self.variant("t", 0.2, 0.2, "single"), self.variant("T", 0.2, 0.8, "single"), self.variant("p", 0.2, 0.4, "double")]
        judged = judge(star, self.number, None, "star")
        self.assertAlmostEqual(judged.reference.value, 7, 9)
        repeats = [self.variant(f"r{number}", 0.2, 0.4, "single", perturbed=True, shift=shift) for number, shift in enumerate((-1e-3, 1e-3))]
        judged = judge(star + repeats, self.number, None, "star")
        self.assertAlmostEqual(judged.scatter, 1e-3, 9)
        self.assertAlmostEqual(judged.reference.value, 7, 2)
        self.assertIn("mean of 3 perturbed repeats", judged.reference.text)

    def test_what_does_not_converge_corrects_nothing(self):
        wavering = [Variant(str(h), {"grid.spacing": h}, value, h == 0.4, False) for h, value in ((0.4, 5.0), (0.2, 5.6), (0.1, 5.3))]
        judged = judge(wavering, self.number, None, "star")
        self.assertEqual(judged.reference.value, 5.0)
        self.assertAlmostEqual(judged.reference.uncertainty, 0.6)
        self.assertTrue(math.isnan(judged.errors["0.4"]))

    def test_what_is_known_is_not_extrapolated(self):
        judged = judge(self.grid(), self.number, known_value(8.0, 0.15, "two laboratories"), "grid")
        self.assertEqual((judged.reference.value, judged.reference.uncertainty), (8.0, 1.2))
        self.assertAlmostEqual(judged.errors["0.1 0.2 double"], abs(7.32 - 8) / 8, 9)

    def test_without_refinement_a_variant_is_compared_with_itself(self):
        words = [Variant(word, {"numerics.narrow_phase": word}, value, word == "sdf", False) for word, value in (("sdf", 2.0), ("rays", 2.5))]
        judged = judge(words, self.number, None, "star")
        self.assertIn("nothing that refines was varied", judged.reference.text)
        self.assertTrue(math.isnan(judged.errors["sdf"]))
        self.assertAlmostEqual(judged.errors["rays"], 0.25)

    def test_curves_are_compared_with_the_finest(self):
        place = np.linspace(0, 1, 11)
        curve = Quantity("m", lambda run: place * (1 + run), "")
        variants = [Variant(str(h), {"grid.spacing": h}, h, False, False) for h in (0.4, 0.2, 0.1)]
        judged = judge(variants, curve, None, "grid")
        rms = math.sqrt(np.mean(place**2))
        self.assertTrue(math.isnan(judged.errors["0.1"]))
        self.assertAlmostEqual(judged.errors["0.4"], 0.3 * rms / 1.1)
        self.assertAlmostEqual(judged.reference.uncertainty, 0.1 * rms / 1.1)
        # In the middle of a star, finer ones tell; an "auto" has no size.
        star = [Variant(str(h), {"grid.spacing": h, "time.dt": "auto"}, h, h == 0.2, False) for h in (0.4, 0.2, 0.1)]
        star.append(Variant("dt", {"grid.spacing": 0.2, "time.dt": 1e-4}, 0.25, False, False))
        judged = judge(star, curve, None, "star")
        self.assertAlmostEqual(judged.reference.uncertainty, math.hypot(0.1, 0.05) * rms / 1.2)


class Answers(unittest.TestCase):
    def test_of_a_drive(self):
        with tempfile.TemporaryDirectory() as folder:
            make_run(Path(folder) / "run")
            run = Run(Path(folder) / "run")
            self.assertAlmostEqual(window_of(run).time[0], 2.06, 2)  # half of 1.1 to 3 s, at rows 0.02 s apart
            self.assertAlmostEqual(QUANTITIES["torque"].measure(run), 45, 0)
            self.assertAlmostEqual(QUANTITIES["drawbar_pull"].measure(run), 40, 9)
            self.assertAlmostEqual(QUANTITIES["sinkage"].measure(run), 0.03, 3)
            profile = QUANTITIES["profile"].measure(run)
            # The rut behind the wheel at x = 0.62 m, of a bed of 1 m.
            self.assertAlmostEqual(profile[8] - profile[20], -0.03, 2)
            table = Path(folder) / "known.csv"
            table.write_text("# of a laboratory\ntime,torque\n0,0\n1,50\n4,50\n", encoding="utf-8")
            self.assertEqual(from_file(table, "torque", QUANTITIES["torque"], run).value, 50)
            self.assertIsNone(from_file(table, "sinkage", QUANTITIES["sinkage"], run))

    def test_forms_name_what_a_scene_lacks(self):
        self.assertIn("[[body]]", FORMS["hertz-impact"].needs({"body": []}))
        self.assertIn("mass or load", FORMS["weight"].needs({"body": [{"density": 1.0}]}))
        self.assertEqual(FORMS["weight"].needs({"body": [{"mass": 1.0}]}), "")
        self.assertIn("leans", FORMS["rolling-ball"].needs({"body": [{"diameter": 1, "mass": 1}], "domain": {"gravity": [0, 0, -9.8]}}))
        ball = {"body": [{"diameter": 1, "mass": 1}], "domain": {"gravity_size": 9.8, "slope_deg": -5}}
        self.assertEqual(FORMS["rolling-ball"].needs(ball), "")
        ball["domain"]["slope_direction_deg"] = 90
        self.assertIn("leans", FORMS["rolling-ball"].needs(ball))


if __name__ == "__main__":
    unittest.main()
