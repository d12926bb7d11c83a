"""A display for VTK."""

import os
import shutil
import sys

from tread_post.run import RunError

WITHOUT_DISPLAY = (9, 5)  # VTK of PyPI draws by EGL where there is no display


def ensure_display():
    """VTK of Debian draws into a window: without a display this process starts again inside a virtual one."""
    from vtkmodules.vtkCommonCore import vtkVersion

    if os.environ.get("DISPLAY") or (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) >= WITHOUT_DISPLAY:
        return
    xvfb = shutil.which("xvfb-run")
    if xvfb is None:
        raise RunError("no display; install xvfb (apt-get install xvfb) or set DISPLAY")
    # A server that starts anew when its last client leaves refuses whoever comes just then.
    os.execv(xvfb, [xvfb, "--auto-servernum", "--server-args=-screen 0 2048x1536x24 -noreset", sys.executable, *sys.argv])
