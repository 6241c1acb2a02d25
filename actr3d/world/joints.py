"""The joints of a body at run time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mujoco import MjModel, mjtTrn

from actr3d.errors import WorldError

if TYPE_CHECKING:
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
        row = body.holding.row(self.name)
        if row is not None:
            return float(body.holding.told[row])
        return 0.0 if self.servo is None else float(self._ctrl[self._control])

    def drive(self, speed: float, body: Body) -> None:
        """Tells its servo to keep a speed [rad/s].

        It stops at once. It starts at once where nothing touches the body, and both hands do not hold one load with it; else its
        servo has to bring it to that speed, so that no command can press a limb into a wall, or throw the body about.

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
        row = body.holding.row(self.name)
        if row is None:
            self._ctrl[self._control] = speed
        else:
            body.holding.tell(row, speed)
        if speed == 0:
            body.holding.halt([self.v])
        elif body.holding.steady(row):
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
