"""Determines what the 3D view shows first: the body of the agent, its heading, and the objects around it."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel, mjtGeom

NEAR = 12.0
"""Objects farther from the body than this are not part of the stage [m]."""
MIN_EXTENT = 0.8
"""Minimum extent of the stage around the body [m]."""
SMALLEST = 0.3
"""Bodies smaller than this are framed as if they had this size [m]."""
MAX_CORNERS = 400
"""Above this number of corners, browsers get only the corners of the bounding box."""


class SceneFraming:
    """Holds the body and the objects around it at the start of a run.

    Args:
        model: The compiled scene.
        agents: The numbers of the MuJoCo bodies of agents.
    """

    def __init__(self, model: MjModel, agents: Iterable[int] = ()) -> None:
        from mjviser.conversions import get_body_name

        self.body = int(next(iter((*agents, *np.flatnonzero(model.body_dofnum > 0))), 0))
        """The number of the first body of an agent; if there is none, of the first body that moves."""
        data = MjData(model)
        mujoco.mj_kinematics(model, data)
        base = self.base(data)
        around = np.array((MIN_EXTENT, MIN_EXTENT, 0.0))
        seen = _boxes(model, data)
        boxes = [(base - around, base + around)]
        for _, low, high in seen:
            if np.linalg.norm((np.clip(base, low, high) - base)[:2]) <= NEAR:
                boxes.append((np.maximum(low, base - NEAR), np.minimum(high, base + NEAR)))
        self.corners = np.array([corner for low, high in boxes for corner in itertools.product(*zip(low, high, strict=True))])
        """The corners of the bounding boxes of all objects on the stage `(n, 3)` [m]."""
        self.low, self.high = self.corners.min(axis=0), self.corners.max(axis=0)
        self.ground = max(grounds_of(model), default=0.0)
        """The height of the highest plane of the world [m]; 0 if there is none."""
        own = [(low, high) for body, low, high in seen if self._of_body(model, body)]
        self.own = [get_body_name(model, body) for body in range(1, model.nbody) if self._of_body(model, body)]
        """The names of the body and its parts in viser's tree."""
        least = np.array((0.0, 0.0, SMALLEST / 2))
        below = np.min([low for low, _ in own] or [base - least], axis=0)
        above = np.max([high for _, high in own] or [base + least], axis=0)
        self.middle = (below + above) / 2 - base
        """The offset from the body's origin to its middle at the start of the run [m]."""
        self.height = float(max(SMALLEST, *(above - below)))
        """The size of the body at the start of the run [m]."""
        self.start = base
        """The position of the body at the start of the run."""
        away = ((self.low + self.high) / 2 - base)[:2]
        away = away if np.linalg.norm(away) > MIN_EXTENT else data.xmat[self.body].reshape(3, 3)[:2, 0]
        size = np.linalg.norm(away)
        self.ahead = np.array((*(away / size), 0.0)) if size > 1e-6 else np.array((1.0, 0.0, 0.0))
        """Horizontal unit vector from the body to the middle of the objects around it; if that is at the body, the body's heading."""

    def base(self, data: MjData) -> Any:
        """Returns the position of the body."""
        return np.array(data.xpos[self.body])

    def corners_within(self, most: int) -> Any:
        """Returns the corners of all objects on the stage, or those of their common bounding box if there are more than this number."""
        around = itertools.product(*zip(self.low, self.high, strict=True))
        return self.corners if len(self.corners) <= most else np.array(list(around))

    def data(self, grounds: list[str]) -> dict[str, Any]:
        """Returns the data with which browsers place their cameras.

        Args:
            grounds: The names of the ground planes in viser's tree.
        """
        numbers = {
            "corners": self.corners_within(MAX_CORNERS),
            "low": self.low,
            "high": self.high,
            "ahead": self.ahead,
            "start": self.start,
            "middle": self.middle,
        }
        rounded: dict[str, Any] = {name: value.round(4).tolist() for name, value in numbers.items()}
        return {**rounded, "height": self.height, "ground": self.ground, "grounds": grounds, "own": self.own}

    def _of_body(self, model: MjModel, body: int) -> bool:
        """Returns whether a MuJoCo body belongs to the body of the stage; if no body moves, all do."""
        return self.body == 0 or bool(model.body_rootid[body] == model.body_rootid[self.body])


def grounds_of(model: MjModel) -> list[float]:
    """Returns the heights of the planes of the world [m]."""
    return sorted(set(model.geom_pos[(model.geom_type == mjtGeom.mjGEOM_PLANE) & (model.geom_bodyid == 0), 2].tolist()))


def _boxes(model: MjModel, data: MjData) -> list[tuple[int, Any, Any]]:
    """Returns the MuJoCo body of each visible geom except planes, and the lowest and the highest corner of the geom's bounding box."""
    found: list[tuple[int, Any, Any]] = []
    for number in np.flatnonzero((model.geom_type != mjtGeom.mjGEOM_PLANE) & (model.geom_rgba[:, 3] > 0)):
        turned = data.geom_xmat[number].reshape(3, 3)
        middle = data.geom_xpos[number] + turned @ model.geom_aabb[number, :3]
        half = np.abs(turned) @ model.geom_aabb[number, 3:]
        found.append((int(model.geom_bodyid[number]), middle - half, middle + half))
    return found
