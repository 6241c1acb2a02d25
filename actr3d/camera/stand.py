"""Where an eye stands in the world: for who looks on; no mind gets this."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from mujoco import mj_name2id, mjtObj

from actr3d.world.frames import heading_of

if TYPE_CHECKING:
    from actr3d.world.body import Body


class Stand(NamedTuple):
    """Where an eye is, and where ahead is for its body, in the world's frame."""

    x: float
    """[m]"""
    y: float
    """[m]"""
    z: float
    """[m]"""
    heading: float
    """[rad]"""


def stand_of(body: Body, data: Any) -> Stand:
    """Returns how the eye of a body stands in data of its world, whose geometry is up to date.

    Args:
        body: Whose eye; it has one.
        data: The `mj_data` of the world, or a copy in another state.
    """
    site = mj_name2id(body.physics.mj_model, mjtObj.mjOBJ_SITE, body.eye or "")
    x, y, z = data.site_xpos[site].tolist()
    return Stand(x, y, z, heading_of(data.xmat[body.root]))
