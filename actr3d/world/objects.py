"""Objects that a user can move by hand: bodies, walls and other fixed obstacles, loose objects."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Literal, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from actr3d.errors import WorldError, alternatives
from actr3d.world.body import Body
from actr3d.world.command_registry import checked_angle, checked_number
from actr3d.world.frames import heading_in, turn_to, wrapped
from actr3d.world.physics import Physics

MAX_PENETRATION = 0.01
"""Greatest depth of two objects in each other that a move by a user may cause [m]. Up to this depth, contacts as stiff as those of walls
push an object that can give way out at less than 3 m/s. From a greater depth they would throw it away, or press it with unlimited force.
Source: chosen for this library."""

MAX_PENETRATION_BETWEEN_TWO = 0.00075
"""The same for an object that is pressed from two sides, so that it cannot give way [m]: with 2 mm at each side, contacts throw a person
out of a gap at 7 m/s. Source: chosen for this library."""

AGAINST = -0.5
"""The cosine of the angle between two pushes from which an object between them counts as squeezed. Source: chosen, 120 degrees."""

FARTHEST = 10_000.0
"""Greatest coordinate of a place [m]: there, the numbers of 32 bits with which scenes are drawn still distinguish millimetres."""

MAX_FORCE = 1e5
"""Greatest force of a push along an axis [N]. Source: chosen for this library."""

LONGEST = 60.0
"""Longest push [s]. Source: chosen for this library."""

Placement = tuple[float, float, float]
"""Place and heading of an object: x [m], y [m], heading [rad]."""


class Penetration(NamedTuple):
    """How deep objects are in another one [m]."""

    depth: float
    """The greatest depth."""
    permitted: float
    """The greatest depth after something was moved by hand."""


NONE = Penetration(0.0, MAX_PENETRATION)
"""That of objects that do not touch."""


class Objects:
    """Finds, moves and pushes the objects of a world that can move or be moved by hand.

    Args:
        physics: The compiled scene and its state.
        bodies: The bodies of the world by name.
        excluded: The names of MuJoCo bodies that a user cannot move directly, such as the segments of apertures.
    """

    def __init__(self, physics: Physics, bodies: Mapping[str, Body], excluded: frozenset[str]) -> None:
        model = physics.mj_model
        self._physics = physics
        self._all_bodies = bodies
        self._bodies = {name: body for name, body in bodies.items() if body.base.planar or body.base.free}
        names = {int(number): str(model.body(int(number)).name) for number in np.flatnonzero(model.body_parentid == 0)[1:]}
        own = {body.root for body in bodies.values()}
        self._obstacles = {name: number for number, name in names.items() if model.body_mocapid[number] >= 0 and name not in excluded}
        self._loose = {name: number for number, name in names.items() if number in physics.free_joints and number not in own}

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all objects that can be moved."""
        return (*self._bodies, *self._obstacles, *self._loose)

    def pose(self, name: str) -> Placement:
        """Returns where an object is, its heading in -pi to pi.

        Raises:
            WorldError: If there is no such object.
        """
        number, data = self._number(name, self.names, "move"), self._physics.mj_data
        if name in self._bodies and self._bodies[name].base.planar:
            x, y, heading = self._bodies[name].base.pose
            return x, y, wrapped(heading)
        if name in self._obstacles:
            mocap = int(self._physics.mj_model.body_mocapid[number])
            (x, y, _), turned = data.mocap_pos[mocap].tolist(), data.mocap_quat[mocap]
        else:
            at, _ = self._physics.free_joints[number]
            (x, y, _), turned = data.qpos[at : at + 3].tolist(), data.qpos[at + 3 : at + 7]
        return x, y, heading_in(turned.tolist())

    def move(self, name: str, x: float, y: float, heading: float | None) -> None:
        """Puts an object at (x, y) [m], with a heading [rad] or its present one; a loose object comes to rest.

        Raises:
            WorldError: If there is no such object, a value is wrong, a hand of another body holds it, or it, or an object that it holds,
                would be inside another object. Then nothing is moved.
        """
        number, physics = self._number(name, self.names, "move"), self._physics
        x, y, heading = checked_pose("move", x, y, heading)
        hands = self._bodies[name].hands.values() if name in self._bodies else ()
        moved = {number, *(hand.held.object for hand in hands if hand.held is not None)}
        self._check_free(name, moved)
        before, depths = physics.integration_state(), self.depths(moved)
        held = self._bodies[name].state() if name in self._bodies else None
        if name in self._bodies:
            self._bodies[name].set("teleport", x, y, heading)
        elif name in self._obstacles:
            mocap = int(physics.mj_model.body_mocapid[number])
            physics.mj_data.mocap_pos[mocap, :2] = (x, y)
            if heading is not None:
                turn_to(physics.mj_data.mocap_quat[mocap], heading)
        else:
            physics.put_loose(number, x, y, heading)
        physics.changed()
        others = too_deep(depths, self.depths(moved))
        if others:
            physics.restore(before)
            if held is not None:
                self._bodies[name].restore(held)
            physics.changed()
            raise WorldError(f"'{name}' cannot be put at ({x:g}, {y:g}) m: it would be inside {', '.join(map(repr, others))}; leave room")

    def _check_free(self, name: str, moved: set[int]) -> None:
        """Raises an error if a hand of another body holds an object, or something that moves with it: the grip would throw it away.

        Raises:
            WorldError: If one does.
        """
        for body in self._all_bodies.values():
            for side, hand in body.hands.items():
                if body.name != name and hand.held is not None and hand.held.object in moved:
                    held = str(self._physics.mj_model.body(hand.held.object).name)
                    what = "it" if held == name else f"'{held}'"
                    raise WorldError(f"'{name}' cannot be moved: {what} is in the {side} hand of '{body.name}'; release it first")

    def pushed(self, name: str) -> int:
        """Returns the MuJoCo body that a push of an object acts on.

        Raises:
            WorldError: If there is no such object, or it cannot be pushed.
        """
        return self._number(name, (*self._bodies, *self._loose), "push")

    def strike(self, number: int) -> None:
        """Records that a user pushes a MuJoCo body: its body then resists only with the force of its servos, as in contact."""
        for body in self._bodies.values():
            if body.root == number:
                body.hold.strike()

    def _number(self, name: str, names: tuple[str, ...], what: str) -> int:
        if name not in names:
            if isinstance(name, str) and name in self._obstacles:  # pyright: ignore[reportUnnecessaryIsInstance]
                raise WorldError(f"'{name}' is fixed; there are: {', '.join(names) or 'none'}")
            raise WorldError(f"no object '{name}' to {what}{alternatives(name, names)}")
        return self._bodies[name].root if name in self._bodies else self._obstacles[name] if name in self._obstacles else self._loose[name]

    def depths(self, roots: Collection[int], *, others: Literal["all", "fixed", "moving"] = "all") -> dict[str, Penetration]:
        """Returns by name the depth of some objects in each other object.

        Args:
            roots: The MuJoCo bodies that are the roots of these objects.
            others: Which other objects count: `"fixed"` are those that cannot move by themselves, without planes, which push out gently
                whatever is in them.
        """
        physics = self._physics
        physics.refresh_contacts()
        contacts, depths = physics.mj_data.contact, dict[str, Penetration]()
        pairs: list[list[int]] = contacts.geom.tolist()
        kinds = [[self._kind(geom) for geom in pair] for pair in pairs]
        model = physics.mj_model
        ends = [[int(model.body_rootid[model.geom_bodyid[geom]]) if geom >= 0 else -1 for geom in pair] for pair in pairs]
        pushes = [n for n, kind in enumerate(kinds) if others != "fixed" or others in kind]  # what can move gives way to what is fixed
        for n, distance in enumerate(contacts.dist.tolist()):
            mine = [end in roots for end in ends[n]]
            side = int(mine[0])  # that of the other object, if one of the two is
            if mine[0] != mine[1] and pairs[n][side] >= 0 and others in ("all", kinds[n][side]):
                other = physics.owners[pairs[n][side]]
                known, permitted = depths.get(other, NONE)
                if -distance > MAX_PENETRATION_BETWEEN_TWO and any(self._against(ends, n, push) for push in pushes):
                    permitted = MAX_PENETRATION_BETWEEN_TWO
                depths[other] = Penetration(max(known, -distance), permitted)
        return depths

    def _against(self, ends: list[list[int]], one: int, other: int) -> bool:
        """Returns whether two contacts push an object that can move from two sides.

        Args:
            ends: The MuJoCo bodies that are the roots of the two objects in each contact; -1 for soft objects.
            one: One of the contacts.
            other: The other one.
        """
        normals = self._physics.mj_data.contact.frame[[one, other], :3]  # from the first end to the second
        cosine = float(normals[0] @ normals[1])
        return any(
            root >= 0 and root == ends[other][end] and self._moves(root) and (cosine if side == end else -cosine) < AGAINST
            for side, root in enumerate(ends[one])
            for end in (0, 1)
        )

    def _moves(self, body: int) -> bool:
        return bool(self._physics.mj_model.body_treeid[body] >= 0)

    def _kind(self, geom: int) -> str:
        model = self._physics.mj_model
        if geom < 0:
            return "soft"
        if self._moves(model.geom_bodyid[geom]):
            return "moving"
        return "plane" if int(model.geom_type[geom]) == int(mujoco.mjtGeom.mjGEOM_PLANE) else "fixed"


class Pushes:
    """Forces by which a user pushes objects, each for a number of physics steps.

    Args:
        physics: The compiled scene and its state.
        objects: The objects that are pushed.
    """

    def __init__(self, physics: Physics, objects: Objects) -> None:
        self._physics = physics
        self._objects = objects
        self._pushes: tuple[tuple[int, float, float, int], ...] = ()
        """The MuJoCo body, the force along x and y [N], and the physics steps left."""
        self._before: NDArray[np.float64] = np.empty((0, 6))
        """The forces on these bodies without the pushes, while these act."""

    def __bool__(self) -> bool:
        return bool(self._pushes)

    def add(self, name: str, x: float, y: float, time: float) -> None:
        """Pushes an object with a force (x, y) [N] for a time [s], in whole physics steps.

        Raises:
            WorldError: If there is no such object, it cannot be pushed, or a value is wrong.
        """
        pushed = self._objects.pushed(name)
        x, y = (checked_number(force, f"push: {axis}", -MAX_FORCE, MAX_FORCE) for axis, force in (("x", x), ("y", y)))
        time = checked_number(time, "push: time", 1e-6, LONGEST)
        self.restore((*self._pushes, (pushed, x, y, max(1, round(time / self._physics.timestep)))))

    def begin(self, steps: int) -> None:
        """Applies the forces for the next physics steps; a push that lasts less acts with its mean force, so that its impulse is exact."""
        self._physics.pushes = ()
        self._before = self._physics.mj_data.xfrc_applied[self._pushed()].copy()
        for body, x, y, left in self._pushes:
            share = min(left, steps) / steps
            self._physics.mj_data.xfrc_applied[body, :2] += (share * x, share * y)
            self._objects.strike(body)

    def end(self, steps: int) -> None:
        """Removes the forces after these steps, but none that carries a held object; pushes that are over are forgotten."""
        pushed = self._pushed()
        self._physics.mj_data.xfrc_applied[pushed] = self._before
        for body in pushed:
            self._objects.strike(body)
        self.restore(tuple((body, x, y, left - steps) for body, x, y, left in self._pushes if left > steps))

    def _pushed(self) -> list[int]:
        return [body for body, *_ in self._pushes]

    def state(self) -> tuple[tuple[int, float, float, int], ...]:
        """Returns what is left of all pushes as plain values."""
        return self._pushes

    def restore(self, state: tuple[tuple[int, float, float, int], ...]) -> None:
        """Restores pushes that `state` returned."""
        self._pushes = state
        self._physics.pushes = tuple((body, x, y) for body, x, y, _ in state)


def checked_pose(what: str, x: float, y: float, heading: float | None) -> tuple[float, float, float | None]:
    """Returns a place (x, y) [m] and a heading [rad], if any, as numbers within bounds.

    Args:
        what: What puts something there, for the message.
        x: [m]
        y: [m]
        heading: [rad]

    Raises:
        WorldError: If a value is not a number, or out of bounds.
    """
    x, y = checked_number(x, f"{what}: x", -FARTHEST, FARTHEST), checked_number(y, f"{what}: y", -FARTHEST, FARTHEST)
    return x, y, None if heading is None else checked_angle(heading, f"{what}: heading")


def too_deep(before: Mapping[str, Penetration], after: Mapping[str, Penetration]) -> list[str]:
    """Returns the objects in which something is now too deep, given the depths in them before and after it was moved."""
    return [name for name, (depth, permitted) in after.items() if depth > max(permitted, before.get(name, NONE).depth)]
