"""The base that carries a body, at run time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from actr3d.world.parts import yaw_quaternion

if TYPE_CHECKING:
    from actr3d.world.anatomy import Anatomy
    from actr3d.world.body import Body
    from actr3d.world.world import World


class Base:
    """What carries a body: slides along the world's x and y and turns about the vertical, flies free, or stands fixed."""

    def __init__(self, world: World, root: int, anatomy: Anatomy) -> None:
        model = world.mj_model
        self._world = world
        self._qpos = world.mj_data.qpos
        self._root = root
        first, count = int(model.body_jntadr[root]), int(model.body_jntnum[root])
        names = [model.joint(first + n).name for n in range(count)]
        self.planar = names == [f"{anatomy.prefix}{name}" for name in ("x", "y", "heading")]
        self.free = count == 1 and int(model.jnt_type[first]) == 0
        self.joints = frozenset(range(first, first + count)) if self.planar or self.free else frozenset[int]()
        self.q = int(model.jnt_qposadr[first]) if count else 0
        self.v = int(model.jnt_dofadr[first]) if count else 0
        self._at = tuple(float(x) for x in model.body_pos[root])
        w, _, _, z = (float(x) for x in model.body_quat[root])
        self.faces = 2 * math.atan2(z, w)
        """Where a planar base faces when its heading joint is at 0 [rad]."""

    @property
    def place(self) -> tuple[float, float, float]:
        """Of a planar base: (x, y, heading) in the world's frame [m] [m] [rad], the heading not wrapped."""
        x, y, heading = self._world.mj_data.qpos[self.q : self.q + 3].tolist()
        return (self._at[0] + x, self._at[1] + y, self.faces + heading)

    @place.setter
    def place(self, value: tuple[float, float, float]) -> None:
        x, y, heading = value
        self._world.mj_data.qpos[self.q : self.q + 3] = (x - self._at[0], y - self._at[1], heading - self.faces)

    @property
    def heading(self) -> float:
        """Of a planar base: where it faces in the world's frame [rad], not wrapped."""
        return self.faces + self._qpos.item(self.q + 2)

    @property
    def speed(self) -> tuple[float, float, float]:
        """Of a planar base: (forward, left, turn) in its own frame [m/s] [m/s] [rad/s]."""
        x, y, turn = self._world.mj_data.qvel[self.v : self.v + 3].tolist()
        c, s = math.cos(self.place[2]), math.sin(self.place[2])
        return (c * x + s * y, c * y - s * x, turn)

    @speed.setter
    def speed(self, value: tuple[float, float, float]) -> None:
        forward, left, turn = value
        c, s = math.cos(self.place[2]), math.sin(self.place[2])
        self._world.mj_data.qvel[self.v : self.v + 3] = (c * forward - s * left, s * forward + c * left, turn)

    def drive(self, speed: tuple[float, float, float], body: Body) -> None:
        """Tells its servos to keep a speed (forward, left, turn), as `Joint.drive` does.

        When it stops, the joints of its body that are told to stand still stop with it: what is in the way may just have
        turned them as fast as the base moved, and would be struck by a limb that goes on without it.
        """
        if speed == body.holding.commanded:
            return
        body.holding.tell_base(speed)
        if speed == (0, 0, 0):
            body.holding.halt([self.v, self.v + 1, self.v + 2, *body.holding.still()])
        elif body.holding.steady():
            self.speed = speed

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Puts the base elsewhere, (x, y) [m] and heading [rad] or the same; a planar base goes on as it was told, a free one rests."""
        data = self._world.mj_data
        if self.planar:
            speed = self.speed
            self.place = (x, y, self.place[2] if heading is None else heading)
            self.speed = speed
            return
        data.qpos[self.q : self.q + 2] = (x, y)
        data.qvel[self.v : self.v + 6] = 0
        if heading is not None:
            data.qpos[self.q + 3 : self.q + 7] = yaw_quaternion(heading)
