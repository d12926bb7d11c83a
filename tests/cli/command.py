"""What the command-line tests share: the program, a small valid scene, and a place to run in."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

TREAD = os.environ.get("TREAD", "tread")
# The environment of the tests spares programs without a launcher the directories that ranks under one meet in.
MPIRUN = (shutil.which("mpirun"), "--allow-run-as-root", "--oversubscribe", "--mca", "orte_create_session_dirs", "1")

# Valid as it stands: every case spoils one line of it. A block of sand that rests for 20 ms. The wheel has a sixteenth of the usual
# nodes, which take two seconds to spread.
SCENE = """\
title = "a small block of sand"

[domain]
size    = [0.4, 0.4, 0.4]
gravity = [0.0, 0.0, -9.81]

[grid]
spacing = 0.05

[[material]]
name               = "sand"
model              = "mohr-coulomb"
density            = 1600.0
young              = 1.0e6
poisson            = 0.3
friction_angle_deg = 30.0
dilation_angle_deg = 0.0
cohesion           = 0.0

[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e7
poisson = 0.3

[[shape]]
name      = "roller"
generate  = { kind = "wheel", radius = 0.06, width = 0.06, wall_thickness = 0.03, grousers = 0, grouser_height = 0.0 }
sdf_cells = 24
node_spacing = 0.0075

[[terrain]]
material = "sand"
region   = { box = [[0.0, 0.0, 0.0], [0.4, 0.4, 0.1]] }

[[phase]]
name     = "rest"
duration = 0.02

[output]
every           = 0.005
snapshots_every = 0.01
"""

BODY = """
[[body]]
name     = "roller"
shape    = "roller"
material = "steel"
mass     = 1.0
position = [0.2, 0.2, 0.3]
"""


class CommandTest(unittest.TestCase):
    """A test in a fresh directory of its own."""

    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tread-cli-")
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)
        self.output = self.directory / "run"

    def tread(self, *arguments, launcher=(), environment=None, before=None):
        command = [*launcher, TREAD, *map(str, arguments)]
        return subprocess.run(command, cwd=self.directory, env={**os.environ, **(environment or {})}, capture_output=True, text=True, timeout=250, preexec_fn=before)

    def write(self, name, text):
        path = self.directory / name
        path.write_text(text)
        return path

    def files(self):
        """Every path below the test's directory."""
        return sorted(str(path.relative_to(self.directory)) for path in self.directory.rglob("*"))


def line_of(text, part):
    """Number of the first line of `text` that holds `part`."""
    return next(number for number, line in enumerate(text.splitlines(), 1) if part in line)
