"""Frames by name: where an origin is, and how its axes point."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from mujoco import mjtObj
from numpy.typing import NDArray

from actr3d.errors import WorldError, did_you_mean

if TYPE_CHECKING:
    from actr3d.world.body import Body

Frame = tuple[NDArray[np.float64], NDArray[np.float64]]
"""The origin (3,) [m] and the axes as columns (3, 3), both in the world's frame."""

_WORLD: Frame = (np.zeros(3), np.eye(3))


def frame_of(body: Body, name: str) -> Frame:
    """Returns a frame at the positions that are up to date in the data.

    Args:
        body: Whose parts and sites are meant first.
        name: `"world"`, `"body"` (its base, along its heading, upright), a part or site of the body, any other site or body.

    Raises:
        WorldError: If nothing is called so.
    """
    if not isinstance(name, str):  # pyright: ignore[reportUnnecessaryIsInstance] # it may come from a mind
        raise WorldError(f"{body.name}: a frame is named by text (got {name!r})")
    data = body.world.mj_data
    if name == "world":
        return _WORLD
    if name == "body":
        heading = heading_of(data.xmat[body.root])
        c, s = math.cos(heading), math.sin(heading)
        return (data.xpos[body.root], np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]))
    if name == body.anatomy.base:
        return (data.xpos[body.root], data.xmat[body.root].reshape(3, 3))
    model: Any = body.world.mj_model
    for called in (body.anatomy.prefix + name, name):
        site = mujoco.mj_name2id(model, mjtObj.mjOBJ_SITE, called)
        if site >= 0:
            return (data.site_xpos[site], data.site_xmat[site].reshape(3, 3))
        number = mujoco.mj_name2id(model, mjtObj.mjOBJ_BODY, called)
        if number >= 0:
            return (data.xpos[number], data.xmat[number].reshape(3, 3))
    known = ["world", "body", *body.parts]
    raise WorldError(f"{body.name}: no frame, part or site '{name}'{did_you_mean(name, known)}; there are {', '.join(known)}")


def heading_of(matrix: NDArray[np.float64]) -> float:
    """Returns where the x axis of a rotation matrix (9,) points on the floor [rad], in -pi to pi."""
    return math.atan2(matrix[3], matrix[0])
