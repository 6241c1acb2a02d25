"""Upper bounds, over all postures: distances of points of a body from the MuJoCo bodies that carry them, and their way per joint motion."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from mujoco import mjtJoint
from numpy.typing import NDArray

FREE, BALL, SLIDE = (int(kind) for kind in (mjtJoint.mjJNT_FREE, mjtJoint.mjJNT_BALL, mjtJoint.mjJNT_SLIDE))
READ = [
    "geom_bodyid",
    "geom_pos",
    "geom_rbound",
    "body_pos",
    "body_parentid",
    "body_jntadr",
    "body_jntnum",
    "jnt_type",
    "jnt_pos",
    "jnt_dofadr",
    "jnt_limited",
    "jnt_range",
]
"""What is read of the compiled scene."""


def radius(model: Any, root: int, geoms: NDArray[np.intp]) -> float:
    """Returns the greatest distance of any point of a body's geoms from its root [m].

    Args:
        model: The compiled scene.
        root: The MuJoCo body that carries all others of the body.
        geoms: The geoms of the body that can touch something.
    """
    model = _listed(model)
    chains = (_carriers(model, geom) for geom in geoms.tolist())
    return max((_length((0.0, 0.0, 0.0), *link) for chain in chains for carrier, link in chain if carrier == root), default=0.0)


def reaches(model: Any, members: NDArray[np.bool_], geoms: NDArray[np.intp]) -> NDArray[np.float64]:
    """Returns by moving part and degree of freedom (n, nv) the way of the part's farthest point per unit of the joint [m].

    Args:
        model: The compiled scene.
        members: (nbody,) by MuJoCo body: whether it is part of the body.
        geoms: The geoms of the body that can touch something.
    """
    found, own = np.zeros((len(geoms), model.nv)), members.tolist()
    model = _listed(model)
    for row, geom in enumerate(geoms.tolist()):
        for carrier, link in _carriers(model, geom):
            first, count = model.body_jntadr[carrier], model.body_jntnum[carrier]
            for joint in range(first, first + count if own[carrier] else first):
                v, each = model.jnt_dofadr[joint], _freedoms(model.jnt_type[joint], _length(model.jnt_pos[joint], *link))
                found[row, v : v + len(each)] = each
    return np.unique(found, axis=0)


def _freedoms(kind: int, far: float) -> list[float]:
    """Returns for each degree of freedom of a joint the way of a point at distance `far` per unit of it [m]."""
    if kind == FREE:
        return [1.0, 1.0, 1.0, far, far, far]
    if kind == BALL:
        return [far, far, far]
    return [1.0] if kind == SLIDE else [far]


def _length(at: Sequence[float], far: float, place: Sequence[float], slide: float) -> float:
    """Returns the greatest distance of a geom's points from a point on a MuJoCo body that carries it; see `_carriers` [m]."""
    return far + math.dist(place, at) + slide


def _carriers(model: Any, geom: int) -> Iterator[tuple[int, tuple[float, Sequence[float], float]]]:
    """Yields each MuJoCo body that carries a geom, from the nearest on, with what is attached to it in that direction: the greatest
    distance of the geom's points from there, the place on the body, and the greatest way along slides [m]."""
    carrier, far, place, slide = model.geom_bodyid[geom], model.geom_rbound[geom], model.geom_pos[geom], 0.0
    while carrier:
        yield carrier, (far, place, slide)
        far += math.hypot(*place) + slide
        place, slide, carrier = model.body_pos[carrier], model.slides[carrier], model.body_parentid[carrier]


def _slide(model: Any, body: int) -> float:
    """Returns the greatest way of a MuJoCo body along its slides that have limits [m]."""
    first = model.body_jntadr[body]
    slides = [n for n in range(first, first + model.body_jntnum[body]) if model.jnt_type[n] == SLIDE and model.jnt_limited[n]]
    return sum(max(map(abs, model.jnt_range[n])) for n in slides)


def _listed(model: Any) -> Any:
    """Returns what is read of the compiled scene, as lists: single values of MuJoCo's arrays take ten times as long to read."""
    listed = SimpleNamespace(**{name: getattr(model, name).tolist() for name in READ})
    listed.slides = [_slide(listed, body) for body in range(model.nbody)]
    return listed
