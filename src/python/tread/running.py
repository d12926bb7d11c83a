"""Runs in this process."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any, Literal

from tread_post.run import Run

from tread import library
from tread.errors import NumericalError, TreadError, error_of
from tread.scene import Scene, scene_of
from tread.state import State

FAILED = "an error in a callback"  # begins the reason of a run that one has stopped


def run(
    scene: Scene | Mapping[str, Any] | str | os.PathLike[str],
    output: str | os.PathLike[str],
    *,
    existing: Literal["refuse", "overwrite"] = "refuse",
    backend: Literal["auto", "cpu", "cuda"] = "auto",
    threads: int = 0,
    restart: str | os.PathLike[str] = "none",
    walltime_limit: float = 0.0,
    hang_timeout: float = 600.0,
    terminal: Literal["silent", "shown"] = "silent",
    on_span: Callable[[State], None] | None = None,
    span: float = 0.0,
    span_steps: int = 0,
    comm: Any = None,
) -> Run:
    """Runs a scene in this process into the run directory `output`, as `tread run` does, and returns that.

    on_span(state) is called at the start of each phase, every `span` s of simulated time or `span_steps` steps, and at the end;
    it waits for a measured state, up to eight steps, so that a run is the same whether it is looked at or not. threads = 0: as
    many as OpenMP finds. restart: "none", "auto" or a checkpoint. walltime_limit: s from this call, 0 = none. comm: a
    communicator of mpi4py; None: all processes of the launcher.

    A run that was stopped (state.stop, walltime_limit) returns, and its summary says so. NumericalError where it failed, with
    what it left; SceneError and MachineError before the first step. Errors of the callback and KeyboardInterrupt stop the run
    after a checkpoint and go on to the caller. hang_timeout: s for which a rank may wait for another, callbacks included."""
    _require(existing in ("refuse", "overwrite"), "existing", existing, '"refuse" or "overwrite"')
    _require(backend in ("auto", "cpu", "cuda"), "backend", backend, '"auto", "cpu" or "cuda"')
    _require(terminal in ("silent", "shown"), "terminal", terminal, '"silent" or "shown"')
    _require(0 <= threads <= 4096, "threads", threads, "0 to 4096")
    _require(0 <= walltime_limit < float("inf"), "walltime_limit", walltime_limit, "s, 0 at least")
    _require(0 <= span < float("inf") and 0 <= span_steps < 2**62, "span, span_steps", (span, span_steps), "s and steps, 0 at least")
    request = {
        "scene": scene_of(scene).request, "output": os.fspath(output), "existing": existing, "backend": backend, "threads": int(threads),
        "restart": os.fspath(restart), "walltime_limit": float(walltime_limit), "hang_timeout": float(hang_timeout), "terminal": terminal,
        "every": float(span), "every_steps": int(span_steps), "communicator": library.handle_of(comm),
    }
    visits = None if on_span is None else _Visits(on_span)
    visit = None if visits is None else library.Guarded(visits, library.STOP)
    goes_on = library.Guarded(lambda _: library.GO_ON, library.STOP)
    code, message = library.run(request, visit, goes_on)
    error = (visits and visits.error) or (visit and visit.error) or goes_on.error
    if error:
        raise error
    if message:
        raise error_of(code, message)
    return _ended(Run(output), code)


class _Visits:
    """Calls a callback with the state; keeps the error that stops the run."""

    def __init__(self, on_span: Callable[[State], None]):
        self.on_span = on_span
        self.error: BaseException | None = None

    def __call__(self, visit: int) -> int:
        state = State(visit)
        try:
            self.on_span(state)
        except BaseException as error:
            self.error = error
        in_use = state.end()
        if in_use and self.error is None:
            self.error = BufferError(f"{', '.join(in_use)}: still in use after the callback; keep a copy: numpy.array(...)")
        why = state.why if self.error is None else f"{FAILED}: {type(self.error).__name__}: {self.error}"
        if why is None:
            return library.GO_ON
        library.visit_ask(visit, "stop", why=why)
        return library.STOP_AND_KEEP if in_use else library.STOP


def _ended(left: Run, code: int) -> Run:
    reason = (left.summary or {}).get("reason", "") if code else ""
    if code == NumericalError.exit_code:
        raise NumericalError(reason, left)
    if reason.startswith(f"stopped by {FAILED}"):
        raise TreadError(f"another rank: {reason}")
    return left


def _require(is_right: bool, name: str, value: Any, accepted: str) -> None:
    if not is_right:
        raise error_of(2, f"tread.run: {name} = {value!r}; accepted: {accepted}")
