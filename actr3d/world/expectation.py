"""One quick look whether what the servos of a body drive is as it is told."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from mujoco import mjtState

from actr3d.world.driven import Driven, Row

if TYPE_CHECKING:
    from actr3d.world.world import World

CLOSE = 1e-6
"""How far all numbers together may be from what is expected [m] [rad] [m/s] [rad/s]: less than anything is done about. Ours."""

_PARTS = int(mjtState.mjSTATE_QPOS | mjtState.mjSTATE_QVEL | mjtState.mjSTATE_CTRL)


class Expectation:
    """The numbers that a body has while nothing is off: all places that are held, and all speeds and controls as told.

    Args:
        world: Where the body is.
        driven: What its servos drive.
        told: The speeds that it is told to keep.
        held: Where it is told to stand still; NaN while it is told to move.
    """

    def __init__(self, world: World, driven: Driven, told: Row, held: Row) -> None:
        model: Any = world.mj_model
        stands = np.isfinite(held)
        self._model, self._data = model, world.mj_data
        self._state: Row = np.zeros(mujoco.mj_stateSize(model, _PARTS))
        self._rows = np.concatenate([driven.q[stands], model.nq + driven.v, model.nq + model.nv + driven.c])
        self._numbers: list[float] = [*held[stands].tolist(), *told.tolist(), *told.tolist()]
        self._walks = bool(driven.base and told[:2].any())
        if self._walks:
            self._first = int(np.count_nonzero(stands))
            self._heading = int(driven.q[2])
            self._speed = math.hypot(*told[:2])
            self._direction = math.atan2(told[1], told[0]) + driven.faces
        self.fastest = driven.fastest(np.abs(told) + CLOSE)
        """A speed that no point of the body exceeds when this is met [m/s]; infinite where its servos do not drive all of it."""

    def met(self) -> bool:
        """Returns whether all is so near to what is expected that nothing can be off; False says nothing."""
        state, numbers = self._state, self._numbers
        mujoco.mj_getState(self._model, self._data, state, _PARTS)
        if self._walks:  # MuJoCo's speeds are along the world's axes
            direction = self._direction + state.item(self._heading)
            numbers[self._first] = self._speed * math.cos(direction)
            numbers[self._first + 1] = self._speed * math.sin(direction)
        return math.dist(state[self._rows].tolist(), numbers) < CLOSE
