"""Computes curves of the bodies of a run: joint positions, speeds, clearance in doorways, and contact forces."""

from __future__ import annotations

import math
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


@dataclass(frozen=True)
class Source:
    """Some curves, and how their values follow from a state."""

    curves: tuple[Curve, ...]
    read: Callable[[NDArray[np.float64], Contacts], Values]
    """Returns the value of each curve in a state, given the contacts since the state before; None if there is no value."""
    needs_pose: bool = False
    """Whether positions and velocities must be computed for a state first."""


class CurveReader:
    """Computes curves from the recorded states of a run; the run itself is not touched.

    Args:
        model: The compiled scene.
        world: The contents of the world, as in `Facts.world`.
    """

    def __init__(self, model: MjModel, world: dict[str, Any]) -> None:
        self._model, self._data = model, MjData(model)
        self._sources = [*_sources(model, self._data, world), _joints(model)]

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


def _sources(model: MjModel, data: MjData, world: dict[str, Any]) -> Iterator[Source]:
    """Yields the sources of the curves of bodies."""
    walls = world["walls"]
    for name, body in world["bodies"].items():
        geoms = np.flatnonzero(np.isin(model.geom_bodyid, _members(model, body["root"])))
        yield _motion(model, data, name, body["root"])
        for at, wall in walls.items():
            yield _clearance(model, data, name, geoms, wall, "" if len(walls) == 1 else f" of {at}")
        yield _force(name)


def _motion(model: MjModel, data: MjData, name: str, root: int) -> Source:
    """Returns the source of the place of a body's root [m], and of the horizontal speed of that point [m/s]."""
    curves = (Curve(f"{name} x", "m", "place"), Curve(f"{name} y", "m", "place"), Curve(f"{name} speed", "m/s", "speed"))
    return Source(curves, lambda _, __: place_and_speed(model, data, root), needs_pose=True)


def _clearance(model: MjModel, data: MjData, name: str, geoms: NDArray[np.intp], wall: dict[str, Any], where: str) -> Source:
    """Returns the source of a body's clearance in a doorway, as `PassageResult` measures it but without objects held in the hands.

    It is the smallest distance to the left and to the right wall segment [m]; None if no part of the body is in the doorway.

    Args:
        model: The compiled scene.
        data: Its state.
        name: The body's name.
        geoms: The body's geoms.
        wall: The wall with the doorway, as `surroundings` describes it.
        where: The suffix of the curves' names if there are several doorways.
    """
    from actr3d.experiment.aperture.clearance import Clearance  # also loads the world, which would slow the start
    from actr3d.world.scene_objects import Gap

    clearance = Clearance(model, data, geoms, Gap(**wall))
    curves = tuple(Curve(f"{name} clearance {side}{where}", "m", "clearance") for side in ("left", "right"))
    return Source(curves, lambda _, __: clearance.clearances() or (None, None), needs_pose=True)


def _force(name: str) -> Source:
    """Returns the source of the greatest force [N] of one object on one part of a body, summed over all contacts of the two.

    The ground does not count. The force is that at the beginnings of physics steps, as in `PassageResult`.
    """

    def read(_: NDArray[np.float64], contacts: Contacts) -> Values:
        return (max((force for (body, _, _), force in contacts.items() if body == name), default=0.0),)

    return Source((Curve(f"{name} contact force", "N", "contact"),), read)


def _joints(model: MjModel) -> Source:
    """Returns the source of the positions and speeds of joints; those of hinges in degrees."""
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
    places, scales = np.array(columns, dtype=np.intp), np.array(factors)
    return Source(tuple(curves), lambda numbers, _: (numbers[places] * scales).tolist())


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
