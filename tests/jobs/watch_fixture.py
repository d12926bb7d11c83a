"""What the tests of `tread watch` share: a server in this process, requests to it, and runs that are made up."""

import http.client
import json
import os
import pathlib
import socket
import sys
import tempfile
import threading
import unittest
from unittest import mock

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "jobs"), str(ROOT / "postprocess")]

from made_up_run import RESOLUTION, SCENE, make_run  # noqa: E402
from tread_watch import server  # noqa: E402

LINE = ("drive  t 1.2 / 3.6 s  24000 steps  800 steps/s  ETA 0:01:00  dt 5.00e-05 s (compression wave)  "
        "pull 57.1 N  sinkage 0.0489 m")
ANSWER = {"phase": "drive", "steady": True, "pull": {"mean": 57.1, "standard_error": 3.0, "unit": "N"}, "sinkage": {"mean": 0.05, "standard_error": None, "unit": "m"}}
SUMMARY = {"status": "finished", "reason": "all phases ran", "resolution": RESOLUTION, "warnings": ["gravity points up"], "wall_s": 2.5,
           "answers": {"front wheel": [ANSWER]}}
# What a person could put into a name to become part of the page.
MARKUP = "</title></main><script>document.title='owned'</script><img src=x onerror=\"document.title='owned'\">'\"&"


def toml(text):
    return json.dumps(text, ensure_ascii=False)


class WatchTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tread-watch-")
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)
        self.run_folder = self.directory / "run"
        for name in ("RUN_PAUSE", "COST"):
            patched = mock.patch.object(server, name, 0.0)  # each request sees the files as they are
            patched.start()
            self.addCleanup(patched.stop)

    def make_running(self, line=LINE):
        """A run of this process that has come as far as `line`."""
        make_run(self.run_folder)
        (self.run_folder / "summary.json").unlink()
        (self.run_folder / "log.txt").write_text(f"phase 'drive' begins at 0.9 s\n{line}\n", encoding="utf-8")
        (self.run_folder / ".lock").write_text(f"process {os.getpid()} on {socket.gethostname()}", encoding="utf-8")

    def make_hostile(self):
        """A run and files of it whose names and texts are markup."""
        make_run(self.run_folder)
        scene = SCENE.replace('"Wheel at slip 0.3 on sand with rocks"', toml(MARKUP)).replace('"front wheel"', toml(MARKUP.replace("/", "|")))
        (self.run_folder / "scene.toml").write_text(scene.replace('"drive"', toml(MARKUP)), encoding="utf-8")
        with h5py.File(self.run_folder / "timeseries.h5", "r+") as file:
            file.move("wheel/front wheel", "wheel/" + MARKUP.replace("/", "|"))
        summary = SUMMARY | {"reason": MARKUP, "warnings": [MARKUP], "answers": {MARKUP: [ANSWER | {"phase": MARKUP, "pull": ANSWER["pull"] | {"unit": MARKUP}}]},
                             "resolution": {"verdict": MARKUP, "figures": {}}}
        (self.run_folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
        (self.run_folder / "log.txt").write_text(f"{MARKUP}\n{LINE.replace('drive', MARKUP).replace('compression wave', MARKUP)}\n", encoding="utf-8")
        (self.run_folder / (MARKUP.replace("/", "|")[:200] + ".png")).write_bytes(b"x")

    def serve(self, folder=None):
        self.server = server.WatchServer(server.Watched(folder or self.run_folder), 0)
        threading.Thread(target=self.server.serve_forever, args=(0.05,), daemon=True).start()
        self.addCleanup(self.server.server_close)
        self.addCleanup(self.server.shutdown)

    def ask(self, path="", method="GET", hosts=("localhost",), below=True):
        """(status, headers, text) of an address below the secret word, or below the root."""
        connection = http.client.HTTPConnection("127.0.0.1", self.server.server_port, timeout=30)
        self.addCleanup(connection.close)
        connection.putrequest(method, f"/{self.server.word}/{path}" if below else path, skip_host=True, skip_accept_encoding=True)
        for host in hosts:
            connection.putheader("Host", host)
        connection.endheaders()
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders()), answer.read().decode("utf-8", "replace")

    def page(self, path=""):
        status, _, text = self.ask(path)
        self.assertEqual(status, 200, text)
        return text
