#!/usr/bin/env python3
"""Progress on a terminal: a line that is redrawn where the terminal can do that, else lines as in the log."""

import os
import pty
import signal
import time
import unittest

from command import SCENE, TREAD, CommandTest

ERASE = "\r\x1b[K"


class TerminalTest(CommandTest):
    def on_terminal(self, kind, until):
        """What a run of a long phase says to a terminal of a kind, until that holds `until`; then it is told to stop."""
        scene = self.write("scene.toml", SCENE.replace("duration = 0.02", "duration = 1000"))
        process, terminal = pty.fork()
        if process == 0:
            os.environ["TERM"] = kind
            os.execv(TREAD, [TREAD, "run", str(scene), "--output", str(self.output), "--backend", "cpu", "--threads", "1"])
        text, deadline = "", time.monotonic() + 120
        while until not in text and time.monotonic() < deadline:
            text += os.read(terminal, 4096).decode()
        os.kill(process, signal.SIGTERM)
        try:
            while more := os.read(terminal, 4096):
                text += more.decode()
        except OSError:  # the other end is closed
            pass
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]), 75, text)
        return text

    def test_a_line_is_redrawn(self):
        text = self.on_terminal("xterm", "] 0 %")
        status = text[text.index("[----"):].split(ERASE)[0]
        self.assertRegex(status, r"^\[-{20}\] 0 %  rest  t [0-9.e-]+ / 1000 s  ETA [0-9]+:[0-9:]+")
        self.assertLess(len(status), 80)
        self.assertIn(ERASE + "checkpoint at ", text)  # what comes next removes it

    def test_a_dumb_terminal_gets_lines(self):
        text = self.on_terminal("dumb", "ETA ")
        self.assertNotIn("\x1b", text)
        self.assertRegex(text, r"\r\nrest  t [0-9.e-]+ / 1000 s  [0-9]+ steps  [0-9.e+]+ steps/s  ETA ")


if __name__ == "__main__":
    unittest.main()
