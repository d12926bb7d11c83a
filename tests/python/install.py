#!/usr/bin/env python3
"""`pip install .` into a virtual environment, and the package from there. Builds the library, which takes minutes; skipped where pip reaches
no index. Wants SOURCE, the folder of the sources."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["SOURCE"])
PROGRAM = """
import tread, tread_post, tread_jobs
assert "site-packages" in tread.__file__ and "site-packages" in tread_post.__file__ and "site-packages" in tread_jobs.__file__, tread.__file__
run = tread.run("configs/rig/torque.toml", "{output}", on_span=lambda state: state.stop("seen"), span_steps=20)
print(tread.features(), run.summary["reason"])
"""


class Install(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tread-python-")
        self.addCleanup(directory.cleanup)
        self.environment = pathlib.Path(directory.name)
        subprocess.run([sys.executable, "-m", "venv", self.environment], check=True)
        self.python = self.environment / "bin" / "python"
        got = subprocess.run([self.python, "-m", "pip", "download", "--no-deps", "--quiet", "--dest", self.environment, "scikit-build-core"],
                             capture_output=True, text=True)
        if got.returncode:
            self.skipTest(f"pip reaches no index: {got.stderr[-300:]}")

    def test_pip_installs_the_package(self):
        subprocess.run([self.python, "-m", "pip", "install", SOURCE, "--config-settings=cmake.define.TREAD_CUDA=OFF"], check=True, cwd=self.environment)
        text = PROGRAM.format(output=self.environment / "run")
        # In the sources, whose folder `src/python` must not be what is imported.
        ran = subprocess.run([self.python, "-c", text], cwd=SOURCE, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": ""})
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("\nbackends: cpu", ran.stdout)
        self.assertIn("seen", ran.stdout)
        subprocess.run([self.python, "-m", "pip", "install", "--quiet", "mypy"], check=True)
        self.typed()

    def typed(self):
        program = self.environment / "typed.py"
        program.write_text("import tread\nreveal_type(tread.run)\nreveal_type(tread.Scene({}).check())\n")
        shown = subprocess.run([self.python, "-m", "mypy", program], capture_output=True, text=True).stdout
        self.assertIn('"dict[str, Any]"', shown.replace("builtins.", "").replace("typing.", ""))
        self.assertNotIn("py.typed", shown)


if __name__ == "__main__":
    unittest.main()
