"""Computes curves of the bodies of a run: joint positions, speeds, clearance in doorways, and contact forces."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

import mujoco
import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import NDArray

from actr3d.actr.kernel.run_limits import Contacts
from actr3d.clock import microseconds, seconds

INTEGRATION = int(mujoco.mjtState.mjSTATE_INTEGRATION)
Values = Sequence[float | None]
Moment = tuple[int, bytes, Contacts]
"""A tick, the state at its end, and the contacts since the state before."""
Shape = Literal["line", "points", "steps", "sum"]
"""How a curve is drawn: a line through the values at the ends of ticks; values of single moments; values that hold until the next one;
or a sum that grows evenly between its values."""


@dataclass(frozen=True)
class Curve:
    """Describes one curve."""

    name: str
    unit: str
    group: str
    """The group of curves that are drawn together: `joint`, `joint speed`, `place`, `speed`, `clearance` or `contact`; of what an agent
    does, such as `utility`, `activation` or the name of a slot."""
    of: str | None = None
    """The list in which it is offered; None for that of its group."""
    shape: Shape = "line"


class Source(ABC):
    """Computes the values of some curves from a state."""

    curves: tuple[Curve, ...]
    needs_pose = False
    """Whether positions and velocities must be computed for a state first."""

    @abstractmethod
    def read(self, numbers: NDArray[np.float64], contacts: Contacts) -> Values:
        """Returns the value of each of its curves in a state; None if there is no value.

        Args:
            numbers: The state.
            contacts: The contacts since the state before.
        """


class Joints(Source):
    """Reads positions and speeds of joints; those of hinges in degrees.

    Args:
        model: The compiled scene.
    """

    def __init__(self, model: MjModel) -> None:
        curves: list[Curve] = []
        columns: list[int] = []
        factors: list[float] = []
        for number in range(model.njnt):
            joint: Any = model.joint(number)
            kind = int(joint.type[0])
            if not joint.name or kind not in (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE)):
                continue
            turns = kind == int(mujoco.mjtJoint.mjJNT_HINGE)
            unit = "deg" if turns else "m"
            curves += Curve(joint.name, unit, "joint"), Curve(f"{joint.name} speed", f"{unit}/s", "joint speed")
            # The first number of a state is the time, then come all positions, then all speeds.
            columns += 1 + int(joint.qposadr[0]), 1 + model.nq + int(joint.dofadr[0])
            factors += [math.degrees(1) if turns else 1.0] * 2
        self.curves = tuple(curves)
        self._columns = np.array(columns, dtype=np.intp)
        self._factors = np.array(factors)

    def read(self, numbers: NDArray[np.float64], contacts: Contacts) -> Values:
        """Returns all joint positions and speeds."""
        return (numbers[self._columns] * self._factors).tolist()


class Motion(Source):
    """Computes the position of a body and its speed over the ground.

    Args:
        model: The compiled scene.
        data: The state of the scene.
        name: The body's name.
        root: The number of its MuJoCo body.
    """

    needs_pose = True

    def __init__(self, model: MjModel, data: MjData, name: str, root: int) -> None:
        self.curves = (Curve(f"{name} x", "m", "place"), Curve(f"{name} y", "m", "place"), Curve(f"{name} speed", "m/s", "speed"))
        self._model, self._data, self._root = model, data, root

    def read(self, numbers: NDArray[np.float64], contacts: Contacts) -> Values:
        """Returns x and y of the body's root [m] and the horizontal speed of that point [m/s]."""
        return place_and_speed(self._model, self._data, self._root)


class ClearanceCurves(Source):
    """Computes a body's clearance in a doorway, as `PassageResult` measures it but without objects held in the hands.

    Args:
        model: The compiled scene.
        data: The state of the scene.
        name: The body's name.
        geoms: The body's geoms.
        wall: The wall with the doorway, as `surroundings` describes it.
        where: The suffix of the curves' names if there are several doorways.
    """

    needs_pose = True

    def __init__(self, model: MjModel, data: MjData, name: str, geoms: NDArray[np.intp], wall: dict[str, Any], where: str) -> None:
        self.curves = tuple(Curve(f"{name} clearance {side}{where}", "m", "clearance") for side in ("left", "right"))
        from actr3d.experiment.aperture.clearance import Clearance  # also loads the world, which would slow the start
        from actr3d.world.scene_objects import Gap

        self._clearance = Clearance(model, data, geoms, Gap(**wall))

    def read(self, numbers: NDArray[np.float64], contacts: Contacts) -> Values:
        """Returns the smallest distances to the left and right wall segment [m]; None if no part of the body is in the doorway."""
        return self._clearance.clearances() or (None, None)


class Force(Source):
    """Reads the greatest contact force on a body from anything but the ground, at the beginnings of physics steps like `PassageResult`.

    Args:
        name: The body's name.
    """

    def __init__(self, name: str) -> None:
        self.curves = (Curve(f"{name} contact force", "N", "contact"),)
        self._name = name

    def read(self, numbers: NDArray[np.float64], contacts: Contacts) -> Values:
        """Returns the greatest force [N] of one object on one part, summed over all contacts of the two."""
        return (max((force for (body, _, _), force in contacts.items() if body == self._name), default=0.0),)


class CurveReader:
    """Computes curves from the recorded states of a run; the run itself is not touched.

    Args:
        model: The compiled scene.
        world: The contents of the world, as in `Facts.world`.
    """

    def __init__(self, model: MjModel, world: dict[str, Any]) -> None:
        self._model, self._data = model, MjData(model)
        self._sources: list[Source] = [*_sources(model, self._data, world), Joints(model)]

    @property
    def names(self) -> list[dict[str, str]]:
        """All curves with name, unit and group."""
        return [asdict(curve) for source in self._sources for curve in source.curves]

    def sampled(self, moments: Iterable[Moment], names: Sequence[str] | None, period: int, zero: int = 0) -> dict[str, Any]:
        """Returns `names` (all curves with unit and group), `times` [s], and `curves` (values by name).

        Args:
            moments: The moments, as `thinned` yields them.
            names: The curves to compute; None for all. Unknown names are ignored.
            period: Length of a tick [us].
            zero: Time of tick 0 [us].
        """
        wanted = [source for source in self._sources if names is None or any(curve.name in names for curve in source.curves)]
        needs_pose = any(source.needs_pose for source in wanted)
        times: list[float] = []
        columns: dict[str, list[float | None]] = {curve.name: [] for source in wanted for curve in source.curves}
        for tick, state, contacts in moments if wanted else ():
            numbers = np.frombuffer(state)
            if needs_pose:
                self._pose(numbers)
            times.append(seconds(zero + tick * period))
            for source in wanted:
                for curve, value in zip(source.curves, source.read(numbers, contacts), strict=True):
                    columns[curve.name].append(value if value is not None and math.isfinite(value) else None)
        chosen = {name: values for name, values in columns.items() if names is None or name in names}
        return {"names": self.names, "times": times, "curves": chosen}

    def _pose(self, numbers: NDArray[np.float64]) -> None:
        """Computes the quantities that the curves need for a state."""
        mujoco.mj_setState(self._model, self._data, numbers, INTEGRATION)
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_comVel(self._model, self._data)


NOTHING: dict[str, Any] = {"names": [], "times": [], "curves": {}}
"""The curves of a run without a world."""


def joined(parts: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """Joins the curves of consecutive simulations into those of one run; a curve is null where a simulation does not have it."""
    names: dict[str, dict[str, str]] = {}
    times: list[float] = []
    curves: dict[str, list[float | None]] = {}
    for part in parts:
        names |= {curve["name"]: curve for curve in part["names"]}
        for name in {**curves, **part["curves"]}:
            known = curves.setdefault(name, [None] * len(times))
            known += part["curves"].get(name, [None] * len(part["times"]))
        times += part["times"]
    return {"names": list(names.values()), "times": times, "curves": curves}


def _sources(model: MjModel, data: MjData, world: dict[str, Any]) -> Iterable[Source]:
    """Yields the sources of the curves of bodies."""
    walls = world["walls"]
    for name, body in world["bodies"].items():
        geoms = np.flatnonzero(np.isin(model.geom_bodyid, _members(model, body["root"])))
        yield Motion(model, data, name, body["root"])
        for at, wall in walls.items():
            yield ClearanceCurves(model, data, name, geoms, wall, "" if len(walls) == 1 else f" of {at}")
        yield Force(name)


def _members(model: MjModel, root: int) -> list[int]:
    """Returns the MuJoCo bodies that make up a body."""
    members = {root}
    for number in range(root + 1, model.nbody):
        if int(model.body_parentid[number]) in members:
            members.add(number)
    return sorted(members)


def stretch(first: float, last: float | None, period: int, zero: int = 0) -> tuple[int, int | None]:
    """Returns the first and the last tick of an interval; the last is None if it is open-ended.

    Args:
        first: Start of the interval [s].
        last: End of the interval [s]; None if it is open-ended.
        period: Length of a tick [us].
        zero: Time of tick 0 [us].
    """
    return -(-max(0, microseconds(first) - zero) // period), None if last is None else (microseconds(last) - zero) // period


def stride(count: int, most: int) -> int:
    """Returns the step n, so that every n-th of `count` moments gives at most `most` moments."""
    return max(1, -(-count // most))


def place_and_speed(model: MjModel, data: MjData, body: int) -> tuple[float, float, float]:
    """Returns x and y of a MuJoCo body [m], and its horizontal speed [m/s], from data with positions and velocities."""
    speeds = np.zeros(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, body, speeds, 0)
    x, y, _ = data.xpos[body].tolist()
    return x, y, math.hypot(*speeds[3:5].tolist())


def harder(one: Contacts, other: Contacts) -> Contacts:
    """Returns the greatest force of each contact in two periods."""
    if not (one and other):
        return one or other
    return {contact: max(one.get(contact, 0.0), other.get(contact, 0.0)) for contact in {**one, **other}}


def thinned(known: Callable[[], Iterable[Moment]], most: int, every: int = 1) -> Iterator[Moment]:
    """Yields known moments: evenly spaced ones, those with contacts, and the last one; no contact is lost.

    Args:
        known: Returns the known moments, each time from the first on.
        most: Maximum number of evenly spaced moments, at least 2, and of those with contacts.
        every: Every n-th tick is known, besides the last one.
    """
    count, last, touched = 0, -1, list[int]()
    for last, _, contacts in known():
        count += 1
        if contacts:
            touched.append(last)
    every *= stride(count, most - 1)
    chosen = {last, *touched[:: stride(len(touched), most)]}
    since: Contacts = {}
    for tick, state, contacts in known():
        since = harder(since, contacts)
        if tick % every == 0 or tick in chosen:
            yield tick, state, since
            since = {}
