#!/usr/bin/env python3
"""Steps that would take for ever: refused, or stopped from outside."""

import signal
import time
import unittest

from command import BODY, SCENE
from restart_test import MPIRUN, RestartTest

MANY = SCENE + BODY + "\n[time]\nsubsteps = 1000000\n"


class LongSteps(RestartTest):
    def test_values_without_an_end_are_refused(self):
        for key, value, accepted in (("contact_share", "1e-12", "number in [0.001, 0.4]"),
                                     ("substeps", "1000001", "integer 1 to 1000000")):
            scene = self.write("scene.toml", f"{SCENE}{BODY}[time]\n{key} = {value}\n")
            result = self.tread("check", scene)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn(f"[time] {key}", result.stderr)
            self.assertIn(accepted, result.stderr)

    def test_a_body_that_wants_too_many_names_itself(self):
        hard = SCENE.replace("young   = 1.0e7", "young   = 1.0e22") + BODY.replace("0.3]", "0.165]")
        for launcher in ((), (*MPIRUN, "-n", "2")):
            result = self.run_scene(hard, self.output, "--overwrite", code=3, launcher=launcher)
            self.assertRegex(self.summary()["reason"], r"contact substeps, over the 1000000 .* body roller is .* s, of which a "
                             r"substep takes time.contact_share = 0.2")
            self.assertIn("contact substeps, over the 1000000", result.stdout + result.stderr)

    def check_stopped_within_the_first_step(self, *options, ranks=1, stop=None):
        launcher = (*MPIRUN, "-n", str(ranks)) if ranks > 1 else ()
        job = self.begin(MANY, "--overwrite", *options, launcher=launcher)
        self.wait_for((self.output / "timeseries.h5").exists, job)
        if stop:
            stop(job)
        said = self.end(job, 75)
        self.assertRegex(said, "stopped by .* within step 1, of which no checkpoint can be written; the newest is none")
        summary = self.summary()
        self.assertEqual((summary["status"], summary["exit_code"], summary["steps"]), ("stopped", 75, 0))
        self.assertEqual(self.checkpoints(), [])
        return summary["reason"]

    def test_a_signal_stops_it(self):
        for ranks in (1, 2):
            def ask(job):
                time.sleep(1)  # until the step has begun
                job.send_signal(signal.SIGUSR2)
            self.assertIn("signal", self.check_stopped_within_the_first_step(ranks=ranks, stop=ask))

    def test_the_wall_time_limit_stops_it(self):
        self.assertIn("the wall-time limit", self.check_stopped_within_the_first_step("--walltime-limit", "00:00:04"))


if __name__ == "__main__":
    unittest.main()
