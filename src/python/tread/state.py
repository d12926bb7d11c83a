"""A run between two steps, as callbacks see it."""

from __future__ import annotations

import gc
import math
import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tread import library
from tread.errors import SceneError

KINDS = "fiu"  # of numbers: NumberKind of run/visit.hpp in NumPy's letters


@dataclass(frozen=True)
class BodyState:
    """A named body, world frame."""

    position: NDArray[np.float64]  # [3] m, centre of mass
    orientation: NDArray[np.float64]  # [4], w x y z, body to world
    velocity: NDArray[np.float64]  # [3] m/s
    angular_velocity: NDArray[np.float64]  # [3] rad/s
    axle: NDArray[np.float64]  # [3], unit vector
    spin: float  # rad/s about the axle
    lowest: float  # m, height of its lowest point
    force: NDArray[np.float64]  # [3] N, of its contacts, mean since the last callback; 0 in the first
    impulse: NDArray[np.float64]  # [3] N s, of its contacts since the run began
    mass: float  # kg
    rolling_radius: float  # m

    @property
    def slip(self) -> float:
        """1 - v_x / (spin rolling_radius); NaN for a wheel that does not turn."""
        rim = self.spin * self.rolling_radius
        return 1.0 - float(self.velocity[0]) / rim if abs(rim) > 1e-9 else math.nan


@dataclass(frozen=True)
class JointState:
    """A joint; force, torque and motor_torque are means since the last row of the time series, and 0 right after one."""

    coordinate: float  # m or rad
    motor_torque: float  # N m
    force: NDArray[np.float64]  # [3] N, on the second body
    torque: NDArray[np.float64]  # [3] N m, likewise, about the joint's point


class _Lent:
    """Memory of a run, as NumPy's array interface has it. Every array made of it, and every view of those, holds this object."""

    def __init__(self, field: library.Field):
        shape = (field.rows,) if field.columns == 1 else (field.rows, field.columns)
        self.__array_interface__ = {"version": 3, "shape": shape, "typestr": f"<{KINDS[field.kind]}{field.bytes}",
                                    "data": (field.data, True), "strides": (field.row_step, field.column_step)[:len(shape)]}


class _Field:
    """A read-only array of a run. None if the scene does not have it."""

    def __init__(self, name: str, doc: str):
        self.name, self.__doc__ = name, doc

    def __get__(self, table: _Table | None, owner: type | None = None) -> Any:
        return self if table is None else table._state.array(self.name)


class _Table:
    def __init__(self, state: State):
        self._state = state


class Points(_Table):
    """Material points of this rank in the order of memory, which changes: `id` says which is which."""

    position = _Field("points.position", "[n, 3] m")
    start = _Field("points.start", "[n, 3] m, position at the start")
    velocity = _Field("points.velocity", "[n, 3] m/s")
    kirchhoff_stress = _Field("points.kirchhoff_stress", "[n, 6] Pa, xx yy zz yz xz xy, tension positive: Cauchy stress times volume_ratio")
    mass = _Field("points.mass", "[n] kg")
    initial_volume = _Field("points.initial_volume", "[n] m3")
    volume_ratio = _Field("points.volume_ratio", "[n] present over initial volume")
    id = _Field("points.id", "[n] unique in the run")
    material = _Field("points.material", "[n] index of the [[material]]")
    plastic_shear = _Field("points.plastic_shear", "[n] equivalent plastic shear strain; of granular scenes")
    plastic_rate = _Field("points.plastic_rate", "[n] 1/s, rate of plastic_shear in the last step")

    @property
    def stress(self) -> NDArray[np.floating[Any]] | None:
        """[n, 6] Pa, Cauchy stress, as kirchhoff_stress; a new array."""
        kirchhoff = self.kirchhoff_stress
        return None if kirchhoff is None else kirchhoff / self.volume_ratio[:, None]


class Bodies(_Table):
    """Rigid bodies, those of [[body]] tables first, in their order. On several ranks `force` and `torque` are those of the
    bodies that the rank integrates."""

    position = _Field("bodies.position", "[n, 3] m, centre of mass")
    orientation = _Field("bodies.orientation", "[n, 4] x y z w, body to world, as scipy.spatial.transform.Rotation takes it")
    velocity = _Field("bodies.velocity", "[n, 3] m/s")
    angular_velocity = _Field("bodies.angular_velocity", "[n, 3] rad/s")
    mass = _Field("bodies.mass", "[n] kg")
    scale = _Field("bodies.scale", "[n] of the shape")
    shape = _Field("bodies.shape", "[n] index of the shape, as in shapes.h5")
    force = _Field("bodies.force", "[n, 3] N, of contacts in the last substep")
    torque = _Field("bodies.torque", "[n, 3] N m, likewise, about the centre of mass")


class Contacts(_Table):
    """Pairs of bodies, and of bodies and walls, that may touch, as of the last substep. On several ranks those that the rank has."""

    key = _Field("contacts.key", "[n] `first` and `second` packed")
    force = _Field("contacts.force", "[n, 3] N, on the first body")
    torque = _Field("contacts.torque", "[n, 3] N m, on the first body about its centre of mass")
    stiffness = _Field("contacts.stiffness", "[n] N/m; 0 where the pair does not touch")
    energy = _Field("contacts.energy", "[n] J, elastic")

    @property
    def first(self) -> NDArray[np.int64] | None:
        """[n] index of the first body; a new array."""
        return None if self.key is None else (self.key >> np.uint64(32)).astype(np.int64)

    @property
    def second(self) -> NDArray[np.int64] | None:
        """[n] index of the second body, or the number of bodies plus that of a wall; a new array."""
        return None if self.key is None else ((self.key & np.uint64(0xFFFFFFFF)) >> np.uint64(3)).astype(np.int64)


class State:
    """A run between two steps: valid in the callback only. On several ranks all make the same calls; what rank 0 sets counts.

    Arrays of `points`, `bodies` and `contacts` are read-only views of the run's memory on a CPU, and copies on a GPU or of sand
    that may sleep. None of them may outlive its callback: copy what is to be kept."""

    def __init__(self, visit: int):
        self._visit: int | None = visit
        self._lent: list[tuple[str, weakref.ref[_Lent]]] = []
        self.why: str | None = None  # the run is to stop
        when = library.visit_ask(visit, "when")
        self.time: float = when["time"]  # s
        self.steps: int = when["steps"]
        self.last_dt: float = when["last_dt"]  # s, of the last step
        self.phase: str = when["phase"]
        self.since_phase: float = when["since_phase"]  # s
        self.over: bool = when["over"]  # all phases ran: the last visit
        self.points, self.bodies, self.contacts = Points(self), Bodies(self), Contacts(self)

    def body(self, name: str) -> BodyState:
        """A [[body]] by its name."""
        return BodyState(**_arrays(self._ask("body", name=name)))

    def joint(self, name: str) -> JointState:
        """A [[joint]] by its name."""
        return JointState(**_arrays(self._ask("joint", name=name)))

    def steer(self, body: str, *, spin: float | None = None, forward: float | None = None, force: Sequence[float] = (0.0, 0.0, 0.0),
              torque: Sequence[float] = (0.0, 0.0, 0.0), axle_torque: float = 0.0) -> None:
        """Sets what a body does until this is called for it again or the phase ends.

        spin: rad/s about its axle; forward: m/s along x. They replace those of the phase's drive or motion. force (N) and torque
        (N m, both world frame) and axle_torque (N m about the body's own y axis) act besides those of its motion, and need one.
        SceneError where the phase does not let it: a held or lowered body, or an axis that its motion leaves free."""
        self._ask("steer body", name=body, spin=_number("spin", spin), forward=_number("forward", forward), force=_vector("force", force),
                  torque=_vector("torque", torque), axle_torque=_number("axle_torque", axle_torque))

    def motor(self, joint: str, speed: float, max_torque: float | None = None) -> None:
        """Sets the speed (rad/s) and the largest torque (N m; None: as before) of a joint's motor until the phase ends."""
        self._ask("steer motor", name=joint, speed=_number("speed", speed), max_torque=_number("max_torque", max_torque))

    def stop(self, why: str) -> None:
        """Ends the run after this callback and a checkpoint; `why` goes into its summary."""
        self.why = why

    def _ask(self, what: str, **request: Any) -> Any:
        return library.visit_ask(self._handle(), what, **request)

    def _handle(self) -> int:
        if self._visit is None:
            raise RuntimeError("the state of a run is valid in its callback only")
        return self._visit

    def array(self, name: str) -> NDArray[Any] | None:
        """A field by the name that the library has for it."""
        field = library.visit_field(self._handle(), name)
        if field is None:
            return None
        if field.rows == 0:
            return np.empty((0,) if field.columns == 1 else (0, field.columns), f"{KINDS[field.kind]}{field.bytes}")
        lent = _Lent(field)
        self._lent.append((name, weakref.ref(lent)))
        return np.asarray(lent)

    def end(self) -> list[str]:
        """Ends the visit; returns the names of arrays that are still in use."""
        self._visit = None
        if self._in_use():
            gc.collect()  # what only cycles hold
        return self._in_use()

    def _in_use(self) -> list[str]:
        return sorted({name for name, lent in self._lent if lent() is not None})


def _number(key: str, value: float | None) -> float | None:
    if value is not None and not math.isfinite(value):
        raise SceneError(f"steering: {key} = {value}; accepted: a finite number")
    return None if value is None else float(value)


def _vector(key: str, values: Sequence[float]) -> list[float | None]:
    if len(values) != 3:
        raise SceneError(f"steering: {key} has {len(values)} numbers; accepted: 3")
    return [_number(key, value) for value in values]


def _arrays(answer: dict[str, Any]) -> dict[str, Any]:
    """Lists as arrays; null, which stands for a number that is not finite, as NaN."""
    return {key: np.array(value, dtype=float) if isinstance(value, list) else math.nan if value is None else value for key, value in answer.items()}
