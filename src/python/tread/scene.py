"""Scenes from files, texts or Python objects."""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from tread_jobs.toml_text import toml_text, value_text

from tread import library
from tread.errors import SceneError


class Scene:
    """A scene: its keys are those of docs/scene.md. Nothing is read or checked before it is asked for.

    Scene({"domain": {"size": [1, 1, 1]}, "material": [{...}], ...}): tables are dicts, lists of tables are lists of dicts; NumPy's
    numbers and arrays and paths are taken, too. `directory` is the base of relative file names."""

    def __init__(self, keys: Mapping[str, Any], directory: str | os.PathLike[str] = "."):
        self._set(text=toml_text(plain(keys)), name="<scene>", directory=os.path.abspath(directory))

    @classmethod
    def from_text(cls, text: str, directory: str | os.PathLike[str] = ".") -> Scene:
        """A scene of a text in TOML."""
        scene = cls.__new__(cls)
        scene._set(text=text, name="<scene>", directory=os.path.abspath(directory))
        return scene

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Scene:
        """A scene of a TOML file."""
        scene = cls.__new__(cls)
        scene._set(path=str(Path(path).absolute()))
        return scene

    def _set(self, overrides: Sequence[str] = (), **source: str) -> None:
        self._source, self._overrides = source, tuple(overrides)

    def with_values(self, values: Mapping[str, Any]) -> Scene:
        """This scene with other values, as --set: {"material.sand.young": 1e6, "phase[2].drive.slip": 0.1}."""
        scene = Scene.__new__(Scene)
        settings = [f"{key}={value_text(plain(value, key))}" for key, value in values.items()]
        scene._set((*self._overrides, *settings), **self._source)
        return scene

    @property
    def request(self) -> dict[str, Any]:
        """What the library is asked with."""
        return {**self._source, "overrides": list(self._overrides)}

    @property
    def resolved(self) -> str:
        """TOML with every key explicit. SceneError names each key that is wrong."""
        return library.ask("resolved", scene=self.request)

    @property
    def keys(self) -> dict[str, Any]:
        """`resolved` as dicts."""
        return tomllib.loads(self.resolved)

    def check(self) -> dict[str, Any]:
        """What `tread check --json` prints: warnings, cost, phases, ground under each wheel. SceneError as `resolved`."""
        answer: dict[str, Any] = json.loads(library.ask("check", scene=self.request))
        return answer

    def report(self, stages: Literal["hidden", "shown"] = "hidden") -> str:
        """What `tread check` prints for people."""
        return library.ask("stages" if stages == "shown" else "report", scene=self.request)


def scene_of(scene: Scene | Mapping[str, Any] | str | os.PathLike[str]) -> Scene:
    """A scene as it is, of dicts, or of a file."""
    if isinstance(scene, Scene):
        return scene
    return Scene(scene) if isinstance(scene, Mapping) else Scene.from_file(scene)


def plain(value: Any, key: str = "") -> Any:
    """`value` of what TOML has; SceneError names the key of anything else."""
    if isinstance(value, Mapping):
        for name in value:
            if not isinstance(name, str):
                raise SceneError(f"<scene>: {key or 'top level'}: a key of type {type(name).__name__}; accepted: str")
        return {name: plain(item, f"{key}.{name}" if key else name) for name, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist(), key)
    if isinstance(value, list | tuple):
        return [plain(item, f"{key}[{place}]") for place, item in enumerate(value)]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, bool | int | float | str):
        return value
    raise SceneError(f"<scene>: {key}: a value of type {type(value).__name__}; "
                     "accepted: bool, int, float, str, path, list, tuple, dict, NumPy's numbers and arrays")
