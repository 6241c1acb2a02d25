"""The joints of a body at run time, and the base that carries it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mujoco import MjModel, mjtTrn

from actr3d.errors import WorldError
from actr3d.world.parts import yaw_quaternion

if TYPE_CHECKING:
    from actr3d.world.anatomy import Anatomy
    from actr3d.world.body import Body
    from actr3d.world.world import World


AT_LIMIT = 2e-3
"""How near its limit a joint has reached it [rad]: about a tenth of a degree, what a pressed limit gives way. Ours."""


class Joint:
    """One hinge or slide: where it is, how fast it turns, how far it can, and its servo if it has one."""

    def __init__(self, world: World, number: int, name: str) -> None:
        model, data = world.mj_model, world.mj_data
        self.name = name
        self.number = number
        """Which of MuJoCo's joints it is."""
        limited = bool(model.jnt_limited[number])
        self.lower: float = float(model.jnt_range[number, 0]) if limited else -math.inf
        self.upper: float = float(model.jnt_range[number, 1]) if limited else math.inf
        self._qpos, self._qvel, self._ctrl = data.qpos, data.qvel, data.ctrl
        self.q, self.v = int(model.jnt_qposadr[number]), int(model.jnt_dofadr[number])
        self.servo: int | None = _servo_of(model, number)
        """The actuator that moves it; None is moved by none."""
        self._control = -1 if self.servo is None else int(model.actuator_ctrladr[self.servo])

    @property
    def limits(self) -> tuple[float, float]:
        """The least and the greatest position [rad] or [m]; infinite without limits."""
        return (self.lower, self.upper)

    @property
    def position(self) -> float:
        """Where it is [rad] or [m]."""
        return float(self._qpos[self.q])

    @property
    def velocity(self) -> float:
        """How fast it moves [rad/s] or [m/s]."""
        return float(self._qvel[self.v])

    def told(self, body: Body) -> float:
        """Returns the speed that its servo is told to keep, by commands of the body that it is a joint of [rad/s]; 0 without one."""
        row = body.holding.rows.get(self.name)
        if row is not None:
            return float(body.holding.told[row])
        return 0.0 if self.servo is None else float(self._ctrl[self._control])

    def drive(self, speed: float, body: Body) -> None:
        """Tells its servo to keep a speed [rad/s].

        It stops at once. It starts at once where nothing touches the body; else its servo has to bring it to that speed, so that
        no command can press a limb into a wall.

        Args:
            speed: The speed.
            body: The body that it is a joint of.

        Raises:
            WorldError: If no servo moves it.
        """
        if self.servo is None:
            raise WorldError(f"joint '{self.name}' has no servo that could move it")
        if self.told(body) == speed:
            return
        row = body.holding.rows.get(self.name)
        if row is None:
            self._ctrl[self._control] = speed
        else:
            body.holding.tell(row, speed)
        if speed == 0:
            body.holding.halt([self.v])
        elif body.holding.steady():
            self._qvel[self.v] = speed

    def put(self, position: float) -> None:
        """Puts it at a position [rad] or [m], at once."""
        self._qpos[self.q] = position

    @property
    def driven(self) -> bool:
        """Whether a servo moves it."""
        return self.servo is not None


def _servo_of(model: MjModel, joint: int) -> int | None:
    """Returns a joint's servo: an actuator whose force falls with the speed and not with the position."""
    for number in range(int(model.nactuator)):
        actuator: Any = model.actuator(number)
        moves = model.actuator_trntype[number] == int(mjtTrn.mjTRN_JOINT) and model.actuator_trnid[number, 0] == joint
        if moves and actuator.biasprm[2] == -actuator.gainprm[0] and actuator.biasprm[1] == 0:
            return number
    return None


class Base:
    """What carries a body: slides along the world's x and y and turns about the vertical, flies free, or stands fixed."""

    def __init__(self, world: World, root: int, anatomy: Anatomy) -> None:
        model = world.mj_model
        self._world = world
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
        self._faces = 2 * math.atan2(z, w)

    @property
    def place(self) -> tuple[float, float, float]:
        """Of a planar base: (x, y, heading) in the world's frame [m] [m] [rad], the heading not wrapped."""
        x, y, heading = self._world.mj_data.qpos[self.q : self.q + 3].tolist()
        return (self._at[0] + x, self._at[1] + y, self._faces + heading)

    @place.setter
    def place(self, value: tuple[float, float, float]) -> None:
        x, y, heading = value
        self._world.mj_data.qpos[self.q : self.q + 3] = (x - self._at[0], y - self._at[1], heading - self._faces)

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
