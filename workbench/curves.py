"""Curves of a run: how its joints stood, how fast its bodies went, how much room they had, how hard they were touched."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import NDArray

from actr3d.clock import microseconds

INTEGRATION = int(mujoco.mjtState.mjSTATE_INTEGRATION)
Values = Sequence[float | None]


class Curve(NamedTuple):
    """One curve."""

    name: str
    unit: str
    group: str
    """Curves of one group are drawn together: `joint`, `joint speed`, `place`, `speed`, `clearance` or `contact`."""


class Source(ABC):
    """What the values of some curves come from."""

    curves: tuple[Curve, ...]
    needs = 0
    """What must be computed of a state before: 0 nothing, 1 the geometry and speeds, 2 contacts and forces, too."""

    @abstractmethod
    def read(self, numbers: NDArray[np.float64]) -> Values:
        """Returns the value of each of its curves in a state; None where there is none."""


class Joints(Source):
    """Positions and speeds of joints, in degrees where they turn.

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

    def read(self, numbers: NDArray[np.float64]) -> Values:
        """Returns all positions and speeds."""
        return (numbers[self._columns] * self._factors).tolist()


class Motion(Source):
    """Where a body is, and how fast it goes over the ground.

    Args:
        model: The compiled scene.
        data: Its state.
        name: The body's name.
        root: The number of its MuJoCo body.
    """

    needs = 1

    def __init__(self, model: MjModel, data: MjData, name: str, root: int) -> None:
        self.curves = (Curve(f"{name} x", "m", "place"), Curve(f"{name} y", "m", "place"), Curve(f"{name} speed", "m/s", "speed"))
        self._model, self._data, self._root = model, data, root
        self._speeds = np.zeros(6)

    def read(self, numbers: NDArray[np.float64]) -> Values:
        """Returns the place of its root, and that point's speed."""
        mujoco.mj_objectVelocity(self._model, self._data, mujoco.mjtObj.mjOBJ_XBODY, self._root, self._speeds, 0)
        x, y, _ = self._data.xpos[self._root].tolist()
        return x, y, math.hypot(*self._speeds[3:5].tolist())


class Room(Source):
    """How much room a body has in a doorway, as `PassageResult` measures it, but for what it holds in its hands.

    Args:
        model: The compiled scene.
        data: Its state.
        name: The body's name.
        geoms: Its geoms.
        wall: The wall with the doorway, as `surroundings` tells it.
        where: What the names end with, where there are several doorways.
    """

    needs = 1

    def __init__(self, model: MjModel, data: MjData, name: str, geoms: NDArray[np.intp], wall: dict[str, Any], where: str) -> None:
        self.curves = tuple(Curve(f"{name} clearance {side}{where}", "m", "clearance") for side in ("left", "right"))
        from actr3d.simulation.clearance import Clearance, Wall  # they load the eye, too, without which the server starts sooner

        self._clearance = Clearance(model, data, geoms, Wall(**wall))

    def read(self, numbers: NDArray[np.float64]) -> Values:
        """Returns the smallest distances to the left and the right segment; None where nothing of it is in the doorway."""
        return self._clearance.rooms() or (None, None)


class Force(Source):
    """The hardest touch of a body by anything but the ground, as `PassageResult` measures it, but at the ends of ticks.

    Args:
        model: The compiled scene.
        data: Its state.
        name: The body's name.
        feels: The geoms that feel touches.
        own: For each geom whether it is the body's; the last is for soft things, which have none.
        owners: For each geom what tells the objects apart to which they belong; the last is for soft things.
        ground: The geoms that are the ground.
    """

    needs = 2

    def __init__(
        self,
        model: MjModel,
        data: MjData,
        name: str,
        *,
        feels: Iterable[int],
        own: NDArray[Any],
        owners: NDArray[Any],
        ground: Iterable[int],
    ) -> None:
        self.curves = (Curve(f"{name} contact force", "N", "contact"),)
        self._model, self._data, self._own, self._owners = model, data, own, owners
        # A geom without a name is felt as the part that it belongs to.
        self._parts = {geom: geom if model.geom(geom).name else -1 - int(model.geom_bodyid[geom]) for geom in feels}
        self._ground = frozenset(ground)
        self._wrench = np.zeros(6)

    def read(self, numbers: NDArray[np.float64]) -> Values:
        """Returns what presses hardest, summed over all contacts of one part with one object."""
        if self._data.ncon == 0:
            return (0.0,)
        pairs = self._data.contact.geom
        ours = self._own[pairs]
        forces: defaultdict[tuple[int, int], float] = defaultdict(float)
        for number in np.flatnonzero(ours[:, 0] != ours[:, 1]).tolist():
            mine, other = pairs[number].tolist() if ours[number, 0] else pairs[number, ::-1].tolist()
            if mine in self._parts and other not in self._ground and self._data.contact.dist[number] <= 0:
                mujoco.mj_contactForce(self._model, self._data, number, self._wrench)
                forces[self._parts[mine], int(self._owners[other])] += float(self._wrench[0])
        return (max(forces.values(), default=0.0),)


class Curves:
    """Computes curves from the states of a run, which it needs nothing else of; the run itself is left alone.

    Args:
        model: The compiled scene.
        world: What is in it, as `Facts.world` tells it.
    """

    def __init__(self, model: MjModel, world: dict[str, Any]) -> None:
        self._model, self._data = model, MjData(model)
        self._sources: list[Source] = [*_sources(model, self._data, world), Joints(model)]

    @property
    def names(self) -> list[dict[str, str]]:
        """What curves there are."""
        return [curve._asdict() for source in self._sources for curve in source.curves]

    def told(self, moments: Iterable[tuple[float, bytes]], names: Sequence[str] | None) -> dict[str, Any]:
        """Returns what is asked for: the `names` of all curves with unit and group, `times` [s], and the values of `curves` by name.

        Args:
            moments: Times [s] and MuJoCo's integration states then.
            names: Which curves; None for all. There are none of names that are not known.
        """
        wanted = [source for source in self._sources if names is None or any(curve.name in names for curve in source.curves)]
        depth = max((source.needs for source in wanted), default=0)
        times: list[float] = []
        columns: dict[str, list[float | None]] = {curve.name: [] for source in wanted for curve in source.curves}
        for time, state in moments if wanted else ():
            numbers = np.frombuffer(state)
            self._pose(numbers, depth)
            times.append(time)
            for source in wanted:
                for curve, value in zip(source.curves, source.read(numbers), strict=True):
                    columns[curve.name].append(value if value is not None and math.isfinite(value) else None)
        chosen = {name: values for name, values in columns.items() if names is None or name in names}
        return {"names": self.names, "times": times, "curves": chosen}

    def _pose(self, numbers: NDArray[np.float64], depth: int) -> None:
        """Computes as much of a state as is needed."""
        if depth:
            mujoco.mj_setState(self._model, self._data, numbers, INTEGRATION)
        if depth == 1:
            mujoco.mj_kinematics(self._model, self._data)
            mujoco.mj_comPos(self._model, self._data)
            mujoco.mj_comVel(self._model, self._data)
        elif depth == 2:
            mujoco.mj_forward(self._model, self._data)


NOTHING: dict[str, Any] = {"names": [], "times": [], "curves": {}}
"""The curves of a run that has no world."""


def joined(parts: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """Returns the curves of simulations that come one after the other as those of one run; each is null where it is not one of theirs."""
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
    """Yields where the curves of bodies come from."""
    roots = np.append(model.body_rootid[model.geom_bodyid], -1)
    owners = np.where(roots == 0, -2 - np.arange(len(roots)), roots)  # what lies in the world itself is an object of its own
    walls = world["walls"]
    for name, body in world["bodies"].items():
        own = np.append(np.isin(model.geom_bodyid, _members(model, body["root"])), False)
        yield Motion(model, data, name, body["root"])
        for at, wall in walls.items():
            yield Room(model, data, name, np.flatnonzero(own), wall, "" if len(walls) == 1 else f" of {at}")
        yield Force(model, data, name, feels=body["feels"], own=own, owners=owners, ground=world["ground"])


def _members(model: MjModel, root: int) -> list[int]:
    """Returns the MuJoCo bodies that a body consists of."""
    members = {root}
    for number in range(root + 1, model.nbody):
        if int(model.body_parentid[number]) in members:
            members.add(number)
    return sorted(members)


def stretch(first: float, last: float | None, period: int, zero: int = 0) -> tuple[int, int | None]:
    """Returns the first and the last tick of a stretch; None for one without end.

    Args:
        first: Its begin [s].
        last: Its end [s]; None for none.
        period: A tick [us].
        zero: When tick 0 was [us].
    """
    return -(-max(0, microseconds(first) - zero) // period), None if last is None else (microseconds(last) - zero) // period


def stride(count: int, most: int) -> int:
    """Returns each how manieth of so many moments is to be taken for no more than `most` of them."""
    return max(1, -(-count // most))
