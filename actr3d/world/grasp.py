"""Hands that hold objects: a weld between hand and object, made and released during a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from actr3d.world.physics import Physics

REACH = 0.05
"""Greatest distance between a hand and an object that it can hold [m]. Source: chosen, the length of a finger's grip."""


@dataclass(frozen=True, kw_only=True)
class Held:
    """An object in a hand, and its pose there."""

    object: int
    """The MuJoCo body of the object."""

    pose: tuple[float, ...]
    """Pose of the object in the frame of the hand's segment: position (3,) [m] and quaternion (4,)."""


class Hand:
    """One hand: a weld equality of the compiled model, which is inactive while the hand is empty.

    Whether the weld is active is part of the physics state; the two objects that it joins are part of the compiled model. See
    `World.state` for both.

    Args:
        physics: The compiled scene and its state.
        name: Of the weld, and of the hand's geom.
    """

    def __init__(self, physics: Physics, name: str) -> None:
        self._physics = physics
        self._weld = int(physics.mj_model.equality(name).id)
        self._geom = int(physics.mj_model.geom(name).id)
        self._segment = int(physics.mj_model.eq_obj1id[self._weld])
        self.held: Held | None = None
        self.geoms: tuple[int, ...] = ()
        """The geoms of the held object."""

    def reaches(self, object: int) -> bool:
        """Returns whether a MuJoCo body is near enough to be held; positions must be up to date."""
        model, data = self._physics.mj_model, self._physics.mj_data
        geoms = _geoms_of(model, object)
        return any(mujoco.mj_geomDistance(model, data, self._geom, geom, 2 * REACH, None) <= REACH for geom in geoms)

    def grasp(self, object: int) -> None:
        """Welds a MuJoCo body to the hand in its present pose, and carries its weight; positions must be up to date."""
        data = self._physics.mj_data
        turn = data.xmat[self._segment].reshape(3, 3)
        position = (data.xpos[object] - data.xpos[self._segment]) @ turn
        back, quaternion = np.zeros(4), np.zeros(4)
        mujoco.mju_negQuat(back, data.xquat[self._segment])
        mujoco.mju_mulQuat(quaternion, back, data.xquat[object])
        held = Held(object=object, pose=(*position.tolist(), *quaternion.tolist()))
        self.restore(held)
        model: Any = self._physics.mj_model
        model.eq_obj2id[self._weld] = object
        model.eq_data[self._weld, :3] = 0
        model.eq_data[self._weld, 3:10] = held.pose
        data.eq_active[self._weld] = 1
        own = _bodies_of(model, object)
        weights = model.body_mass[own] * (1 - model.body_gravcomp[own])
        data.xfrc_applied[own, :3] = -model.opt.gravity * weights[:, None]

    def release(self) -> None:
        """Releases the held object, if any; another hand that holds it too still carries it."""
        held = self.held
        self._physics.mj_data.eq_active[self._weld] = 0
        self.restore(None)
        if held is not None and held.object not in self._physics.grasped.values():
            self._physics.mj_data.xfrc_applied[_bodies_of(self._physics.mj_model, held.object), :3] = 0

    def restore(self, held: Held | None) -> None:
        """Notes the held object; the weld itself is part of the world's state."""
        self.held = held
        self.geoms = () if held is None else _geoms_of(self._physics.mj_model, held.object)
        if held is None:
            self._physics.grasped.pop(self._weld, None)
        else:
            self._physics.grasped[self._weld] = held.object

    def carry(self) -> None:
        """Puts the held object back in the hand, at rest, after the body was moved without physics; positions must be up to date."""
        if self.held is None:
            return
        data = self._physics.mj_data
        position, quaternion = np.array(self.held.pose[:3]), np.array(self.held.pose[3:])
        q, v = self._physics.free_joints[self.held.object]
        turned: NDArray[np.float64] = np.zeros(4)
        mujoco.mju_mulQuat(turned, data.xquat[self._segment], quaternion)
        data.qpos[q : q + 3] = data.xpos[self._segment] + data.xmat[self._segment].reshape(3, 3) @ position
        data.qpos[q + 3 : q + 7] = turned
        data.qvel[v : v + 6] = 0


def _geoms_of(model: Any, body: int) -> tuple[int, ...]:
    return tuple(np.flatnonzero(np.isin(model.geom_bodyid, _bodies_of(model, body))).tolist())


def _bodies_of(model: Any, body: int) -> NDArray[np.intp]:
    """Returns the MuJoCo bodies (n,) that have the same root as one of them."""
    return np.flatnonzero(model.body_rootid == model.body_rootid[body])
