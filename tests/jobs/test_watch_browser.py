#!/usr/bin/python3
"""Pages of `tread watch` in headless Chromium, where there is one (Debian's chromium or chromium-headless-shell)."""

import os
import re
import shutil
import subprocess
import sys
import unittest
from unittest import mock

from watch_fixture import LINE, WatchTest

BROWSER = next(filter(None, map(shutil.which, ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"))), None)


@unittest.skipIf(BROWSER is None, "no Chromium on PATH (apt-get install chromium-headless-shell): pages were not opened in a browser")
class Browser(WatchTest):
    def opened(self, seconds=7, **environment):
        """(page after its script ran for a while, what the browser's console says)."""
        command = [BROWSER, "--headless", "--disable-gpu", "--enable-logging=stderr", f"--user-data-dir={self.directory / 'browser'}",
                   f"--virtual-time-budget={1000 * seconds}", "--dump-dom", self.server.url]
        command += ["--no-sandbox"] if os.geteuid() == 0 else []  # which Chromium asks of root
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True, env={**os.environ, "HOME": str(self.directory), **environment})
        return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]

    def test_a_page_follows_its_run(self):
        self.make_running()
        self.serve()
        log, page, asked = self.run_folder / "log.txt", self.server.watched.page, []

        def page_and_progress(*arguments):
            """The run goes on after the first look at it."""
            text = page(*arguments)
            asked.append(arguments)
            log.write_text(LINE.replace("t 1.2 /", "t 2.4 /") + "\n", encoding="utf-8")
            return text

        with mock.patch.object(self.server.watched, "page", page_and_progress):
            shown, console = self.opened()
        self.assertGreaterEqual(len(asked), 2)
        self.assertIn("66 % · at most 0:01:00 left", shown)
        self.assertNotIn("33 %", shown)
        self.assertIn("<title>66 % – Wheel at slip 0.3 on sand with rocks</title>", shown)
        self.assertRegex(shown, r'<p id="lost" hidden="">')
        self.assertEqual(shown.count("<polyline"), 4)
        self.assertEqual(console, [])

    def test_a_page_says_that_its_server_is_gone(self):
        self.make_running()
        self.serve()
        page, asked = self.server.watched.page, []

        def page_once(*arguments):
            asked.append(arguments)
            if len(asked) > 1:
                self.server.shutdown()
                self.server.server_close()
            return page(*arguments)

        with mock.patch.object(self.server.watched, "page", page_once):
            shown, _ = self.opened()
        self.assertEqual(len(asked), 2)
        self.assertIn('<p id="lost">This page is no longer fresh', shown)
        self.assertIn("33 %", shown)

    def test_markup_in_names_runs_nothing(self):
        self.make_hostile()
        self.serve()
        shown, console = self.opened()
        self.assertEqual(console, [])
        self.assertRegex(shown, r"<title>done – &lt;/title&gt;&lt;/main&gt;&lt;script&gt;")
        self.assertEqual(re.findall("<script[^>]*>", shown), ['<script defer="" src="watch.js">'])
        self.assertEqual(re.findall('<img [^>]*src="([^"?]*)', shown), ["picture"])


if __name__ == "__main__":
    unittest.main(argv=[*sys.argv, "--verbose"])
