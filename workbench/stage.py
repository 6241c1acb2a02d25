"""What of a world is to be seen at first: the body that moves, where it faces, and what stands around it."""

from __future__ import annotations

import itertools
import math
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel, mjtGeom

NEAR = 12.0
"""What stands farther off than this is not of the stage [m]."""
LEAST = 0.8
"""So far around a body one sees at least [m]."""
ROOM = 1.06
"""So many times as far off the camera is as it need be."""
ASPECTS = (0.7, 2.5)
"""Windows that are narrower or wider are not reckoned with: width by height."""


class Stage:
    """Things that stand in a world, as a run begins; it goes along with the body once that leaves it.

    Args:
        model: The compiled scene.
    """

    def __init__(self, model: MjModel) -> None:
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
        self._low, self._high = self.corners.min(axis=0), self.corners.max(axis=0)
        away = ((self._low + self._high) / 2 - base)[:2]
        away = away if np.linalg.norm(away) > LEAST else data.xmat[self.body].reshape(3, 3)[:2, 0]
        size = np.linalg.norm(away)
        self.ahead = np.array((*(away / size), 0.0)) if size > 1e-6 else np.array((1.0, 0.0, 0.0))
        """Horizontally, from the body to the middle of what stands around it; where that is about the same place, where it faces."""

    def base(self, data: MjData) -> Any:
        """Returns where the first body that moves is."""
        return np.array(data.xpos[self.body])

    def seen_from(self, direction: Any, data: MjData, fov: float, aspect: float) -> tuple[Any, Any]:
        """Returns where a camera is to be, and what it is to look at, so that all of the stage is in its view.

        Args:
            direction: From the stage to the camera; not quite upright.
            data: The present state.
            fov: The camera's vertical field of view [rad].
            aspect: The width of its picture by its height.
        """
        base = self.base(data)
        off = base - np.clip(base, self._low, self._high)
        middle = (self._low + self._high) / 2
        back = direction / np.linalg.norm(direction)
        right = np.cross((0.0, 0.0, 1.0), back)
        right /= np.linalg.norm(right)
        upward = math.tan(fov / 2)
        sideward = upward * min(max(aspect, ASPECTS[0]), ASPECTS[1])
        corners = self.corners - middle
        # By height and by width: where the corners are, and how far off one of them is at the edge of the picture.
        places = [(axis, edge, corners @ axis) for axis, edge in ((np.cross(back, right), upward), (right, sideward))]
        near = corners @ back
        shift, distance = np.zeros(3), 0.0
        for axis, edge, place in places:
            # What is between two rays through the outermost corners is in the middle of the picture.
            above, below = (place + edge * near).max(), (place - edge * near).min()
            shift += axis * (above + below) / 2
            distance = max(distance, (above - below) / 2 / edge)
        look_at = middle + shift + off * (1, 1, 0)
        return look_at + back * ROOM * distance, look_at


def _boxes(model: MjModel, data: MjData) -> list[tuple[Any, Any]]:
    """Returns the lowest and the highest corner of each thing that is seen, but for endless ground."""
    shown = (model.geom_type != mjtGeom.mjGEOM_PLANE) & (model.geom_rgba[:, 3] > 0)
    found: list[tuple[Any, Any]] = []
    for number in np.flatnonzero(shown):
        turned = data.geom_xmat[number].reshape(3, 3)
        middle = data.geom_xpos[number] + turned @ model.geom_aabb[number, :3]
        half = np.abs(turned) @ model.geom_aabb[number, 3:]
        found.append((middle - half, middle + half))
    return found
