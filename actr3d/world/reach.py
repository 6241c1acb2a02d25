"""How far points of a body can be from what carries them, and so how far they go when a joint moves; in any posture, at most."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from mujoco import mjtJoint
from numpy.typing import NDArray

if TYPE_CHECKING:
    from actr3d.world.body import Body


def radius(body: Body) -> float:
    """Returns how far the farthest point of a body's solid geoms is from its base [m]."""
    return max((_length(body, geom, body.root, np.zeros(3)) for geom in body.feeling.tolist()), default=0.0)


def reaches(body: Body) -> NDArray[np.float64]:
    """Returns for its moving parts and each degree of freedom how far the farthest point goes for one of the joint's [m]."""
    model = body.world.mj_model
    found = np.zeros((len(body.feeling), model.nv))
    joints = [joint for joint in range(model.njnt) if body.members[model.jnt_bodyid[joint]]]
    for row, geom in enumerate(body.feeling.tolist()):
        for joint in joints:
            if _carries(model, int(model.jnt_bodyid[joint]), int(model.geom_bodyid[geom])):
                far = _length(body, geom, int(model.jnt_bodyid[joint]), model.jnt_pos[joint])
                first, each = int(model.jnt_dofadr[joint]), _freedoms(int(model.jnt_type[joint]), far)
                found[row, first : first + len(each)] = each
    return np.unique(found, axis=0)


def _freedoms(kind: int, far: float) -> list[float]:
    """Returns for each degree of freedom of a joint how far a point goes for one of it that is so far away [m]."""
    match kind:
        case mjtJoint.mjJNT_FREE:
            return [1.0, 1.0, 1.0, far, far, far]
        case mjtJoint.mjJNT_BALL:
            return [far, far, far]
        case mjtJoint.mjJNT_SLIDE:
            return [1.0]
        case _:
            return [far]


def _length(body: Body, geom: int, start: int, at: NDArray[np.float64]) -> float:
    """Returns how far a geom's farthest point is from a point on a MuJoCo body that carries it [m]."""
    model = body.world.mj_model
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
    """Returns how far the slides of a MuJoCo body can take it from its place, where they have limits [m]."""
    first = int(model.body_jntadr[body])
    slides = [n for n in range(first, first + int(model.body_jntnum[body])) if model.jnt_type[n] == int(mjtJoint.mjJNT_SLIDE)]
    return sum(float(np.abs(model.jnt_range[n]).max()) for n in slides if model.jnt_limited[n])


def _carries(model: Any, carrier: int, body: int) -> bool:
    while body > carrier:
        body = int(model.body_parentid[body])
    return body == carrier
