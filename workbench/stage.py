"""What of a world is seen at first: the body that moves, where it faces, and what stands around it."""

from __future__ import annotations

import itertools
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel, mjtGeom

NEAR = 12.0
"""What is farther from the body than this is no part of the stage [m]."""
LEAST = 0.8
"""The stage reaches at least so far around the body [m]."""
SMALLEST = 0.3
"""Bodies that are lower are shown as if they were so high [m]."""
MOST_CORNERS = 400
"""Of a stage with more corners, browsers are told those of the box around it."""


class Stage:
    """The body and the things around it, as a run begins.

    Args:
        model: The compiled scene.
    """

    def __init__(self, model: MjModel) -> None:
        from mjviser.conversions import get_body_name

        moving = np.flatnonzero(model.body_dofnum > 0)
        self.body = int(moving[0]) if moving.size else 0
        """The first body that moves, by its number."""
        data = MjData(model)
        mujoco.mj_kinematics(model, data)
        base = self.base(data)
        around = np.array((LEAST, LEAST, 0.0))
        boxes = [(base - around, base + around)]
        for low, high in _boxes(model, data):
            if np.linalg.norm((np.clip(base, low, high) - base)[:2]) <= NEAR:
                boxes.append((np.maximum(low, base - NEAR), np.minimum(high, base + NEAR)))
        self.corners = np.array([corner for low, high in boxes for corner in itertools.product(*zip(low, high, strict=True))])
        """Those of the boxes around all that stands there `(n, 3)` [m]."""
        self.low, self.high = self.corners.min(axis=0), self.corners.max(axis=0)
        self.ground = _ground(model)
        """How high the ground lies [m]."""
        own = [box for box, body in zip(_boxes(model, data), _bodies(model), strict=True) if self._of_body(model, body)]
        self.own = [get_body_name(model, body) for body in range(1, model.nbody) if self._of_body(model, body)]
        """The names of the body and its parts in viser's tree."""
        least = np.array((0.0, 0.0, SMALLEST / 2))
        below = np.min([low for low, _ in own] or [base - least], axis=0)
        above = np.max([high for _, high in own] or [base + least], axis=0)
        self.middle = (below + above) / 2 - base
        """From where the body is to its middle, as the run begins [m]."""
        self.height = float(max(SMALLEST, *(above - below)))
        """How large the body is as the run begins [m]."""
        self.start = base
        """Where the body is as the run begins."""
        away = ((self.low + self.high) / 2 - base)[:2]
        away = away if np.linalg.norm(away) > LEAST else data.xmat[self.body].reshape(3, 3)[:2, 0]
        size = np.linalg.norm(away)
        self.ahead = np.array((*(away / size), 0.0)) if size > 1e-6 else np.array((1.0, 0.0, 0.0))
        """Horizontally, from the body to the middle of what stands around it; where that is about the same place, where it faces."""

    def base(self, data: MjData) -> Any:
        """Returns where the body is."""
        return np.array(data.xpos[self.body])

    def told(self, grounds: list[str]) -> dict[str, Any]:
        """Returns what browsers need to place their cameras.

        Args:
            grounds: The names of the level planes in viser's tree.
        """
        around = itertools.product(*zip(self.low, self.high, strict=True))
        corners = self.corners if len(self.corners) <= MOST_CORNERS else np.array(list(around))
        numbers = {
            "corners": corners,
            "low": self.low,
            "high": self.high,
            "ahead": self.ahead,
            "start": self.start,
            "middle": self.middle,
        }
        told: dict[str, Any] = {name: value.round(4).tolist() for name, value in numbers.items()}
        return {**told, "height": self.height, "ground": self.ground, "grounds": grounds, "own": self.own}

    def _of_body(self, model: MjModel, body: int) -> bool:
        """Returns whether a MuJoCo body is the body of the stage or a part of it; where none moves, all are."""
        return self.body == 0 or bool(model.body_rootid[body] == model.body_rootid[self.body])


def _ground(model: MjModel) -> float:
    """Returns how high the highest level plane of the world lies [m]; 0 where there is none."""
    heights = model.geom_pos[(model.geom_type == mjtGeom.mjGEOM_PLANE) & (model.geom_bodyid == 0), 2]
    return float(heights.max()) if heights.size else 0.0


def _seen(model: MjModel) -> Any:
    """Returns the numbers of the geoms that are seen, except endless ground."""
    return np.flatnonzero((model.geom_type != mjtGeom.mjGEOM_PLANE) & (model.geom_rgba[:, 3] > 0))


def _bodies(model: MjModel) -> list[int]:
    """Returns the MuJoCo bodies of the geoms that are seen."""
    return model.geom_bodyid[_seen(model)].tolist()


def _boxes(model: MjModel, data: MjData) -> list[tuple[Any, Any]]:
    """Returns the lowest and the highest corner of each geom that is seen."""
    found: list[tuple[Any, Any]] = []
    for number in _seen(model):
        turned = data.geom_xmat[number].reshape(3, 3)
        middle = data.geom_xpos[number] + turned @ model.geom_aabb[number, :3]
        half = np.abs(turned) @ model.geom_aabb[number, 3:]
        found.append((middle - half, middle + half))
    return found
