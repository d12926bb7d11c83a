#!/usr/bin/env python3
"""Steps that would take for ever: refused, or stopped from outside."""

import re
import signal
import time
import unittest

from command import BODY, SCENE
from restart_test import MPIRUN, RestartTest

MANY = SCENE + BODY + "\n[time]\nsubsteps = 1000000\n"


class LongSteps(RestartTest):
    def test_values_without_an_end_are_refused(self):
        for key, value, accepted in (("contact_share", "1e-12", "number >= 0.001 and <= 0.8"),
                                     ("substeps", "1000001", "integer 1 to 1000000")):
            scene = self.write("scene.toml", f"{SCENE}{BODY}[time]\n{key} = {value}\n")
            result = self.tread("check", scene)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn(f"[time] {key}", result.stderr)
            self.assertIn(accepted, result.stderr)

    def test_a_body_that_wants_too_many_names_itself(self):
        beside_sand = SCENE.replace("[[0.0, 0.0, 0.0], [0.4, 0.4, 0.1]]", "[[0.0, 0.0, 0.0], [0.2, 0.4, 0.1]]")
        hard = beside_sand.replace("young   = 1.0e7", "young   = 1.0e18") + BODY.replace("[0.2, 0.2, 0.3]", "[0.3, 0.2, 0.0601]") + "[time]\ncontact_share = 0.001\n"
        for launcher in ((), (*MPIRUN, "-n", "2")):
            result = self.run_scene(hard, self.output, "--overwrite", code=3, launcher=launcher)
            self.assertRegex(self.summary()["reason"], r"contact substeps, over the 1000000 .* of body 'roller' is .* s, of which a "
                             r"substep takes time.contact_share = 0.001")
            self.assertIn("contact substeps, over the 1000000", result.stdout + result.stderr)

    def stop_within_a_step(self, attempts, ranks=1):
        """What the run said. `attempts`: pairs of options and of what stops the job; a stop that came before the first step, or between
        two steps, is tried again at another time."""
        launcher = (*MPIRUN, "-n", str(ranks)) if ranks > 1 else ()
        for options, stop in attempts:
            job = self.begin(MANY, "--overwrite", *options, launcher=launcher)
            while job.poll() is None and not (self.output / "snapshots" / "points.hdf.series").exists():
                time.sleep(0.02)
            stop(job)
            said = self.end(job, 75)
            within = re.search(r"stopped by .* within step (\d+), of which no checkpoint can be written; the newest is none", said)
            if within:
                break
        self.assertTrue(within, said)
        summary = self.summary()
        self.assertEqual((summary["status"], summary["exit_code"], summary["steps"]), ("stopped", 75, int(within[1]) - 1))
        self.assertEqual(self.checkpoints(), [])
        return said

    def test_a_signal_stops_it(self):
        def stop_after(seconds):
            def stop(job):
                time.sleep(seconds)
                job.send_signal(signal.SIGUSR2)

            return stop

        for ranks in (1, 2):
            said = self.stop_within_a_step([((), stop_after(seconds)) for seconds in (1, 4, 16)], ranks=ranks)
            self.assertRegex(said, r"stopped by (signal USR2|a signal to another rank) within step \d+")

    def test_the_wall_time_limit_stops_it(self):
        # A step takes longer than the start of a run, so that one of these limits falls into the first step.
        limits = [(("--walltime-limit", f"00:00:{seconds:02}"), lambda job: None) for seconds in (8, 4, 2, 1, 16)]
        said = self.stop_within_a_step(limits)
        self.assertIn("stopped by the wall-time limit within step ", said)


if __name__ == "__main__":
    unittest.main()
