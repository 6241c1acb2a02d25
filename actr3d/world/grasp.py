"""Hands that hold objects: a weld between hand and object, made and released during a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from actr3d.world.world import World

REACH = 0.05
"""How near an object must be to a hand to be held [m]. Ours, the length of a finger's grip."""


@dataclass(frozen=True, kw_only=True)
class Held:
    """What a hand holds, and how."""

    object: int
    """The MuJoCo body that it holds."""

    pose: tuple[float, ...]
    """Where the object is in the frame of the hand's segment: position (3,) [m] and quaternion (4,)."""


class Hand:
    """One hand: a weld equality of the compiled model, which is inactive while it is empty.

    Whether it is active is part of the physics state; what it ties stands in the compiled model. See `World.state` for both.

    Args:
        world: Where it is.
        name: Of the weld, and of the hand's geom.
    """

    def __init__(self, world: World, name: str) -> None:
        self._world = world
        self._weld = int(world.mj_model.equality(name).id)
        self._geom = int(world.mj_model.geom(name).id)
        self._segment = int(world.mj_model.eq_obj1id[self._weld])
        self.held: Held | None = None
        self.geoms: tuple[int, ...] = ()
        """The geoms of what it holds."""

    def reaches(self, object: int) -> bool:
        """Returns whether a MuJoCo body is near enough to be held; positions must be up to date."""
        model, data = self._world.mj_model, self._world.mj_data
        geoms = _geoms_of(model, object)
        return any(mujoco.mj_geomDistance(model, data, self._geom, geom, 2 * REACH, None) <= REACH for geom in geoms)

    def grasp(self, object: int) -> None:
        """Ties a MuJoCo body to the hand as it is now, and takes its weight; positions must be up to date."""
        data = self._world.mj_data
        turn = data.xmat[self._segment].reshape(3, 3)
        position = (data.xpos[object] - data.xpos[self._segment]) @ turn
        back, quaternion = np.zeros(4), np.zeros(4)
        mujoco.mju_negQuat(back, data.xquat[self._segment])
        mujoco.mju_mulQuat(quaternion, back, data.xquat[object])
        held = Held(object=object, pose=(*position.tolist(), *quaternion.tolist()))
        self.restore(held)
        model: Any = self._world.mj_model
        model.eq_obj2id[self._weld] = object
        model.eq_data[self._weld, :3] = 0
        model.eq_data[self._weld, 3:10] = held.pose
        data.eq_active[self._weld] = 1
        data.xfrc_applied[object, :3] = -model.opt.gravity * model.body_mass[object]

    def release(self) -> None:
        """Lets go of what it holds, if anything; another hand that holds it too goes on carrying it."""
        others = {
            hand.held.object for body in self._world.bodies.values() for hand in body.hands.values() if hand is not self and hand.held
        }
        if self.held is not None and self.held.object not in others:
            self._world.mj_data.xfrc_applied[self.held.object, :3] = 0
        self._world.mj_data.eq_active[self._weld] = 0
        self.restore(None)

    def restore(self, held: Held | None) -> None:
        """Notes what is held; the weld itself is part of the world's state."""
        self.held = held
        self.geoms = () if held is None else _geoms_of(self._world.mj_model, held.object)

    def carry(self) -> None:
        """Puts what it holds where the hand is, at rest, after the body was put elsewhere; positions must be up to date."""
        if self.held is None:
            return
        model, data = self._world.mj_model, self._world.mj_data
        position, quaternion = np.array(self.held.pose[:3]), np.array(self.held.pose[3:])
        joint = int(model.body_jntadr[self.held.object])
        q, v = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        turned: NDArray[np.float64] = np.zeros(4)
        mujoco.mju_mulQuat(turned, data.xquat[self._segment], quaternion)
        data.qpos[q : q + 3] = data.xpos[self._segment] + data.xmat[self._segment].reshape(3, 3) @ position
        data.qpos[q + 3 : q + 7] = turned
        data.qvel[v : v + 6] = 0


def _geoms_of(model: Any, body: int) -> tuple[int, ...]:
    roots = model.body_rootid[model.geom_bodyid]
    return tuple(int(geom) for geom in np.flatnonzero(roots == model.body_rootid[body]))
