#!/usr/bin/python3
"""Follows a run or a campaign on a page for a browser on this machine: docs/watching.md. `tread watch RUN|CAMPAIGN` calls it.

It reads files and writes none; ctrl-C ends it. Python 3.11 or later with h5py and numpy.
"""

import argparse
import contextlib
import os
import sys
import webbrowser
from pathlib import Path

if sys.version_info < (3, 11):
    sys.exit("watch: error: Python 3.11 or later is needed")

from tread_jobs.errors import CampaignError, MachineError
from tread_jobs.files import printable

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "postprocess"))


def arguments():
    parser = argparse.ArgumentParser(prog="tread watch", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="RUN|CAMPAIGN", help="directory of a run, a campaign, a study, or a set of a validation")
    parser.add_argument("--port", type=port, default=0, metavar="N", help="of this machine, 1 to 65535; default: one that is free")
    parser.add_argument("--no-browser", action="store_true", help="print the address only")
    parser.add_argument("--tread", help=argparse.SUPPRESS)  # the program that was called
    return parser.parse_args()


def port(text):
    if not text.isdecimal() or not 1 <= int(text) <= 65535:
        raise argparse.ArgumentTypeError(f"{text}: a whole number from 1 to 65535")
    return int(text)


def opened_server(options):
    """The server, which listens; CampaignError or MachineError where that cannot be."""
    try:
        from tread_watch.server import Watched, WatchServer
    except ImportError as missing:
        raise MachineError(f"needs h5py and numpy ({missing}): on Debian /usr/bin/python3 with python3-h5py") from missing
    watched = Watched(options.folder)
    try:
        return WatchServer(watched, options.port)
    except OSError as error:
        raise MachineError(f"port {options.port}: {error.strerror}; --port takes another") from error


def main():
    options = arguments()
    try:
        server = opened_server(options)
    except (CampaignError, MachineError) as error:
        print(f"watch: error: {printable(error)}", file=sys.stderr)
        return error.exit_code
    with contextlib.suppress(KeyboardInterrupt):
        print(f"{printable(options.folder)}: {server.url} (ctrl-C ends)", flush=True)
        if not options.no_browser and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            webbrowser.open(server.url)
        server.serve_forever()
    return 0


if __name__ == "__main__":
    sys.exit(main())
