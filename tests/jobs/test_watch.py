#!/usr/bin/python3
"""Pages of `tread watch`: what they say of made-up runs and campaigns, and what the server refuses."""

import html.parser
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest

import numpy as np

from campaign_fixture import TREAD, TWIN, CampaignTest
from made_up_run import SCENE, make_run
from watch_fixture import ANSWER, LINE, MARKUP, ROOT, SUMMARY, WatchTest

from tread_watch.plots import Curve, plot  # noqa: E402
from tread_watch.progress import PROGRESS  # noqa: E402

# All that a page is made of.
ELEMENTS = {"html", "head", "meta", "title", "link", "script", "body", "main", "h1", "h2", "p", "a", "progress", "div", "table", "tr", "th", "td",
            "pre", "figure", "img", "figcaption", "svg", "path", "polyline", "rect", "text"}


class Elements(html.parser.HTMLParser):
    """Elements of a page with their attributes."""

    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))


def tree(folder):
    """Names, times and sizes of all files below a folder."""
    return sorted((str(path), path.lstat().st_mtime_ns, path.lstat().st_size) for path in folder.rglob("*"))


class Runs(WatchTest):
    def test_a_run_that_goes_on(self):
        self.make_running()
        self.serve()
        page = self.page()
        for text in ("running", 'value="0.3333"', "33 % · at most 0:01:00 left · phase drive · 1.2 of 3.6 s", "dt 5.00e-05 s, limited by compression wave",
                     "pull 57.1 N so far · sinkage 0.0489 m so far", " front wheel</p>", "Wheel at slip 0.3 on sand with rocks"):
            self.assertIn(text, page)
        self.assertEqual(page.count("<polyline"), 4)
        for name in ("drawbar pull  [N]", "torque on the axle  [N m]", "sinkage  [mm]", "load  [N]", "time  [s]", ">settle<", ">drop<", ">drive<"):
            self.assertIn(name, page)
        travel = self.page("?against=travel")
        self.assertIn("distance from the start  [m]", travel)
        self.assertEqual((travel.count("<polyline"), travel.count("<rect")), (4, 0))

    def test_a_run_that_has_ended(self):
        make_run(self.run_folder)
        (self.run_folder / "summary.json").write_text(json.dumps(SUMMARY), encoding="utf-8")
        (self.run_folder / "log.txt").write_text("resolution: under-resolved\n", encoding="utf-8")
        self.serve()
        page = self.page()
        for text in ("done: all phases ran", 'value="1.0000"', "57.1 ± 3 N", "0.05 m", '<p class="headline under-resolved">under-resolved', "contact_cells 2",
                     "gravity points up", "resolution: under-resolved", 'data-title="done'):
            self.assertIn(text, page)
        self.assertNotIn("Last picture", page)

    def test_states_without_a_summary(self):
        self.make_running()
        self.serve()
        for lock, age, told in ((f"process 4194999 on {socket.gethostname()}", 0, "stale: process 4194999 is gone"), ("process 1 on elsewhere", 0, ">running<"),
                                ("process 1 on elsewhere", 5000, "stale: no sign of life for"), ("no lock of a run", 0, ">running<")):
            (self.run_folder / ".lock").write_text(lock, encoding="utf-8")
            for path in (self.run_folder, *self.run_folder.iterdir()):
                os.utime(path, (time.time() - age,) * 2)
            self.assertIn(told, self.page())

    def test_the_newest_picture(self):
        self.make_running()
        for number, name in enumerate(("old.png", "new.jpg", "newer.txt")):
            (self.run_folder / name).write_bytes(name.encode())
            os.utime(self.run_folder / name, (1e9 + number, 1e9 + number))
        self.serve()
        self.assertIn('<img alt="new.jpg" src="picture?1000000001000000000">', self.page())
        status, headers, text = self.ask("picture?1000000001000000000")
        self.assertEqual((status, headers["Content-Type"], text), (200, "image/jpeg", "new.jpg"))

    def test_what_is_not_there_yet(self):
        self.run_folder.mkdir()
        (self.run_folder / "scene.toml").write_text(SCENE, encoding="utf-8")
        self.serve()
        self.assertIn("There is no time series yet.", self.page())
        self.assertEqual(self.ask("picture")[0], 404)

    def test_damaged_files_end_no_page(self):
        self.make_running()
        self.serve()
        (self.run_folder / "timeseries.h5").write_bytes(b"\x89HDF")
        self.assertIn("Cannot be read: ", self.page())
        (self.run_folder / "timeseries.h5").unlink()
        for text in ("[", "[]", "[" * 100000):
            (self.run_folder / "summary.json").write_text(text, encoding="utf-8")
            self.assertIn("failed: summary.json cannot be read", self.page())
        for wrong in ({"answers": 3}, {"answers": {"a": [{}]}}, {"answers": {"a": [ANSWER | {"pull": 3}]}}, {"resolution": "fine"}, {"resolution": {"verdict": ["resolved"]}}):
            (self.run_folder / "summary.json").write_text(json.dumps(SUMMARY | wrong), encoding="utf-8")
            self.assertEqual(self.page().count("Cannot be read: "), 1, wrong)

    def test_one_made_by_a_run_while_it_writes(self):
        settings = {"phase.settle.max_duration": 0.01, "phase.lower.max_duration": 0.03, "phase.drive.duration": 1000, "phase.drive.drive.ramp": 0.01,
                    "phase.drive.drive.angular_velocity": 0.01,  # it does not come to the end of the bed
                    "output.every": 0.001}
        command = [TREAD, "run", TWIN, "--output", self.run_folder, "--backend", "cpu", "--threads", "1", "--quiet"]
        process = subprocess.Popen(command + [f"--set={key}={value}" for key, value in settings.items()])
        self.addCleanup(process.kill)
        until = time.monotonic() + 120
        while not (self.run_folder / "scene.toml").exists():
            self.assertLess(time.monotonic(), until)
            time.sleep(0.1)
        self.serve()
        page = ""
        while "pull" not in page or "so far" not in page:
            self.assertLess(time.monotonic(), until, page)
            self.assertIsNone(process.poll())
            page = self.page()
            self.assertNotIn("Cannot be read", page)
            time.sleep(0.1)
        self.assertRegex(page, r"0 % · at most [0-9:]+ left · phase drive · [0-9.]+ of [0-9.]+ s · [0-9]+ steps · [0-9.]+ steps/s · dt [0-9.e-]+ s, limited by ")
        self.assertEqual(page.count("<polyline"), 4)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=60), 75)
        self.assertIn("stopped: stopped by", self.page())


class Safety(WatchTest):
    def check_elements(self, page):
        found = Elements(page).found
        self.assertEqual({tag for tag, _ in found} - ELEMENTS, set())
        self.assertEqual([attributes for tag, attributes in found if tag == "script"], [{"defer": None, "src": attributes["src"]} for tag, attributes in found
                                                                                       if tag == "script" and re.fullmatch(r"(\.\./\.\./)?watch\.js", attributes["src"])])
        for tag, attributes in found:
            self.assertFalse([name for name in attributes if name.startswith("on") or name == "style"], (tag, attributes))
            self.assertRegex(attributes.get("src", ""), r"^((\.\./\.\./)?watch\.js|picture\?\d+|)$")
            self.assertRegex(attributes.get("href", ""), r"^((\.\./\.\./)?watch\.css|\?against=\w+|case/\d{4}/|\.\./\.\./|)$")

    def test_names_with_markup_stay_names(self):
        self.make_hostile()
        self.serve()
        page = self.page()
        self.check_elements(page)
        self.assertGreaterEqual(page.count("&lt;script&gt;document.title=&#x27;owned"), 9)  # title twice, legend, phase, verdict, answers, log ...
        (self.run_folder / "summary.json").unlink()
        self.check_elements(self.page("?against=travel%22%3E%3Cscript%3E"))

    def test_headers(self):
        self.make_running()
        self.serve()
        for path in ("", "watch.js", "watch.css", "nothing"):
            _, headers, text = self.ask(path)
            self.assertIn("default-src 'none'; script-src 'self';", headers["Content-Security-Policy"])
            self.assertNotIn("unsafe", headers["Content-Security-Policy"])
            self.assertEqual((headers["X-Content-Type-Options"], headers["Referrer-Policy"], headers["Cache-Control"]), ("nosniff", "no-referrer", "no-store"))
            self.assertNotIn("Access-Control-Allow-Origin", headers)
            status, heads, nothing = self.ask(path, method="HEAD")
            self.assertEqual((heads["Content-Length"], nothing), (str(len(text.encode())), ""))
            self.assertNotIn("http://", text)  # nothing comes from elsewhere
            self.assertNotIn("https://", text)
        self.assertEqual(self.server.server_address[0], "127.0.0.1")

    def test_other_methods_are_refused_and_nothing_is_written(self):
        self.make_running()
        self.serve()
        before = tree(self.directory)
        for method in ("POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "get", "<script>"):
            status, headers, text = self.ask(method=method)
            self.assertEqual((status, headers["Allow"], text), (405, "GET, HEAD", "only GET and HEAD\n"))
        self.page()
        self.assertEqual(tree(self.directory), before)

    def test_other_hosts_are_refused(self):
        self.make_running()
        self.serve()
        for hosts in ((), ("evil.example",), ("127.0.0.1.evil.example",), ("localhost.evil.example:80",), ("localhost", "evil.example"), ("localhost:80:80",),
                      ("[::1]",), ("127.0.0.1:",), ("",)):
            self.assertEqual(self.ask(hosts=hosts)[0], 403, hosts)
        for hosts in (("localhost",), ("127.0.0.1",), ("localhost:9999",), (f"127.0.0.1:{self.server.server_port}",)):
            self.assertEqual(self.ask(hosts=hosts)[0], 200, hosts)

    def test_addresses_without_the_word_or_beyond_the_pages(self):
        self.make_running()
        (self.directory / "secret.png").write_text("secret", encoding="utf-8")
        self.serve()
        word = self.server.word
        for path in ("/", "x", "//", "/watch.js", "/x/", f"/{word[:-1]}/", f"/{word}x/", f"/{word}", f"http://[/{word}/", f"/x/../{word}/"):
            self.assertEqual(self.ask(path, below=False)[0], 404, path)
        for path in ("../secret.png", "%2e%2e/secret.png", "..%2fsecret.png", "/etc/passwd", "scene.toml", "log.txt", "picture/../../secret.png",
                     "picture/secret.png", "watch.py", "server.py", "../watch.js", "case/0000/", "case/../", "case/0000/../../"):
            self.assertEqual(self.ask(path)[0], 404, path)

    def test_what_is_no_request(self):
        self.make_running()
        self.serve()
        word = self.server.word.encode()
        for sent, told in ((b"\xff\xfe\r\n\r\n", b"bad request"), (b"GET /%s/ HTTP/x\r\n\r\n" % word, b"bad request"), (b"GET /\xc3\xa9/ HTTP/1.0\r\nHost: localhost\r\n\r\n", b"404 "),
                             (b"GET /%s/ HTTP/1.0\r\n\r\n" % word, b"403 "), (b"GET /" + b"x" * 70000, b"414 "), (b"GET / HTTP/1.0\r\n" + b"a: b\r\n" * 200 + b"\r\n", b"431 ")):
            with socket.create_connection(("127.0.0.1", self.server.server_port), timeout=30) as connection:
                connection.sendall(sent)
                answer = connection.recv(4096)
            self.assertIn(told, answer.split(b"\r\n")[0], sent[:40])

    def test_links_that_lead_out_are_not_followed(self):
        self.make_running()
        secret = self.directory / "secret"
        for name in ("log.txt", "summary.json", "stolen.png"):
            (self.run_folder / name).unlink(missing_ok=True)
            secret.write_text('{"status": "finished", "reason": "secret words"}', encoding="utf-8")
            (self.run_folder / name).symlink_to(secret)
        (self.run_folder / "loop.png").symlink_to("loop.png")
        os.mkfifo(self.run_folder / "pipe.png")
        self.serve()
        page = self.page()
        self.assertIn(">running<", page)
        self.assertNotIn("secret", page)
        self.assertNotIn("End of the log", page)
        self.assertEqual(self.ask("picture")[0], 404)
        for name in ("timeseries.h5", "scene.toml"):
            (self.run_folder / name).rename(self.directory / name)
            (self.run_folder / name).symlink_to(self.directory / name)
            self.assertIn(f"Cannot be read: {name}: is no regular file of the run directory", self.page())


class Campaigns(WatchTest, CampaignTest):
    """Four cases: done, running, failed, not begun."""

    def setUp(self):
        CampaignTest.setUp(self)
        campaign_directory = self.directory
        WatchTest.setUp(self)
        self.directory = campaign_directory
        self.campaign("expand", program=self.checked_only())
        host = socket.gethostname()
        for number in (0, 1, 2):
            case = self.output / "cases" / f"{number:04}"
            make_run(case / "run")
            code = {0: " code 0", 2: " code 3"}.get(number, "")
            job = f"job local_0 host {host} pid {os.getpid()}"
            (case / "attempts.log").write_text(f"T start {job}\n" + (f"T end {job}{code}\n" if code else ""), encoding="utf-8")
            (case / "run" / "log.txt").write_text(LINE + "\n", encoding="utf-8")
            summary = {0: SUMMARY, 2: {"status": "failed", "exit_code": 3, "reason": MARKUP}}.get(number)
            (case / "run" / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
        (self.output / "cases/0001/run/summary.json").unlink()

    def test_the_table_and_its_cases(self):
        self.serve(self.output)
        page = self.page()
        Safety.check_elements(self, page)
        for text in ("1 done, 1 running, 1 failed, 1 not started", "A small campaign", 'value="0.2500"', "33 %, 0:01:00 left", "57.1 ± 3 N", "Mars", "0.5",
                     "1 of 2 cases is under-resolved, 1 failed", "&lt;script&gt;"):
            self.assertIn(text, page)
        self.assertEqual(re.findall(r'<a href="(case/\d+/)">', page), [f"case/{number:04}/" for number in range(4)])
        cases = [self.page(f"case/{number:04}/") for number in range(4)]
        for case, told in zip(cases, ("done: all phases ran", "33 % · at most", "failed: ", "This case has no run yet.")):
            Safety.check_elements(self, case)
            self.assertIn(told, case)
            self.assertIn('<a href="../../">All cases</a>', case)
        self.assertIn("<h1>Case 0002: slip 0.5, gravity Mars</h1>", cases[2])
        for path in ("case/0004/", "case/9999/", "case/00000/", "case/0000", "case/0000/run/", "case/0000/scene.toml", "case/0003/picture"):
            self.assertEqual(self.ask(path)[0], 404, path)

    def test_a_case_that_leads_out(self):
        outside = self.directory / "elsewhere"
        make_run(outside)
        shutil.rmtree(self.output / "cases/0001/run")
        (self.output / "cases/0001/run").symlink_to(outside)
        self.serve(self.output)
        self.assertEqual(self.ask("case/0001/")[0], 404)

    def test_a_manifest_that_goes_away(self):
        self.serve(self.output)
        (self.output / "cases/manifest.json").write_text("{", encoding="utf-8")
        status, headers, text = self.ask()
        self.assertEqual((status, headers["Content-Type"]), (500, "text/plain; charset=utf-8"))
        self.assertIn("manifest.json cannot be read", text)


class Command(WatchTest):
    def command(self, *arguments):
        return subprocess.run([sys.executable, ROOT / "jobs" / "watch.py", *map(str, arguments)], capture_output=True, text=True, timeout=60, check=False)

    def test_what_is_refused(self):
        self.run_folder.mkdir()
        for arguments, words in (((self.run_folder,), "is no run (it has no scene.toml) and no campaign"), ((self.run_folder / "x\x1b[2J",), "x\ufffd[2J: is no run"),
                                 ((), "RUN|CAMPAIGN"), ((self.run_folder, "--port", "0"), "a whole number from 1 to 65535")):
            done = self.command(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(words, done.stderr)
            self.assertNotIn("Traceback", done.stderr)

    def test_a_port_that_is_taken(self):
        self.make_running()
        self.serve()
        done = self.command(self.run_folder, "--port", self.server.server_port)
        self.assertEqual(done.returncode, 4)
        self.assertIn(f"port {self.server.server_port}: Address already in use; --port takes another", done.stderr)

    def test_it_prints_the_address_and_ends_when_interrupted(self):
        self.make_running()
        command = [sys.executable, ROOT / "jobs" / "watch.py", "--tread", "tread", self.run_folder, "--no-browser"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.addCleanup(process.kill)
            self.assertRegex(process.stdout.readline(), r"/run: http://127\.0\.0\.1:\d+/[\w-]{12}/ \(ctrl-C ends\)\n")
            process.send_signal(signal.SIGINT)
            self.assertEqual((process.wait(timeout=30), process.stderr.read()), (0, ""))


class Plots(unittest.TestCase):
    def drawn(self, y, x=None):
        text = plot("force", "N", [Curve("wheel", np.arange(len(y), dtype=float) if x is None else x, np.array(y))], "time")
        found = re.search(r'points="([^"]*)"', text)
        return np.array([[float(number) for number in pair.split(",")] for pair in found[1].split()]) if found else None

    def test_places(self):
        points = self.drawn([0.0, 10.0, 5.0])
        self.assertEqual(points[:, 0].tolist(), [64.0, 306.0, 548.0])
        self.assertEqual(points[0, 1] + points[1, 1], 2 * points[2, 1])
        self.assertLess(points[1, 1], points[0, 1])  # up is up

    def test_extremes_of_many_rows_are_drawn(self):
        y = np.zeros(100_000)
        y[54_321], y[76_543] = 7.0, -7.0
        points = self.drawn(y)
        self.assertLess(len(points), 1300)
        self.assertEqual((points[:, 1].min(), points[:, 1].max()), tuple(self.drawn([7.0, -7.0])[:, 1]))

    def test_values_that_cannot_be_drawn(self):
        self.assertEqual(len(self.drawn([0.0, np.nan, np.inf, 1.0, 1e300])), 2)
        for y in ([], [1.0], [np.nan, np.nan]):
            self.assertIsNone(self.drawn(y))
        for level in (0.0, 5.0, -1e-30, 1e120):
            self.assertEqual(len(set(self.drawn([level, level])[:, 1])), 1)


class Lines(unittest.TestCase):
    def test_a_line_without_answers_and_one_without_speed(self):
        line = "a  t b  t 0 / 3.6 s  0 steps  0 steps/s  ETA ?  dt 5.00e-05 s (growth)"
        self.assertEqual((PROGRESS.fullmatch(line)["phase"], PROGRESS.fullmatch(line)["eta"], PROGRESS.fullmatch(line)["pull"]), ("a  t b", "?", None))
        self.assertIsNone(PROGRESS.fullmatch("phase 'drive' begins at 0.9 s"))


if __name__ == "__main__":
    unittest.main()
