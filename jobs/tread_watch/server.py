"""The server of `tread watch`: GET and HEAD of a few addresses below a secret word, for this machine alone."""

import hmac
import re
import secrets
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from tread_jobs.directory import CampaignDirectory
from tread_jobs.errors import CampaignError
from tread_jobs.files import printable
from tread_post.page import STYLE, page
from tread_post.run import DAMAGE, words_of
from tread_watch.campaign_page import campaign_parts, pause_of
from tread_watch.run_page import AXES, PICTURES, newest_picture, run_parts, run_title, waiting_parts

HERE = Path(__file__).resolve().parent
RUN_PAUSE = 1  # s for which the page of a run is kept
COST = 5  # times as long as it took to make, at least: a login node has other users
HOST = re.compile(r"(localhost|127\.0\.0\.1)(:\d{1,5})?")
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; base-uri 'none'; "
                               "form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer", "Cross-Origin-Resource-Policy": "same-origin",
}
NOT_KEPT, KEPT = "no-store", "private, max-age=3600"


class Watched:
    """A run directory, or a campaign's, as pages. Each is made anew only once it is older than its pause."""

    def __init__(self, folder):
        self.folder = Path(folder).resolve()
        self.campaign = None if (self.folder / "scene.toml").is_file() else CampaignDirectory(self.folder)
        if self.campaign and not self.campaign.is_expanded:
            raise CampaignError(f"{printable(folder)}: is no run (it has no scene.toml) and no campaign (it has no cases/manifest.json)")
        self._pages, self._lock = {}, threading.Lock()

    @property
    def title(self):
        return printable(self.campaign.manifest["title"]) if self.campaign else run_title(self.folder)

    def run_folder(self, case):
        """Folder of the run of a case, "" for the run itself; None where there is no such case, or where it leads out of the campaign."""
        if not self.campaign:
            return self.folder if not case else None
        if case not in {entry.name for entry in self.campaign.entries()}:
            return None
        folder = (self.campaign.cases / case / "run").resolve()
        return folder if folder.is_relative_to(self.campaign.cases) else None

    def page(self, case, along):
        """Bytes of the page of a case, "" for the first page; None where there is none."""
        if case and self.run_folder(case) is None:
            return None
        with self._lock:  # of many visitors, one makes the page
            kept = self._pages.get((case, along))
            begun = time.monotonic()
            if kept is None or begun > kept[0]:
                text, done = self._made(case, along), time.monotonic()
                pause = pause_of(self.campaign) if self.campaign and not case else RUN_PAUSE
                kept = self._pages[(case, along)] = (done + max(pause, COST * (done - begun)), text)
        return kept[1]

    def picture(self, case):
        """(bytes, media type) of the newest picture of a run; None without one."""
        folder = self.run_folder(case)
        path = folder and newest_picture(folder)
        return (path.read_bytes(), PICTURES[path.suffix]) if path else None

    def _case_title(self, case):
        """Title of a case: its number and its values."""
        labels = next(entry.labels for entry in self.campaign.entries() if entry.name == case)
        return printable(f"Case {case}: " + (", ".join(f"{name} {label}" for name, label in labels.items()) or self.title))

    def _made(self, case, along):
        if self.campaign and not case:
            short, parts, title = *campaign_parts(self.campaign), self.title
        else:
            folder = self.run_folder(case)
            begun = (folder / "scene.toml").is_file()
            short, parts = run_parts(folder, along) if begun else waiting_parts(folder.parent)
            title = self._case_title(case) if case else self.title
        up = "../../" if case else ""
        head = f'<link rel="stylesheet" href="{up}watch.css"><script defer src="{up}watch.js"></script>'
        back = [f'<p><a href="{up}">All cases</a></p>'] if case else []
        told = [f'<main data-title="{short} – ">', *back, *parts, "</main>", '<p id="lost" hidden>This page is no longer fresh: tread watch has ended, or cannot read the files.</p>']
        return page(title, told, head).encode("utf-8", "replace")


class Handler(BaseHTTPRequestHandler):
    """Answers a request. Whatever is not asked for in the right way gets a short text and no reflection of what it sent."""

    timeout = 10  # s for a visitor to say what he wants
    server_version, sys_version = "tread", ""

    def do_GET(self):
        self._answer()

    do_HEAD = do_GET

    def send_error(self, code, message=None, explain=None):
        """Answers what http.server refuses: bad requests and unknown methods."""
        if code == 501:
            self._send(405, b"only GET and HEAD\n", "text/plain", {"Allow": "GET, HEAD"})
        else:
            self._send(code, b"bad request\n", "text/plain")

    def log_message(self, format, *arguments):
        pass

    def _answer(self):
        hosts = self.headers.get_all("Host", [])
        if len(hosts) != 1 or not HOST.fullmatch(hosts[0]):  # a name of somebody else that leads here
            return self._send(403, b"only for localhost\n", "text/plain")
        try:
            found = self._found()
        except (CampaignError, *DAMAGE) as error:
            return self._send(500, printable(f"{words_of(error)}\n").encode("utf-8", "replace"), "text/plain")
        return self._send(200, *found) if found else self._send(404, b"no such page\n", "text/plain")

    def _found(self):
        """(bytes, media type, headers) of an address; None where there is nothing."""
        path, _, query = self.path.partition("?")
        word, slash, rest = path.removeprefix("/").partition("/")
        if not slash or not hmac.compare_digest(word.encode("utf-8", "replace"), self.server.word.encode()):
            return None
        if rest == "watch.js":
            return (HERE / "watch.js").read_bytes(), "text/javascript", {}
        if rest == "watch.css":
            return (STYLE + (HERE / "watch.css").read_text(encoding="utf-8")).encode(), "text/css", {}
        place = re.fullmatch(r"(?:case/(\d{4,9})/)?(picture)?", rest, re.ASCII)
        if not place:
            return None
        case, watched = place[1] or "", self.server.watched
        if place[2]:
            picture = watched.picture(case)
            return (*picture, {"Cache-Control": KEPT}) if picture else None
        along = query.removeprefix("against=")
        text = watched.page(case, along if along in AXES else "time")
        return (text, "text/html", {}) if text else None

    def _send(self, code, content, kind, headers=None):
        self.send_response(code)
        kind = kind if kind.startswith("image/") else f"{kind}; charset=utf-8"
        told = {"Content-Type": kind, "Content-Length": len(content), "Cache-Control": NOT_KEPT, **HEADERS, **(headers or {})}
        for name, value in told.items():
            self.send_header(name, str(value))
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(content)


class WatchServer(ThreadingHTTPServer):
    """Serves a Watched on 127.0.0.1. OSError where the port is taken; 0 takes any that is free."""

    daemon_threads = True

    def __init__(self, watched, port):
        self.watched, self.word = watched, secrets.token_urlsafe(9)
        super().__init__(("127.0.0.1", port), Handler)

    @property
    def url(self):
        return f"http://127.0.0.1:{self.server_port}/{self.word}/"

    def handle_error(self, request, client_address):
        """A visitor who went away is no error worth a word."""
