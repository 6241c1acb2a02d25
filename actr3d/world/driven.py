"""What the servos of a body drive: where it is, how fast it moves, and what the servos are set to."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from actr3d.world.loops import in_loop
from actr3d.world.reach import reaches

if TYPE_CHECKING:
    from actr3d.world.body import Body

Row = NDArray[np.float64]


class Driven:
    """The base and the joints of one body that have a servo of ours, in rows of numbers.

    The first three rows of a body that walks are its base: places x, y and heading, speeds forward, left and turn. Then come
    its joints. What is returned may be changed.
    """

    def __init__(self, body: Body) -> None:
        data = body.world.mj_data
        model: Any = body.world.mj_model
        names, walks = body.anatomy.servos, body.anatomy.push or ()
        acts = [int(model.actuator(name).id) for name in names]
        joints = [joint for joint in body.joints.values() if joint.servo in acts]
        servos = [int(model.actuator(name).id) for name in walks] + [int(joint.servo or 0) for joint in joints]
        self._body = body
        self._qpos, self._qvel, self._ctrl = data.qpos, data.qvel, data.ctrl
        self.base = len(walks)
        """How many rows are the base's: three or none."""
        self.joints = {joint.name: self.base + row for row, joint in enumerate(joints)}
        """By joint: its row."""
        self.q = _rows([body.base.q + n for n in range(self.base)] + [joint.q for joint in joints])
        self.v = _rows([body.base.v + n for n in range(self.base)] + [joint.v for joint in joints])
        self.c = _rows([model.actuator_ctrladr[servo] for servo in servos])
        """Where they are in MuJoCo's `qpos`, `qvel` and `ctrl`."""
        self.lower = np.array([-math.inf] * self.base + [joint.lower for joint in joints])
        self.upper = np.array([math.inf] * self.base + [joint.upper for joint in joints])
        self.band: Row = model.actuator_forcerange[servos, 1] / model.actuator_gainprm[servos, 0]
        """How far a control must be from the speed for the servo to do all it can."""
        self.faces = body.base.faces
        """Where the base faces when its place's third number is 0 [rad]."""
        self._farthest: Row = reaches(body).max(axis=0, initial=0.0)
        self.looped: NDArray[np.bool_] = in_loop(body, self.v)
        """Those that cannot all be moved by themselves, because both hands hold one load."""

    @property
    def places(self) -> Row:
        """Where they are [m] [rad]."""
        return self._qpos[self.q]

    @property
    def speeds(self) -> Row:
        """How fast they move [m/s] [rad/s]."""
        return self.along_base(self._qvel[self.v])

    def set_speeds(self, speeds: Row, which: NDArray[np.bool_]) -> None:
        """Gives some of them their speeds at once."""
        self._qvel[self.v] = np.where(which, self.along_base(speeds, -1), self._qvel[self.v])

    @property
    def controls(self) -> Row:
        """The speeds that their servos are set to keep."""
        return self._ctrl[self.c]

    def set_controls(self, speeds: Row | float | tuple[float, ...], rows: slice = slice(None)) -> None:
        """Sets the servos of some rows to keep other speeds."""
        self._ctrl[self.c[rows]] = speeds

    def rest(self, which: NDArray[np.bool_]) -> None:
        """Stops some of them at once."""
        self._ctrl[self.c[which]] = 0
        self._qvel[self.v[which]] = 0

    def along_base(self, values: Row, way: int = 1) -> Row:
        """Turns the first two from the world's axes to those of the base, in place, or with -1 back."""
        if self.base:
            heading = self._body.base.heading
            c, s = math.cos(heading), way * math.sin(heading)
            x, y = values.item(0), values.item(1)
            values[0], values[1] = c * x + s * y, c * y - s * x
        return values

    def fastest(self, speeds: Row) -> float:
        """Returns what no point of the body exceeds at these speeds [m/s]; infinity where not all that moves it is driven."""
        others = np.delete(self._farthest, self.v)
        return float(speeds @ self._farthest[self.v]) if not others.any() else math.inf


def _rows(numbers: list[Any]) -> NDArray[np.intp]:
    return np.array(numbers, dtype=np.intp)
