"""Upper bounds, over all postures: distances of points of a body from the MuJoCo bodies that carry them, and their way per joint motion."""

from __future__ import annotations

from typing import Any

import numpy as np
from mujoco import mjtJoint
from numpy.typing import NDArray


def radius(model: Any, root: int, geoms: NDArray[np.intp]) -> float:
    """Returns the greatest distance of any point of a body's geoms from its root [m].

    Args:
        model: The compiled scene.
        root: The MuJoCo body that carries all others of the body.
        geoms: The geoms of the body that can touch something.
    """
    return max((_length(model, geom, root, np.zeros(3)) for geom in geoms.tolist()), default=0.0)


def reaches(model: Any, members: NDArray[np.bool_], geoms: NDArray[np.intp]) -> NDArray[np.float64]:
    """Returns by moving part and degree of freedom (n, nv) the way of the part's farthest point per unit of the joint [m].

    Args:
        model: The compiled scene.
        members: (nbody,) by MuJoCo body: whether it is part of the body.
        geoms: The geoms of the body that can touch something.
    """
    found = np.zeros((len(geoms), model.nv))
    joints = [joint for joint in range(model.njnt) if members[model.jnt_bodyid[joint]]]
    for row, geom in enumerate(geoms.tolist()):
        for joint in joints:
            if _carries(model, int(model.jnt_bodyid[joint]), int(model.geom_bodyid[geom])):
                far = _length(model, geom, int(model.jnt_bodyid[joint]), model.jnt_pos[joint])
                first, each = int(model.jnt_dofadr[joint]), _freedoms(int(model.jnt_type[joint]), far)
                found[row, first : first + len(each)] = each
    return np.unique(found, axis=0)


def _freedoms(kind: int, far: float) -> list[float]:
    """Returns for each degree of freedom of a joint the way of a point at distance `far` per unit of it [m]."""
    match kind:
        case mjtJoint.mjJNT_FREE:
            return [1.0, 1.0, 1.0, far, far, far]
        case mjtJoint.mjJNT_BALL:
            return [far, far, far]
        case mjtJoint.mjJNT_SLIDE:
            return [1.0]
        case _:
            return [far]


def _length(model: Any, geom: int, start: int, at: NDArray[np.float64]) -> float:
    """Returns the greatest distance of a geom's points from a point on a MuJoCo body that carries it [m]."""
    carrier = int(model.geom_bodyid[geom])
    far = float(model.geom_rbound[geom])
    if carrier == start:
        return far + float(np.linalg.norm(model.geom_pos[geom] - at))
    far += float(np.linalg.norm(model.geom_pos[geom]))
    while int(model.body_parentid[carrier]) != start:
        far += float(np.linalg.norm(model.body_pos[carrier])) + _slide(model, carrier)
        carrier = int(model.body_parentid[carrier])
    return far + float(np.linalg.norm(model.body_pos[carrier] - at)) + _slide(model, carrier)


def _slide(model: Any, body: int) -> float:
    """Returns the greatest way of a MuJoCo body along its slides that have limits [m]."""
    first = int(model.body_jntadr[body])
    slides = [n for n in range(first, first + int(model.body_jntnum[body])) if model.jnt_type[n] == int(mjtJoint.mjJNT_SLIDE)]
    return sum(float(np.abs(model.jnt_range[n]).max()) for n in slides if model.jnt_limited[n])


def _carries(model: Any, carrier: int, body: int) -> bool:
    while body > carrier:
        body = int(model.body_parentid[body])
    return body == carrier
