"""The joints of a body at run time."""

from __future__ import annotations

import math

import numpy as np
from mujoco import MjModel, mjtJoint, mjtTrn

from actr3d.errors import WorldError
from actr3d.world.physics import Physics

AT_LIMIT = 2e-3
"""Greatest distance from its limit at which a joint counts as at its limit [rad], or [m] for a slide: about 0.1 degrees, because limits
yield a little under load. Source: chosen for this library."""


class Joint:
    """One hinge or slide: its position, velocity, limits, and its servo if it has one.

    Args:
        physics: The compiled scene and its state.
        number: MuJoCo's number of the joint.
        name: Its name in the body.
    """

    def __init__(self, physics: Physics, number: int, name: str) -> None:
        model, data = physics.mj_model, physics.mj_data
        self.name = name
        self.turns: bool = model.jnt_type[number] == int(mjtJoint.mjJNT_HINGE)
        """Whether it is a hinge, not a slide."""
        self.number = number
        """MuJoCo's number of the joint."""
        limited = bool(model.jnt_limited[number])
        self.lower: float = float(model.jnt_range[number, 0]) if limited else -math.inf
        self.upper: float = float(model.jnt_range[number, 1]) if limited else math.inf
        self._qpos, self._qvel, self._ctrl = data.qpos, data.qvel, data.ctrl
        self.q, self.v = int(model.jnt_qposadr[number]), int(model.jnt_dofadr[number])
        self.servo: int | None = _servo_of(model, number)
        """The actuator that moves it; None if the joint is not actuated."""
        self._control, self._gear = -1, 1.0
        self.speeds = (-math.inf, math.inf)
        """The least and the greatest speed that its servo can be set to keep [rad/s] or [m/s]."""
        if self.servo is not None:
            self._control, self._gear = int(model.actuator_ctrladr[self.servo]), float(model.actuator_gear[self.servo, 0])
            if model.actuator_ctrllimited[self.servo]:
                least, greatest = sorted(float(control) / self._gear for control in model.actuator_ctrlrange[self.servo])
                self.speeds = least, greatest

    @property
    def limits(self) -> tuple[float, float]:
        """The least and the greatest position [rad] or [m]; infinite without limits."""
        return (self.lower, self.upper)

    @property
    def position(self) -> float:
        """Its position [rad] or [m]."""
        return float(self._qpos[self.q])

    @property
    def velocity(self) -> float:
        """Its velocity [rad/s] or [m/s]."""
        return float(self._qvel[self.v])

    @velocity.setter
    def velocity(self, value: float) -> None:
        self._qvel[self.v] = value

    @property
    def control(self) -> float:
        """The target speed of its servo [rad/s] or [m/s]; 0 if it is not actuated."""
        return 0.0 if self.servo is None else float(self._ctrl[self._control]) / self._gear

    @control.setter
    def control(self, value: float) -> None:
        if self.servo is None:
            raise WorldError(f"joint '{self.name}' has no servo that could move it")
        self._ctrl[self._control] = self._gear * value

    @property
    def driven(self) -> bool:
        """Whether a servo moves it."""
        return self.servo is not None

    def put(self, position: float) -> None:
        """Sets its position [rad] or [m] immediately, without physics."""
        self._qpos[self.q] = position


def _servo_of(model: MjModel, joint: int) -> int | None:
    """Returns a joint's servo: an actuator whose force falls with the speed and not with the position."""
    moves = (model.actuator_trntype == int(mjtTrn.mjTRN_JOINT)) & (model.actuator_trnid[:, 0] == joint)
    for number in np.flatnonzero(moves).tolist():
        gain, gear = model.actuator_gainprm[number, 0], model.actuator_gear[number, 0]
        _, by_position, by_speed = model.actuator_biasprm[number, :3]
        if gain > 0 and gear != 0 and by_speed == -gain and by_position == 0:
            return number
    return None
