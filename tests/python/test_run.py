#!/usr/bin/env python3
"""Runs in a Python process: what callbacks see and do to a run, and how it ends."""

import gc
import os
import signal
import subprocess
import threading
import unittest

import h5py
import numpy

import tread
from package import BACKEND, BALL, SCENE, TREAD, PackageTest, sand_and_roller


def series(run):
    """All columns of a time series by name."""
    columns = {}
    with h5py.File(run.path / "timeseries.h5", "r") as file:
        file.visititems(lambda name, item: columns.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return columns


class Runs(PackageTest):
    def assert_same(self, one, other):
        mine, theirs = series(one), series(other)
        self.assertEqual(mine.keys(), theirs.keys())
        for name, column in mine.items():
            numpy.testing.assert_array_equal(column, theirs[name], name)

    def reason(self, run):
        return run.summary["reason"]

    def test_looking_changes_no_bit(self):
        scene = self.write("scene.toml", sand_and_roller())
        subprocess.run([TREAD, "run", scene, "--output", self.directory / "program", "--quiet", "--backend", BACKEND, "--threads", "1"], check=True)
        seen = []

        def look(state):
            seen.append((state.phase, state.over))
            state.body("roller"), state.points.position.sum(), state.points.stress.sum(), state.bodies.position.sum(), state.contacts.second

        looked = self.run_scene(sand_and_roller(), on_span=look, span_steps=1)
        self.assertGreater(len(seen), 4)
        self.assert_same(looked, tread.Run(self.directory / "program"))

    def test_visits_come_at_phases_spans_and_the_end(self):
        seen = []
        self.run_scene(BALL, on_span=lambda state: seen.append((state.phase, round(state.time, 9), state.over)), span=0.02)
        self.assertEqual(seen, [("first", 0.0, False), ("first", 0.02, False), ("first", 0.04, False), ("second", 0.05, False),
                                ("second", 0.06, False), ("second", 0.08, False), ("second", 0.1, True)])
        steps = []
        self.run_scene(BALL, "steps", on_span=lambda state: steps.append(state.steps), span_steps=30)
        self.assertEqual(steps, [0, 30, 50, 80, 100])

    def test_arrays_are_views_of_what_snapshots_show(self):
        kept = {}

        def look(state):
            if not state.over:
                return
            points, bodies = state.points, state.bodies
            self.assertFalse(points.position.flags.writeable or points.position.flags.owndata)
            self.assertEqual(numpy.shares_memory(points.position, points.position), BACKEND == "cpu")
            kept.update(id=points.id.copy(), position=points.position.copy(), velocity=points.velocity.copy(), stress=points.stress,
                        mass=points.mass.sum(), body=bodies.position.copy(), named=state.body("roller").position, turn=bodies.orientation.copy())
            with self.assertRaises(ValueError):
                points.velocity[0] = 1

        run = self.run_scene(sand_and_roller(), on_span=look)
        shown, bodies = run.points(run.snapshots[-1]), run.bodies(run.snapshots[-1])
        here, there = numpy.argsort(kept["id"]), numpy.argsort(shown.fields["id"])
        numpy.testing.assert_array_equal(kept["position"][here], shown.position[there])
        numpy.testing.assert_array_equal(kept["velocity"][here].astype(numpy.float32), shown.fields["velocity"][there])
        vtk = kept["stress"][here][:, [0, 1, 2, 5, 3, 4]].astype(numpy.float32)  # files have xy before yz and xz
        numpy.testing.assert_array_equal(vtk, shown.fields["stress"][there])
        numpy.testing.assert_array_equal(kept["body"], bodies.position)
        numpy.testing.assert_array_equal(kept["turn"][:, [3, 0, 1, 2]], bodies.orientation)
        numpy.testing.assert_array_equal(kept["named"], bodies.position[0])
        self.assertAlmostEqual(kept["mass"], 1600 * 0.4 * 0.4 * 0.1, places=4)

    def test_forces_are_means_since_the_last_callback(self):
        seen = []
        run = self.run_scene(sand_and_roller(), on_span=lambda state: seen.append((state.time, state.body("roller"))), span=0.005)
        wheel = run.wheel("roller")
        numpy.testing.assert_allclose([time for time, _ in seen], wheel["time"], atol=1e-12)
        forces = numpy.array([body.force for _, body in seen])
        scale = abs(wheel["force"]).max()
        error = abs(forces - wheel["force"]).max()
        print(f"largest force {scale:.3g} N; from what rows of the same spans have: {error:.3g} N, tolerance 1e-9 of it (rounding of sums of impulses)")
        self.assertGreater(scale, 1)
        self.assertLess(error, 1e-9 * scale)

    def test_parts_that_a_scene_lacks_are_none(self):
        seen = []
        self.run_scene(BALL, on_span=lambda state: seen.append((state.points.position, state.points.stress, state.bodies.mass.tolist())))
        self.assertEqual(seen[0], (None, None, [2.0]))
        self.run_scene(SCENE, "sand", on_span=lambda state: seen.append((state.bodies.mass, state.contacts.key, state.contacts.first)))
        self.assertEqual(seen[-1], (None, None, None))

    def test_an_array_that_is_kept_stops_the_run_and_stays_readable(self):
        ways = {"all": lambda state: state.points.position, "one": lambda state: state.points.position[0], "turned": lambda state: state.points.velocity.T}
        for name, keep in ways.items():
            kept, copies = [], []

            def look(state):
                kept.append(keep(state))
                copies.append(kept[0].copy())

            with self.assertRaisesRegex(BufferError, "still in use after the callback"):
                self.run_scene(SCENE, name, on_span=look)
            gc.collect()
            numpy.testing.assert_array_equal(kept[0], copies[0])

    def test_the_state_is_of_its_callback_only(self):
        states = []
        self.run_scene(BALL, on_span=states.append)
        with self.assertRaisesRegex(RuntimeError, "in its callback only"):
            states[0].body("ball")

    def test_errors_of_a_callback_stop_the_run_for_a_restart(self):
        whole = self.run_scene(sand_and_roller(), "whole")

        def fail(state):
            position = state.points.position
            if state.phase == "go":
                raise LookupError(f"at {position[0]}")

        with self.assertRaisesRegex(LookupError, "at "):
            self.run_scene(sand_and_roller(), on_span=fail)
        stopped = tread.Run(self.directory / "run")
        self.assertEqual(stopped.summary["exit_code"], 75)
        self.assertIn("stopped by an error in a callback: LookupError: at", self.reason(stopped))
        self.assert_same(self.run_scene(sand_and_roller(), restart="auto"), whole)

    def test_a_callback_may_stop_the_run(self):
        run = self.run_scene(BALL, on_span=lambda state: state.stop("the ball is seen enough") if state.steps else None, span_steps=10)
        self.assertEqual(run.summary["status"], "stopped")
        self.assertIn("the ball is seen enough", self.reason(run))
        self.assertEqual(run.summary["steps"], 10)

    def test_ctrl_c_stops_between_steps_and_handlers_stay(self):
        before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)
        long = SCENE.replace("duration = 0.02", "duration = 50.0")
        for on_span in (None, lambda state: None):
            timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                self.run_scene(long, existing="overwrite", on_span=on_span, span_steps=1)
            timer.join()
            stopped = tread.Run(self.directory / "run")
            self.assertEqual(stopped.summary["exit_code"], 75)
            self.assertTrue(list((stopped.path / "checkpoints").iterdir()))
        self.assertEqual((signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)), before)

    def test_other_threads_go_on_during_steps(self):
        ticks, done = [], threading.Event()

        def tick():
            while not done.wait(0.01):
                ticks.append(1)

        thread = threading.Thread(target=tick)
        thread.start()
        self.run_scene(SCENE.replace("duration = 0.02", "duration = 0.5"))
        done.set()
        thread.join()
        self.assertGreater(len(ticks), 3)

    def test_errors_are_of_their_kind(self):
        with self.assertRaisesRegex(tread.SceneError, r"\[grid\] spacing"):
            self.run_scene(SCENE.replace("spacing = 0.05", "spacing = -0.05"))
        self.assertEqual(self.files(), [])
        with self.assertRaisesRegex(tread.SceneError, "backend"):
            self.run_scene(SCENE, backend="gpu")
        with self.assertRaises(tread.MachineError):
            self.write("file", "")
            self.run_scene(SCENE, "file/run")
        self.run_scene(BALL)
        with self.assertRaises(tread.SceneError):
            self.run_scene(BALL)
        self.run_scene(BALL, existing="overwrite")
        with self.assertRaisesRegex(tread.SceneError, 'no .*body.* "?.?bal.*ball'):
            self.run_scene(BALL, "other", on_span=lambda state: state.body("bal"))

    def test_a_run_that_fails_leaves_its_summary(self):
        beside = SCENE.replace("[[0.0, 0.0, 0.0], [0.4, 0.4, 0.1]]", "[[0.0, 0.0, 0.0], [0.2, 0.4, 0.1]]").replace("young   = 1.0e7", "young   = 1.0e18")
        hard = beside + '[[body]]\nname = "roller"\nshape = "roller"\nmaterial = "steel"\nmass = 1.0\nposition = [0.3, 0.2, 0.0601]\n[time]\ncontact_share = 0.001\n'
        with self.assertRaisesRegex(tread.NumericalError, "roller") as caught:
            self.run_scene(hard)
        self.assertEqual(caught.exception.run.summary["status"], "failed")

    def test_one_run_at_a_time(self):
        with self.assertRaisesRegex(tread.TreadError, "one comes after the other"):
            self.run_scene(BALL, on_span=lambda state: self.run_scene(BALL, "inner"))
        with self.assertRaisesRegex(tread.TreadError, "one comes after the other"):
            self.run_scene(BALL, "again", on_span=lambda state: tread.Scene.from_text(BALL).check())


if __name__ == "__main__":
    unittest.main()
