"""A body's sense of its own posture and movement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from actr3d.errors import WorldError
from actr3d.values import NOT_TRACED
from actr3d.world.body import Body, sensor
from actr3d.world.command_registry import checked_number
from actr3d.world.joints import AT_LIMIT, Joint


@dataclass(frozen=True, kw_only=True)
class Size:
    """Size of the smallest box around a body and what it holds."""

    width: float
    """To the left and right, along the frame's y [m]."""
    depth: float
    """Front to back, along its x [m]."""
    height: float
    """Along its z [m]."""


@dataclass(frozen=True, kw_only=True)
class Proprioception:
    """Posture and movement of a body, in as few numbers as a motor module needs each tick."""

    positions: tuple[float, ...] = field(metadata=NOT_TRACED)
    """Of all joints, in the order of the sensor `anatomy` [rad] or [m]. A recording has them in the physics state of the same tick."""
    moving: tuple[str, ...]
    """The joints whose commanded speed is not 0, whether they really move or not."""
    speed: tuple[float, float, float]
    """Of the base, forward and to the left [m/s], and turning to the left [rad/s]; 0 for one that cannot walk."""
    walking: bool
    """Whether it is commanded to walk or turn."""
    turning: float
    """Rest of a commanded turn by an angle [rad]."""
    width: float
    """To the left and right [m], of the smallest box around the body, upright and along its heading."""
    depth: float
    """Of that box, front to back [m]."""
    height: float
    """Of that box [m]."""
    middle: float
    """Lateral position of the middle of that box relative to the base [m, left is positive], such as that of a turned body that holds a
    bar."""

    def with_noise(self, sd: Any, random: Any) -> Proprioception:
        """Always raises an error: a motor module needs exact numbers to detect the end of movements, and has its own parameters for noise.

        Raises:
            WorldError: Always.
        """
        raise WorldError("proprioception: takes no noise; give it to the motor module instead (angle_noise, size_noise)")


@sensor
def bounding_box(body: Body, frame: str = "body") -> Size:
    """Senses width, depth and height of the body with what it holds, upright and along its heading, or in the frame of a part."""
    depth, width, height = body.bounding_box(frame).size
    return Size(width=width, depth=depth, height=height)


@dataclass(frozen=True, kw_only=True)
class SizeInPosture(Size):
    """Size of the body in a posture."""

    middle: float
    """As in `Proprioception` [m]."""


@sensor
def size_in(body: Body, positions: Mapping[str, float] | None = None) -> SizeInPosture:
    """Computes how large the body would be in another posture, standing, with the `Load` that it carries.

    Args:
        body: The body.
        positions: By joint, its position there [rad] or [m]; the other joints are as they are now; None for all of them.

    Raises:
        WorldError: If there is no such joint, a position is not a number or beyond a limit, or a hand has grasped an object.
    """
    given: Mapping[str, float] = {} if positions is None else positions
    if not isinstance(given, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance] # an agent's code may give anything
        raise WorldError(f"size_in: positions: must be positions by joint (got {positions!r})")
    there = {joint: checked_number(at, f"size_in: {joint}", *_within(body.joint(joint))) for joint, at in given.items()}
    box = body.bounding_box("body", there)
    depth, width, height = box.size
    return SizeInPosture(width=width, depth=depth, height=height, middle=box.centre[1])


def _within(joint: Joint) -> tuple[float, float]:
    """Returns the least and the greatest position that a joint can have [rad] or [m]."""
    return joint.lower - AT_LIMIT, joint.upper + AT_LIMIT


@sensor
def proprioception(body: Body) -> Proprioception:
    """Senses together the positions of all joints, what still moves, and width, depth and height of the body in this posture."""
    walks = body.anatomy.walking_servos is not None
    box = body.bounding_box("body")
    depth, width, height = box.size
    return Proprioception(
        positions=body.positions(),
        moving=body.moving(),
        speed=body.base.speed if walks else (0.0, 0.0, 0.0),
        walking=walks and body.hold.base_command != (0.0, 0.0, 0.0),
        turning=body.motion.turning() if walks else 0.0,
        width=width,
        depth=depth,
        height=height,
        middle=box.centre[1],
    )
