"""An agent's knowledge of its body: parts, joints, positions and extremes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from math import radians

from actr3d.errors import WorldError
from actr3d.world.anatomy import NamedMovement
from actr3d.world.command_registry import checked_name
from actr3d.world.sensors.anatomy import BodyPlan, JointPlan

BASE_GROUP = "legs"
"""The muscle group that walks and turns the whole body, whatever the name of its base."""


@dataclass(frozen=True, kw_only=True)
class DegreeOfFreedom:
    """The present knowledge of one degree of freedom. Radians, or metres for a slide."""

    name: str
    """The name of the joint, such as `torso_yaw`."""
    axis: str
    """`yaw`, `pitch` or `roll` of a hinge, `x`, `y` or `z` of a slide."""
    lower: float | None
    """Lower limit [rad] or [m]; None without limit."""
    upper: float | None
    """Upper limit [rad] or [m]; None without limit."""
    angle: float
    """Felt position [rad] or [m]."""
    minimum: float
    """Minimum of the felt positions up to now [rad] or [m]."""
    maximum: float
    """Maximum of the felt positions up to now [rad] or [m]."""
    driven: bool
    """Whether a command can move it."""


@dataclass(frozen=True, kw_only=True)
class BodyPart:
    """A part of the body, with the joints that attach it to another, and the parts that it carries."""

    name: str
    """The name of the part: `torso`."""
    joints: tuple[DegreeOfFreedom, ...]
    """The joints between it and the part that carries it."""
    parts: tuple[BodyPart, ...]
    """The parts that it carries."""

    def part(self, name: str) -> BodyPart:
        """Returns this part, or one that it carries, by name.

        Raises:
            WorldError: If there is none of that name.
        """
        all_parts = {part.name: part for part in self.subtree()}
        return all_parts[checked_name(name, all_parts, self.name, "part")]

    def subtree(self) -> tuple[BodyPart, ...]:
        """Returns this part and all that it carries, each after the one that carries it."""
        return (self, *(inner for part in self.parts for inner in part.subtree()))


class Limbs:
    """A motor module's knowledge of its body that follows from the plan of the body.

    Args:
        plan: The description of the body.
    """

    def __init__(self, plan: BodyPlan) -> None:
        self.plan = plan
        self.joints: dict[str, JointPlan] = {joint.name: joint for part in plan.parts for joint in part.joints}
        self.order = tuple(self.joints)
        """The joints in the order of readings."""
        self.shown_as = {name: f"{name}_{'angle' if joint.kind == 'hinge' else 'position'}" for name, joint in self.joints.items()}
        """By joint, the motor module's attribute with its felt position."""
        self.unit = {name: radians(1) if joint.kind == "hinge" else 1.0 for name, joint in self.joints.items()}
        """By joint, the unit of its position in commands: a degree in radians, or a metre."""
        self.group_of: dict[str, str] = {joint.name: part.name for part in plan.parts for joint in part.joints}
        """By joint, its muscle group: that of its part."""
        moved = {part.name: None for part in plan.parts if any(joint.driven for joint in part.joints)}
        self.groups: tuple[str, ...] = tuple(dict.fromkeys([*([BASE_GROUP] if "walk" in plan.actuators else []), *moved]))
        """All muscle groups."""
        self.fastest = plan.fastest or (math.inf, math.inf, math.inf)
        """Greatest speeds of walking [m/s], turning [rad/s] and joints [rad/s]."""

    def joint(self, name: str, axis: str | None) -> str:
        """Returns the name of a joint, given its name or the name of its part. A part with several joints also needs the axis.

        Raises:
            WorldError: If there is none, or there are several.
        """
        whose = self.plan.name
        if not isinstance(name, str):  # pyright: ignore[reportUnnecessaryIsInstance] # an agent's code may give anything
            checked_name(name, self.joints, whose, "joint" if axis is None else "jointed part")
        of = [joint for joint, part in self.group_of.items() if part == name]
        if axis is None:
            if name in self.joints:
                return name
            if len(of) == 1:
                return of[0]
            if not of:
                checked_name(name, self.joints, whose, "joint")
            axes = ", ".join(dict.fromkeys(self.joints[joint].axis for joint in of))
            raise WorldError(f"{whose}: '{name}' has several joints; give the axis: {axes}")
        by_axis: dict[str, list[str]] = {}
        for joint in of:
            by_axis.setdefault(self.joints[joint].axis, []).append(joint)
        if not of and name in self.joints:
            raise WorldError(f"{whose}: '{name}' is a joint, and only a part takes an axis (got {axis!r}); give an angle by name: angle=20")
        if not of:
            checked_name(name, dict.fromkeys(self.group_of.values()), whose, "jointed part")
        first, *others = by_axis[checked_name(axis, by_axis, f"{whose}: {name}", "axis")]
        if others:
            raise WorldError(f"{whose}: '{name}' has several joints about {axis}; name one of them: {', '.join([first, *others])}")
        return first

    def movement(self, name: str, side: str | None) -> NamedMovement:
        """Returns a named movement of the body.

        Raises:
            WorldError: If there is none of that name, or none on that side.
        """
        checked_name(name, dict.fromkeys(movement.name for movement in self.plan.movements), self.plan.name, "movement")
        sides = {movement.side: movement for movement in self.plan.movements if movement.name == name}
        if side is None and None in sides:
            return sides[None]
        return sides[checked_name(side, [str(of) for of in sides if of is not None], f"{self.plan.name}: {name}", "side")]

    def check_speed(self, call: str, speed: float, kind: int, unit: float) -> None:
        """Checks that the body can reach a speed.

        Args:
            call: The command, for the message.
            speed: The speed [m/s] or [rad/s].
            kind: The index in `fastest`.
            unit: The unit of speeds in the command.

        Raises:
            WorldError: If the speed is above the body's maximum, or below `SLOWEST` but not 0. The message contains the bound.
        """
        most = self.fastest[kind]
        if 0 < abs(speed) < SLOWEST:
            raise WorldError(f"{call}: speed: must be >= {SLOWEST / unit:.2g} for {self.plan.name}, or 0 (got {speed / unit:g})")
        if abs(speed) > most + TINY:
            raise WorldError(f"{call}: speed: must be <= {most / unit:g} for {self.plan.name} (got {speed / unit:g})")

    def inside(self, joint: str, position: float) -> bool:
        """Returns whether a position [rad] or [m] is within a joint's limits."""
        plan = self.joints[joint]
        return (plan.lower is None or position >= plan.lower - TINY) and (plan.upper is None or position <= plan.upper + TINY)

    def limit(self, joint: str, way: float) -> float | None:
        """Returns the limit of a joint [rad] or [m] in the direction of a speed; None without limit."""
        plan = self.joints[joint]
        return plan.upper if way > 0 else plan.lower


SLOWEST = 1e-6
"""Least speed of a movement [m/s] or [rad/s]: the least that the commands of bodies accept."""

FINEST = 1e-9
"""The finest grid [degrees] or [m]."""

TINY = 1e-9
"""Tolerance for rounding errors of conversions, in the unit of the compared values."""


def on_grid(value: float, grid: float) -> float:
    """Returns the multiple of `grid` that is nearest to a value; as an int if it is one."""
    return _multiple(round(value / grid), grid)


@lru_cache(maxsize=4096)  # a moving body is felt at the same few angles and sizes again and again
def _multiple(number: int, grid: float) -> float:
    near = number * grid
    if near != int(near):
        near = round(near, 9)
    return int(near) if near == int(near) else near
