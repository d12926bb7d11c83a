"""ReFrame test of an installed tread: a column of sand collapses; its run-out must be right, and points/s are reported.

    reframe -C SITE.py -c packaging/reframe/tread.py -r                       # tread is on PATH
    reframe -C SITE.py -c packaging/reframe/tread.py -r -S TreadCollapse.installation=/opt/tread --performance-report

Nothing is said of how fast a system must be: give `reference` in the site's own file, or look at what is reported.
"""

import json
from pathlib import Path

import reframe as rfm
import reframe.utility.sanity as sn
from reframe.core.builtins import parameter, performance_function, run_after, run_before, sanity_function, variable

MEASURED = 1.2  # run-out over width for a column as high as wide (docs/soil_tests.md)
APART = 0.15  # of it: so far are the two laboratories apart that measured it
MOST_ENERGY = 1e-3  # of the energy that falls: a balance that closes is 25 times better


@rfm.simple_test
class TreadCollapse(rfm.RunOnlyRegressionTest):
    descr = "Collapse of a column of sand: run-out, balance of energy, points/s"
    backend = parameter(["cpu", "cuda"])
    installation = variable(str, value="")  # its prefix; empty: tread is on PATH, and knows where its scenes are
    valid_systems = ["*"]
    valid_prog_environs = ["*"]
    num_tasks = 1
    time_limit = "10m"

    @run_after("init")
    def skip_without_gpu(self):
        if self.backend == "cuda":
            self.valid_systems = ["+gpu"]
            self.num_gpus_per_node = 1

    @run_before("run")
    def command(self):
        tread = str(Path(self.installation, "bin", "tread")) if self.installation else "tread"
        share = '"$(dirname "$(readlink -f "$(command -v ' + tread + ')")")/../share/tread"'
        # On a CPU the twin of 2,048 points, on a GPU the scene of 65,536.
        folder = "soil/reduced" if self.backend == "cpu" else "soil"
        self.executable = tread
        self.executable_opts = ["run", f"{share}/configs/{folder}/collapse.toml", "--backend", self.backend, "--quiet", "--overwrite",
                                "--output", "run"]
        self.postrun_cmds = [f"{tread} post soil_test run --output report"]

    def said(self, *path):
        return json.loads(Path(self.stagedir, *path).read_text(encoding="utf-8"))

    @sanity_function
    def finished_and_right(self):
        run, report = self.said("run", "summary.json"), self.said("report", "soil_test.json")
        return sn.all([
            sn.assert_eq(run["status"], "finished"),
            sn.assert_eq(run["backend"], self.backend),
            sn.assert_bounded(report["constants"]["run_out"]["value"], (1 - APART) * MEASURED, (1 + APART) * MEASURED),
            sn.assert_lt(abs(run["errors"]["energy"]), MOST_ENERGY),
        ])

    @performance_function("points/s")
    def rate(self):
        run = self.said("run", "summary.json")
        return run["points"] * run["steps"] / run["wall_s"]
