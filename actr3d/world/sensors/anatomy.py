"""What a body consists of, as its agent knows it: parts, joints, limits and commands. It never changes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

from actr3d.world.anatomy import NamedMovement
from actr3d.world.body import Body, sensor
from actr3d.world.joints import Joint

HINGE_AXES = ("roll", "pitch", "yaw")
SLIDE_AXES = ("x", "y", "z")
"""Names of joint axes, by the nearest axis of the part."""


@dataclass(frozen=True, kw_only=True)
class JointPlan:
    """One degree of freedom."""

    name: str
    kind: Literal["hinge", "slide"]
    axis: str
    """The axis of a hinge, `yaw`, `pitch` or `roll`, or of a slide, `x`, `y` or `z`: the nearest axis of its part."""
    lower: float | None
    """Its least position [rad] or [m]; None without limit."""
    upper: float | None
    """Its greatest."""
    driven: bool
    """Whether a command can move it."""


@dataclass(frozen=True, kw_only=True)
class PartPlan:
    """One part, and the joints that attach it to another."""

    name: str
    on: str | None
    """The part that carries it; None for the base."""
    joints: tuple[JointPlan, ...]


@dataclass(frozen=True, kw_only=True)
class BodyPlan:
    """All parts of a body."""

    name: str
    parts: tuple[PartPlan, ...]
    """Each after the one that carries it; the base first."""
    movements: tuple[NamedMovement, ...]
    """Movements that have names."""
    actuators: tuple[str, ...]
    """The names of its commands."""
    fastest: tuple[float, float, float] | None
    """The greatest speeds that it can be commanded to walk [m/s], to turn [rad/s] and to turn a joint [rad/s]; None without limits."""


@sensor
def anatomy(body: Body) -> BodyPlan:
    """Senses what the body consists of: its parts, with joints and limits, and its named movements."""
    model = body.physics.mj_model
    names = dict(zip((int(number) for number in body.members.nonzero()[0]), body.parts, strict=True))
    joints: dict[int, list[JointPlan]] = {number: [] for number in names}
    for joint in body.joints.values():
        joints[int(model.jnt_bodyid[joint.number])].append(_plan(model, joint))
    parts = tuple(
        PartPlan(name=name, on=names.get(int(model.body_parentid[number])), joints=tuple(joints[number])) for number, name in names.items()
    )
    known = body.anatomy
    return BodyPlan(name=body.name, parts=parts, movements=known.movements, actuators=body.actuators, fastest=known.fastest)


def _plan(model: Any, joint: Joint) -> JointPlan:
    along = [abs(float(value)) for value in model.jnt_axis[joint.number]]
    axis = (HINGE_AXES if joint.turns else SLIDE_AXES)[along.index(max(along))]
    lower, upper = (None if math.isinf(limit) else limit for limit in joint.limits)
    return JointPlan(name=joint.name, kind="hinge" if joint.turns else "slide", axis=axis, lower=lower, upper=upper, driven=joint.driven)
