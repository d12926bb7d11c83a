#!/usr/bin/python3
"""ci/slurm cancels jobs of the controller that it started itself, and of no other cluster, whatever fails on the way."""

import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# A cluster of the site, as far as ci/slurm can see one: what is asked to cancel leaves a directory, which a full disk allows,
# named after the configuration that it read.
SCANCEL = '#!/bin/sh\nmkdir -p "$CALLS/$(basename "$(dirname "$SLURM_CONF")").$(basename "$SLURM_CONF")"\n'
DAEMON = "#!/bin/sh\nexec sleep 30\n"
MUNGED = "#!/usr/bin/python3\nimport socket, sys, time\npath = next(a.split('=')[1] for a in sys.argv if a.startswith('--socket='))\n" \
         "socket.socket(socket.AF_UNIX).bind(path)\ntime.sleep(30)\n"


class SlurmGuardTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.calls = self.folder / "calls"
        self.programs = self.folder / "bin"
        self.temporary = self.folder / "tmp"
        for folder in (self.calls, self.programs, self.temporary):
            folder.mkdir()
        for name, text in {"scancel": SCANCEL, "squeue": "#!/bin/sh\n", "sinfo": "#!/bin/sh\necho idle\n", "munged": MUNGED,
                           "slurmctld": DAEMON, "slurmd": DAEMON}.items():
            (self.programs / name).write_text(text, encoding="utf-8")
            (self.programs / name).chmod(0o755)

    def run_beside(self, shell, command="true"):
        site = {"SLURM_CONF": str(self.folder / "site" / "slurm.conf"), "SLURM_CLUSTERS": "site", "CALLS": str(self.calls),
                "TMPDIR": str(self.temporary), "PATH": f"{self.programs}:{os.environ['PATH']}"}
        return subprocess.run(["bash", "-c", f"{shell} exec bash {ROOT}/ci/slurm {command}"], env={**os.environ, **site},
                              capture_output=True, text=True, check=False, timeout=60)

    def cancelled(self):
        return sorted(path.name for path in self.calls.iterdir())

    def test_a_full_temporary_disk_cancels_nothing(self):
        # No file may grow: slurm.conf cannot be written, and set-up ends there.
        done = self.run_beside("ulimit -f 0;")
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(self.cancelled(), [])

    def test_a_directory_that_cannot_be_made_cancels_nothing(self):
        done = self.run_beside("export TMPDIR=/nowhere;")
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(self.cancelled(), [])

    def test_jobs_of_its_own_controller_are_cancelled_and_no_others(self):
        done = self.run_beside("", "sh -c 'basename $(dirname $SLURM_CONF); echo ${SLURM_CLUSTERS:-none}'")
        self.assertEqual(done.returncode, 0, done.stderr)
        own, clusters = done.stdout.split()
        self.assertEqual(clusters, "none")
        self.assertEqual(self.cancelled(), [f"{own}.slurm.conf"])


if __name__ == "__main__":
    unittest.main()
