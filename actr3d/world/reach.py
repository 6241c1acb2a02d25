"""Upper bounds, over all postures: distances of points of a body from the MuJoCo bodies that carry them, and their way per joint motion."""

from __future__ import annotations

from collections.abc import Iterator
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
    chains = (_carriers(model, geom) for geom in geoms.tolist())
    return max((_length(np.zeros(3), *link) for chain in chains for carrier, link in chain if carrier == root), default=0.0)


def reaches(model: Any, members: NDArray[np.bool_], geoms: NDArray[np.intp]) -> NDArray[np.float64]:
    """Returns by moving part and degree of freedom (n, nv) the way of the part's farthest point per unit of the joint [m].

    Args:
        model: The compiled scene.
        members: (nbody,) by MuJoCo body: whether it is part of the body.
        geoms: The geoms of the body that can touch something.
    """
    found = np.zeros((len(geoms), model.nv))
    for row, geom in enumerate(geoms.tolist()):
        for carrier, link in _carriers(model, geom):
            first, count = int(model.body_jntadr[carrier]), int(model.body_jntnum[carrier])
            for joint in range(first, first + count if members[carrier] else first):
                v, each = int(model.jnt_dofadr[joint]), _freedoms(int(model.jnt_type[joint]), _length(model.jnt_pos[joint], *link))
                found[row, v : v + len(each)] = each
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


def _length(at: NDArray[np.float64], far: float, place: NDArray[np.float64], slide: float) -> float:
    """Returns the greatest distance of a geom's points from a point on a MuJoCo body that carries it; see `_carriers` [m]."""
    return far + float(np.linalg.norm(place - at)) + slide


def _carriers(model: Any, geom: int) -> Iterator[tuple[int, tuple[float, NDArray[np.float64], float]]]:
    """Yields each MuJoCo body that carries a geom, from the nearest on, with what is attached to it in that direction: the greatest
    distance of the geom's points from there, the place on the body (3,), and the greatest way along slides [m]."""
    carrier, far = int(model.geom_bodyid[geom]), float(model.geom_rbound[geom])
    place, slide = model.geom_pos[geom], 0.0
    while carrier:
        yield carrier, (far, place, slide)
        far += float(np.linalg.norm(place)) + slide
        place, slide, carrier = model.body_pos[carrier], _slide(model, carrier), int(model.body_parentid[carrier])


def _slide(model: Any, body: int) -> float:
    """Returns the greatest way of a MuJoCo body along its slides that have limits [m]."""
    first = int(model.body_jntadr[body])
    slides = [n for n in range(first, first + int(model.body_jntnum[body])) if model.jnt_type[n] == int(mjtJoint.mjJNT_SLIDE)]
    return sum(float(np.abs(model.jnt_range[n]).max()) for n in slides if model.jnt_limited[n])
