"""Errors of tread, by whose fault; exit codes are those of the program."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tread_post.run import Run


class TreadError(RuntimeError):
    """Base of the errors below, and a run that another rank has stopped by an error."""

    exit_code = 75


class SceneError(TreadError, ValueError):
    """The scene or an argument is wrong: the message names file or text, line, table and key, and what is accepted."""

    exit_code = 2


class NumericalError(TreadError):
    """The computation cannot go on; the message says what, where, when and which limit. `run` has what it left."""

    exit_code = 3

    def __init__(self, message: str, run: Run | None = None):
        super().__init__(message)
        self.run = run


class MachineError(TreadError):
    """The machine cannot do it: no GPU, no space, no permission, MPI."""

    exit_code = 4


def error_of(code: int, message: str) -> TreadError:
    """The error of an exit code."""
    kinds: dict[int, type[TreadError]] = {kind.exit_code: kind for kind in (SceneError, NumericalError, MachineError)}
    return kinds.get(code, TreadError)(message)
