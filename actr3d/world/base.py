"""The base that carries a body, at run time."""

from __future__ import annotations

import math

from actr3d.world.frames import yaw_in
from actr3d.world.physics import Physics


class Base:
    """Carries a body: slides along the world's x and y and turns about the vertical (planar), has a free joint (free), or is fixed.

    Args:
        physics: The compiled scene and its state.
        root: The MuJoCo body that carries all others.
        prefix: The start of the names of the body's elements.
    """

    def __init__(self, physics: Physics, root: int, prefix: str) -> None:
        model = physics.mj_model
        self._physics, self._root = physics, root
        self._qpos, self._qvel = physics.mj_data.qpos, physics.mj_data.qvel
        first, count = int(model.body_jntadr[root]), int(model.body_jntnum[root])
        names = [model.joint(first + n).name for n in range(count)]
        self.planar = names == [f"{prefix}{name}" for name in ("x", "y", "heading")]
        self.free = root in physics.free_joints
        self.joints = frozenset(range(first, first + count)) if self.planar or self.free else frozenset[int]()
        self.q = int(model.jnt_qposadr[first]) if count else 0
        self.v = int(model.jnt_dofadr[first]) if count else 0
        self._at = tuple(float(x) for x in model.body_pos[root])
        self.faces = yaw_in(model.body_quat[root].tolist())
        """Heading of a planar base when its heading joint is at 0 [rad]."""

    @property
    def pose(self) -> tuple[float, float, float]:
        """Of a planar base: (x, y, heading) in the world's frame [m] [m] [rad], the heading not wrapped."""
        x, y, heading = self._qpos[self.q : self.q + 3].tolist()
        return (self._at[0] + x, self._at[1] + y, self.faces + heading)

    @pose.setter
    def pose(self, value: tuple[float, float, float]) -> None:
        x, y, heading = value
        self._qpos[self.q : self.q + 3] = (x - self._at[0], y - self._at[1], heading - self.faces)

    @property
    def heading(self) -> float:
        """Of a planar base: its heading in the world's frame [rad], not wrapped."""
        return self.faces + self._qpos.item(self.q + 2)

    @property
    def speed(self) -> tuple[float, float, float]:
        """Of a planar base: (forward, left, turn) in its own frame [m/s] [m/s] [rad/s]."""
        (x, y, turn), heading = self._qvel[self.v : self.v + 3].tolist(), self.heading
        c, s = math.cos(heading), math.sin(heading)
        return (c * x + s * y, c * y - s * x, turn)

    @speed.setter
    def speed(self, value: tuple[float, float, float]) -> None:
        forward, left, turn = value
        c, s = math.cos(self.heading), math.sin(self.heading)
        self._qvel[self.v : self.v + 3] = (c * forward - s * left, s * forward + c * left, turn)

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Moves the base to (x, y) [m] and a heading [rad], or keeps the heading.

        A planar base keeps its speed in its own frame; a free one comes to rest.
        """
        if self.planar:
            speed = self.speed
            self.pose = (x, y, self.pose[2] if heading is None else heading)
            self.speed = speed
        else:
            self._physics.put_loose(self._root, x, y, heading)
