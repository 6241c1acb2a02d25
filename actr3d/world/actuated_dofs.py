"""The degrees of freedom that servos of a body drive: their positions, speeds and controls."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from mujoco import mjtEq, mjtObj
from numpy.typing import NDArray

from actr3d.world.anatomy import Anatomy
from actr3d.world.base import Base
from actr3d.world.joints import Joint
from actr3d.world.kernel import apply_corrections, compute_deviations, shift_held
from actr3d.world.physics import Physics

Row = NDArray[np.float64]


class ActuatedDofs:
    """The base and the joints of one body that have a velocity servo; each is one row of the arrays (n,).

    The first three rows of a body that walks are its base: places x, y and heading, speeds forward, left and turn. Then follow
    its joints. Callers may change the returned arrays.

    Args:
        physics: The compiled scene and its state.
        anatomy: Names the servos of the body.
        base: The base of the body.
        joints: The joints of the body.
        members: (nbody,) by MuJoCo body: whether it is part of the body.
    """

    def __init__(self, physics: Physics, anatomy: Anatomy, base: Base, joints: Iterable[Joint], members: NDArray[np.bool_]) -> None:
        data = physics.mj_data
        model: Any = physics.mj_model
        names, walks = anatomy.servos, anatomy.walking_servos or ()
        acts = [int(model.actuator(name).id) for name in names]
        joints = [joint for joint in joints if joint.servo in acts]
        servos = [int(model.actuator(name).id) for name in walks] + [int(joint.servo or 0) for joint in joints]
        self._base = base
        self._qpos, self._qvel, self._ctrl = data.qpos, data.qvel, data.ctrl
        self.base = len(walks)
        """Number of rows of the base: three or none."""
        self.joints = {joint.name: self.base + row for row, joint in enumerate(joints)}
        """By joint: its row."""
        self.q = _rows([base.q + n for n in range(self.base)] + [joint.q for joint in joints])
        self.v = _rows([base.v + n for n in range(self.base)] + [joint.v for joint in joints])
        self.c = _rows([model.actuator_ctrladr[servo] for servo in servos])
        """Their indices in MuJoCo's `qpos`, `qvel` and `ctrl`."""
        self.lower = np.array([-math.inf] * self.base + [joint.lower for joint in joints])
        self.upper = np.array([math.inf] * self.base + [joint.upper for joint in joints])
        self._still = np.zeros(len(self.q))
        self.band: Row = model.actuator_forcerange[servos, 1] / model.actuator_gainprm[servos, 0]
        """Difference between control and speed from which the servo applies its full force."""
        self._none = np.zeros(len(self.q), dtype=bool)
        self.looped: NDArray[np.bool_] = _in_loop(model, members, self.v)
        """Those in a closed loop (both hands hold one load), which cannot all move independently."""
        self.loops = bool(self.looped.any())
        """Whether there are any of these."""

    @property
    def positions(self) -> Row:
        """Their positions [m] [rad]."""
        return self._qpos[self.q]

    def position(self, row: int) -> float:
        """Returns the position in one row [m] [rad]."""
        return float(self._qpos[self.q[row]])

    @property
    def speeds(self) -> Row:
        """Their speeds [m/s] [rad/s]."""
        return self.along_base(self._qvel[self.v])

    @property
    def controls(self) -> Row:
        """The target speeds of their servos [m/s] [rad/s]."""
        return self._ctrl[self.c]

    def set_controls(self, speeds: Row | float | tuple[float, ...], rows: slice | NDArray[np.intp] = slice(None)) -> None:
        """Sets the servos of some rows to keep other speeds."""
        self._ctrl[self.c[rows]] = speeds

    def shift_held(self, rows: NDArray[np.intp], changes: Row | None, held: Row, commanded: Row, loose: Row, duration: float) -> bool:
        """Shifts the held places of some rows, and commands the speeds that reach them, both in place. A row that holds no place stays as
        it is.

        Args:
            rows: The rows (k,).
            changes: By how much each place moves in a time (k,) [m] [rad]; None: what moves stops.
            held: The places to hold; NaN where it is commanded to move.
            commanded: The commanded speeds.
            loose: Becomes NaN where a place moves.
            duration: The time [s].

        Returns:
            Whether anything moves or has stopped.
        """
        moves = changes is not None
        state = self.q, self.c, self._qpos, self._ctrl
        return shift_held()(rows, changes if moves else self._still[: len(rows)], moves, *state, held, commanded, loose, duration)

    def rest(self, which: NDArray[np.bool_]) -> None:
        """Sets the speeds of some of them to 0 immediately."""
        self._ctrl[self.c[which]] = 0
        self._qvel[self.v[which]] = 0

    def deviations(self, held: Row, commanded: Row, duration: float, slight_way: float, slight_speed: float) -> Row | None:
        """Compares them with what is commanded.

        Args:
            held: The places to hold; NaN where it is commanded to move.
            commanded: The commanded speeds.
            duration: The time in which no joint may pass its limit [s]; 0 if no joint moves.
            slight_way: Deviation of a place that needs no correction [m] [rad].
            slight_speed: Deviation of a speed that needs none [m/s] [rad/s].

        Returns:
            None if none needs a correction. Else, (3, n): their ways back to the held places, NaN where they are to move [m] [rad]; their
            speeds beyond those that the servos keep; and the commanded speeds, or those that reach a limit just at the end [m/s] [rad/s].
        """
        results = np.empty((3, len(self.q)))
        state, bounds = (self._qpos, self._qvel, self._ctrl), (self.lower, self.upper, duration, slight_way, slight_speed)
        needed = compute_deviations()(self.q, self.v, self.c, *state, self.base, *self._direction(), held, commanded, *bounds, results)
        return results if needed else None

    def apply_corrections(self, ways: Row, wanted: Row, time: float, most: float, slight_speed: float, *, loops: bool) -> None:
        """Sets their speeds, at once, so that they return to the held places, and move as wanted where they are to move.

        Small differences are left to the servo, which needs a small lag to exert a force.

        Args:
            ways: Their ways back; NaN where they are to move [m] [rad]. It is overwritten.
            wanted: The wanted speeds [m/s] [rad/s]. It is overwritten.
            time: Time constant of the return [s].
            most: Its greatest speed [m/s] [rad/s].
            slight_speed: Difference of a speed that is left to the servo [m/s] [rad/s].
            loops: Whether joints in a closed loop may be set at once, too. If not, only their servos change their speeds: speeds that
                violate the closed loop would push the base around.
        """
        servos_only = self._none if loops else self.looped
        corrections = ways, wanted, time, most, slight_speed, servos_only
        apply_corrections()(self.v, self.c, self._qvel, self._ctrl, self.base, *self._direction(), *corrections)

    def _direction(self) -> tuple[float, float]:
        """Returns cosine and sine of the base's heading."""
        heading = self._base.heading if self.base else 0.0
        return math.cos(heading), math.sin(heading)

    def along_base(self, values: Row) -> Row:
        """Rotates the first two values, in place, from the world's axes to those of the base."""
        if self.base:
            c, s = self._direction()
            x, y = values.item(0), values.item(1)
            values[0], values[1] = c * x + s * y, c * y - s * x
        return values


def _rows(numbers: list[Any]) -> NDArray[np.intp]:
    return np.array(numbers, dtype=np.intp)


def _in_loop(model: Any, members: NDArray[np.bool_], dofs: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Returns which degrees of freedom are in a loop that an equality between two parts of a body closes."""
    found = np.zeros(len(dofs), dtype=bool)
    for number in range(int(model.neq)):
        ends = int(model.eq_obj1id[number]), int(model.eq_obj2id[number])
        kind = model.eq_type[number] == int(mjtEq.mjEQ_CONNECT) and model.eq_objtype[number] == int(mjtObj.mjOBJ_BODY)
        if kind and members[ends[0]] and members[ends[1]]:
            one, other = (_with_carriers(model, end) for end in ends)
            found |= np.isin(model.dof_bodyid[dofs], list(one ^ other))
    return found


def _with_carriers(model: Any, number: int) -> set[int]:
    """Returns a MuJoCo body and all that carry it."""
    found = {number}
    while number:
        number = int(model.body_parentid[number])
        found.add(number)
    return found
