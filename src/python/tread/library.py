"""libtread_python by ctypes; mirrors src/python/interface.hpp. Loading it starts MPI, which happens at the first call."""

from __future__ import annotations

import atexit
import ctypes
import functools
import json
import os
import sys
import threading
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tread.errors import MachineError, TreadError, error_of

STOP, GO_ON, STOP_AND_KEEP = 0, 1, 2  # what a visit returns

Text = ctypes.CFUNCTYPE(None, ctypes.c_char_p)
Visit = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
GoesOn = ctypes.CFUNCTYPE(ctypes.c_int)


class Calls(ctypes.Structure):
    _fields_ = [("visit", Visit), ("goes_on", GoesOn)]


class Field(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("kind", ctypes.c_int32), ("bytes", ctypes.c_int32),
                ("rows", ctypes.c_int64), ("columns", ctypes.c_int64), ("row_step", ctypes.c_int64), ("column_step", ctypes.c_int64)]


class Guarded:
    """A function as a callback of C, which cannot pass exceptions on: the first is kept in `error`, and the callback returns `failed`.

    The callback is the `send` of a generator. Python handles signals when it enters a function, before the first `try` of that
    function could see KeyboardInterrupt; a generator is entered within its `try`."""

    def __init__(self, function: Callable[[Any], Any], failed: int | None = None):
        self.error: BaseException | None = None
        self._calls = self._answers(function, failed)
        next(self._calls)

    @property
    def with_argument(self) -> Callable[[Any], Any]:
        return self._calls.send

    @property
    def without_argument(self) -> Callable[[], Any]:
        return self._calls.__next__

    def _answers(self, function: Callable[[Any], Any], failed: int | None) -> Generator[Any, Any, None]:
        result = None
        while True:
            try:
                argument = yield result
                result = function(argument)
            except GeneratorExit:
                return
            except BaseException as error:
                self.error = self.error or error
                result = failed


class Answer(Guarded):
    """Takes the text of an answer."""

    def __init__(self) -> None:
        self.text = ""
        super().__init__(self._take)
        self.callback = Text(self.with_argument)

    def _take(self, text: bytes) -> None:
        self.text = text.decode()


def _called(function: Any, *arguments: Any) -> tuple[int, str]:
    """Exit code and text of a function of the library."""
    answer = Answer()
    code = function(*arguments, answer.callback)
    if answer.error:
        raise answer.error
    return code, answer.text


def _asked(function: Any, *arguments: Any) -> str:
    code, text = _called(function, *arguments)
    if code:
        raise error_of(code, text)
    return text


@functools.cache
def _library() -> ctypes.CDLL:
    # GNU's OpenMP reads these when it is loaded: idle threads that spin keep others from working (base/thread_wait.hpp).
    if "OMP_WAIT_POLICY" not in os.environ:
        os.environ.setdefault("GOMP_SPINCOUNT", "10000")
    path = Path(__file__).with_name("libtread_python.so")
    try:
        library = ctypes.CDLL(str(path))
    except OSError as error:
        raise MachineError(f"{path}: the library of this package cannot be loaded: {error}") from error
    session = ctypes.c_void_p()
    _asked(library.tread_begin, ctypes.byref(session))
    if session:
        atexit.register(library.tread_end, session)
    _require_one_mpi(library)
    return library


def _require_one_mpi(library: ctypes.CDLL) -> None:
    """mpi4py, if the process has it, must be built with the MPI of the library: its handles mean nothing to another one."""
    mpi = sys.modules.get("mpi4py.MPI")
    if mpi is None:
        return
    features = _asked(library.tread_ask, b'{"what": "features"}')
    ours = next(line.removeprefix("MPI: ") for line in features.splitlines() if line.startswith("MPI: "))
    theirs = mpi.Get_library_version()
    if not theirs.startswith(ours):
        raise MachineError(f"mpi4py uses {theirs.splitlines()[0]}, tread {ours}: build both with one MPI")


def handle_of(comm: Any) -> int | None:
    """The Fortran handle of a communicator of mpi4py."""
    if comm is None:
        return None
    _require_one_mpi(_library())
    handle: int = comm.py2f()
    return handle


_turn = threading.Lock()


@contextmanager
def _alone(what: str) -> Iterator[None]:
    """The library for one caller: HDF5 bears no second one."""
    if not _turn.acquire(blocking=False):
        raise TreadError(f"tread: {what} in a callback of tread.run, or in a thread beside it: one comes after the other")
    try:
        yield
    finally:
        _turn.release()


def ask(what: str, **request: Any) -> str:
    """The answer to a request outside of runs."""
    with _alone(what):
        return _asked(_library().tread_ask, json.dumps({"what": what, **request}).encode())


def run(request: dict[str, Any], visit: Guarded | None, goes_on: Guarded) -> tuple[int, str]:
    """Runs a scene; returns the exit code, and the message of an error that left no summary."""
    calls = Calls(Visit(visit.with_argument) if visit else Visit(), GoesOn(goes_on.without_argument))
    with _alone("a run"):
        return _called(_library().tread_run, json.dumps(request).encode(), ctypes.byref(calls))


def visit_ask(visit: int, what: str, **request: Any) -> Any:
    text = _asked(_library().tread_visit_ask, ctypes.c_void_p(visit), json.dumps({"what": what, **request}).encode())
    return json.loads(text) if text else None


def visit_field(visit: int, name: str) -> Field | None:
    """None if the scene does not have the field."""
    field = Field(bytes=0)
    _asked(_library().tread_visit_field, ctypes.c_void_p(visit), name.encode(), ctypes.byref(field))
    return field if field.bytes else None


def features() -> str:
    """What the library was built from and with, as `tread --version`."""
    return ask("features")


def soils() -> str:
    """Published soils, as `tread soils`."""
    return ask("soils")
