"""A display for VTK."""

import os
import shutil
import sys

from tread_post.run import RunError


def ensure_display():
    """VTK of Debian draws into a window: without a display this process starts again inside a virtual one."""
    if os.environ.get("DISPLAY"):
        return
    xvfb = shutil.which("xvfb-run")
    if xvfb is None:
        raise RunError("no display; install xvfb (apt-get install xvfb) or set DISPLAY")
    os.execv(xvfb, [xvfb, "--auto-servernum", "--server-args=-screen 0 2048x1536x24", sys.executable, *sys.argv])
