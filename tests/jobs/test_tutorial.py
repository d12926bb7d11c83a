#!/usr/bin/python3
"""docs/tutorial.md does what it says: its files and commands, taken from its text, with a shorter drive."""

import csv
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from campaign_fixture import ROOT, TREAD

DRIVE, SHORTER = "duration = 2.0 ", "duration = 0.7 "  # s: an answer needs 20 rows of 0.02 s after the ramp of 0.2 s


def blocks_of(text):
    """(section, TOML files, commands) of each section, in the page's order."""
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        files = re.findall(r"`(runs/[\w/]+\.toml)`[^`]*?(?:`\[\[phase\]\]`, and append)?:\n\n```toml\n(.*?)```", section, re.DOTALL)
        commands = re.findall(r"^    (?!export )(\S.*)$", re.sub(r"```.*?```", "", section, flags=re.DOTALL), re.MULTILINE)
        yield section.splitlines()[0], files, [command for command in commands if "..." not in command]


class Tutorial(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tread-tutorial-")
        self.addCleanup(directory.cleanup)
        self.place = Path(directory.name)
        for folder in ("jobs", "postprocess"):
            (self.place / folder).symlink_to(ROOT / folder)
        (self.place / "runs" / "first").mkdir(parents=True)

    def run_command(self, command):
        environment = {**os.environ, "PATH": f"{Path(TREAD).parent}:{os.environ['PATH']}"}
        done = subprocess.run(["bash", "-c", command], cwd=self.place, env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")
        return done.stdout

    def test_the_page_from_its_first_file_to_its_last_command(self):
        page = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
        self.assertEqual(page.count(DRIVE), 1, "the drive that is shortened")
        said, bed = {}, ""
        for _, files, commands in blocks_of(page.replace(DRIVE, SHORTER)):
            for name, text in files:
                if "wheel.toml" in name:
                    text = bed.partition("[[phase]]")[0] + text
                bed = bed or text
                (self.place / name).write_text(text, encoding="utf-8")
            for command in commands:
                said[command] = self.run_command(command)
        self.assertGreater(len(said), 10)
        first = self.place / "runs" / "first"
        self.assertIn("15000 points", said["tread check runs/first/bed.toml"])
        wheel = said["tread check runs/first/wheel.toml"]
        self.assertRegex(wheel, r"sinkage 0\.00(6[5-9]|7[0-4])")  # 7 mm
        self.assertIn(", 3.8 cells", wheel)
        with open(first / "slip" / "campaign.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.assertEqual(len(rows), 4)
        for picture in (first / "wheel" / "render.gif", first / "wheel" / "wheel_history.png", first / "slip" / "slip_curves.png"):
            self.assertGreater(picture.stat().st_size, 5000, picture)


if __name__ == "__main__":
    unittest.main()
