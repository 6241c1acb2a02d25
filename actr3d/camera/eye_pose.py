"""The pose of an eye in the world, for observers; agents never receive it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from mujoco import mj_name2id, mjtObj

from actr3d.world.frames import heading_of

if TYPE_CHECKING:
    from actr3d.world.body import Body


class Stand(NamedTuple):
    """The position of an eye and the heading of its body, in the world frame."""

    x: float
    """[m]"""
    y: float
    """[m]"""
    z: float
    """[m]"""
    heading: float
    """[rad]"""


def stand_of(body: Body, data: Any) -> Stand:
    """Returns the pose of a body's eye in simulation data whose geometry is up to date.

    Args:
        body: A body with an eye.
        data: The `mj_data` of the world, or a copy in another state.
    """
    site = mj_name2id(body.physics.mj_model, mjtObj.mjOBJ_SITE, body.eye or "")
    x, y, z = data.site_xpos[site].tolist()
    return Stand(x, y, z, heading_of(data.xmat[body.root]))
