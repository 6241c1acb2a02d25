"""A base that glides over the floor."""

from __future__ import annotations

import math
from typing import Any

from mujoco import MjSpec, mjtJoint

from actr3d.world.frames import yaw_quaternion


def add_planar_base(mj_spec: MjSpec, name: str, position: tuple[float, float], heading: float) -> Any:
    """Adds a MuJoCo body that slides along the world's x and y and turns about the vertical.

    Args:
        mj_spec: The specification it is added to.
        name: Its name; its joints are `<name>_x`, `<name>_y` and `<name>_heading`.
        position: Its position at the start, (x, y) [m].
        heading: Its heading at the start [rad].
    """
    body = mj_spec.worldbody.add_body(name=name, pos=[*position, 0], quat=yaw_quaternion(heading), gravcomp=1)
    # Axes are given in the body's frame, which is turned by the heading.
    c, s = math.cos(heading), math.sin(heading)
    body.add_joint(name=f"{name}_x", type=mjtJoint.mjJNT_SLIDE, axis=[c, -s, 0])
    body.add_joint(name=f"{name}_y", type=mjtJoint.mjJNT_SLIDE, axis=[s, c, 0])
    body.add_joint(name=f"{name}_heading", type=mjtJoint.mjJNT_HINGE, axis=[0, 0, 1])
    return body
