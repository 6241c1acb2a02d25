"""What a body does to keep what it is told: speeds while it moves, its place and the angles of its joints while it stands."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from mujoco import mjtEq, mjtObj
from numpy.typing import NDArray

if TYPE_CHECKING:
    from actr3d.world.body import Body

SLIGHT_WAY, SLIGHT_SPEED = 1e-5, 1e-2
"""What is nothing to speak of: off its place [m] [rad], and off its speed [m/s] [rad/s]. Ours."""

YIELD = 1e-3
"""How far what touches a body can push its base before that stays where it was pushed [m] [rad]. Ours."""

UNHINDERED, HINDERED = (0.02, 2.0), (0.1, 0.5)
"""In what time most of the way back is gone [s], and how fast at most [m/s] [rad/s], while nothing touches the body and while
something does: quickly back against a wall would bounce off it. Ours."""


class Holding:
    """Keeps one body's base and joints at what they are told, once before each tick.

    What its own limbs do to them is undone: while nothing touches it, speeds are those told, and what is told to stand still comes
    back to where it stood. Against what touches it there are only its servos, whose force has a bound: what is pushed harder gives
    way. Limbs come back when they can; the base stays where it was pushed.

    Base and joints are in rows: of a body that walks its place x, y and its heading, then its joints that have a servo of ours.
    """

    def __init__(self, body: Body) -> None:
        self._body = body
        world = body.world
        model: Any = world.mj_model
        acts = [int(model.actuator(name).id) for name in body.anatomy.servos]
        joints = [joint for joint in body.joints.values() if joint.servo in acts]
        self.walks = body.anatomy.push is not None
        numbers = [int(model.actuator(name).id) for name in body.anatomy.push or ()] + [int(joint.servo or 0) for joint in joints]
        first = [body.base.q + n for n in range(3)] if self.walks else []
        self._q = np.array(first + [joint.q for joint in joints], dtype=np.intp)
        first = [body.base.v + n for n in range(3)] if self.walks else []
        self._v = np.array(first + [joint.v for joint in joints], dtype=np.intp)
        self._ctrl = np.array([model.actuator_ctrladr[number] for number in numbers], dtype=np.intp)
        self._first = len(first)
        self._upper = np.array([math.inf] * len(first) + [joint.upper for joint in joints])
        self._lower = np.array([-math.inf] * len(first) + [joint.lower for joint in joints])
        self._band = model.actuator_forcerange[numbers, 1] / model.actuator_gainprm[numbers, 0]
        """How far a control must be from the speed for the servo to do all it can."""
        self._loop = _loop(body, self._v)
        """The joints that cannot all be moved by themselves, because both hands hold one load."""
        self.rows = {joint.name: len(first) + row for row, joint in enumerate(joints)}
        """By joint: its row."""
        self.told: NDArray[np.float64] = np.zeros(len(self._q))
        """The speeds that they are told to keep; of the base along its own axes: forward, left, turn."""
        self.held: NDArray[np.float64] = world.mj_data.qpos[self._q]
        """Where they are told to stand still; NaN while they are told to move."""
        self.calm = True
        """Whether nothing has touched it since its base last had the speed that it is told."""
        self._struck = False
        self._pulls = False
        self._moves = False
        self._mine = np.append(body.members[model.geom_bodyid], False)  # the last one for soft things, whose geom is -1

    def before_step(self, duration: float) -> None:
        """Brings back what is off, for the next `duration` [s]."""
        data = self._body.world.mj_data
        if self._loop.any() and np.isnan(self.held[self._loop]).any():
            self.held[self._loop & np.isfinite(self.held)] = data.qpos[self._q[self._loop & np.isfinite(self.held)]]
        ways = self.held - data.qpos[self._q]
        speeds = self._own(data.qvel[self._v])
        off = np.abs(speeds - data.ctrl[self._ctrl])
        wanted = self._wanted(duration) if self._moves else self.told
        if not (np.abs(ways) > SLIGHT_WAY).any() and off.max(initial=0.0) <= SLIGHT_SPEED and wanted is self.told:
            self.calm, self._struck = not self._struck, False
            if self.calm and self._pulls:
                self._let_be()
            return
        self._pulls = True
        free = not self._struck and self._body.free()
        self.calm, self._struck = free and (self.calm or not self.walks or off[:3].max() <= SLIGHT_SPEED), False
        if self.walks and not self.calm:
            ways[:3] = np.clip(ways[:3], -YIELD, YIELD)
            self.held[:3] = data.qpos[self._q[:3]] + ways[:3]
        time, most = UNHINDERED if self.calm else HINDERED
        back = self._own(np.clip(ways / time, -most, most))
        still = np.isfinite(back)
        if self.calm:
            wanted = np.where(still, back, wanted)
            data.ctrl[self._ctrl] = wanted
            # What is hardly off is left to its servo: to lag a little is how it carries what turns.
            right = np.abs(wanted - speeds) <= SLIGHT_SPEED
            right[: self._first] = right[: self._first].all()
            data.qvel[self._v] = np.where(right, data.qvel[self._v], self._own(wanted, -1))
        else:
            # What the load has taken off its speed is added to it, as much as the servo can.
            more = np.clip(data.ctrl[self._ctrl] - speeds + back - speeds, -self._band, self._band)
            data.ctrl[self._ctrl] = np.where(still, speeds + more, wanted)

    def tell(self, row: int, speed: float) -> None:
        """Notes what a joint is told: to stand still where it is, or to move at a speed [rad/s]."""
        data = self._body.world.mj_data
        self.told[row] = data.ctrl[self._ctrl[row]] = speed
        self.held[row] = data.qpos[self._q[row]] if speed == 0 else math.nan
        self._moves = bool(self.told[self._first :].any())

    def _wanted(self, duration: float) -> NDArray[np.float64]:
        """Returns the speeds told, and for joints that would run into a limit what brings them there just at the end."""
        at = self._body.world.mj_data.qpos[self._q]
        wanted = np.clip(self.told, (self._lower - at) / duration, (self._upper - at) / duration)
        return self.told if (wanted == self.told).all() else wanted

    def steady(self) -> bool:
        """Returns whether it may have the speeds that it is told at once: nothing touches it or has just pushed it."""
        return self.calm and self._body.free()

    def halt(self, dofs: list[int]) -> None:
        """Stops degrees of freedom at once.

        Where others go on, that alone could speed up limbs that they carry; then all slow down, so that none of it adds energy.
        """
        world = self._body.world
        model, data = world.mj_model, world.mj_data
        product = np.zeros(model.nv)
        mujoco.mj_mulM(model, data, product, data.qvel)
        before = float(data.qvel @ product)
        data.qvel[dofs] = 0
        mujoco.mj_mulM(model, data, product, data.qvel)
        after = float(data.qvel @ product)
        if after > before > 0:
            own = self._body.members[model.dof_bodyid]
            data.qvel[own] *= np.sqrt(before / after)

    def _let_be(self) -> None:
        """Stops what has come back."""
        data = self._body.world.mj_data
        still = np.isfinite(self.held)
        data.ctrl[self._ctrl[still]] = 0
        data.qvel[self._v[still]] = 0
        self._pulls = False

    def notice(self) -> None:
        """Notes whether anything touches the body in the physics step just taken, which had contacts."""
        if not self._struck:
            mine = self._mine
            held = [geom for hand in self._body.hands.values() for geom in hand.geoms]
            if held:
                mine = mine.copy()
                mine[held] = True
            one, other = mine[self._body.world.mj_data.contact.geom].T
            self._struck = bool((one != other).any())

    def tell_base(self, speed: tuple[float, float, float]) -> None:
        """Notes what the base is told: to stand, to go straight, or to move (forward, left, turn) [m/s] [m/s] [rad/s]."""
        data = self._body.world.mj_data
        self.told[:3] = data.ctrl[self._ctrl[:3]] = speed
        if speed == (0, 0, 0):
            self._let_be()
        self.held[:2] = data.qpos[self._q[:2]] if speed == (0, 0, 0) else math.nan
        if speed[2] != 0:
            self.held[2] = math.nan
        elif self.held[2] != self.held[2]:
            self.held[2] = data.qpos[self._q[2]]

    def stand(self, joint: str | None = None) -> None:
        """Holds the base, or a joint, where it has just been put, if it is told to stand still; others come back to where they stood."""
        rows = slice(self._first) if joint is None else slice(self.rows[joint], self.rows[joint] + 1) if joint in self.rows else slice(0)
        self.held[rows] = np.where(np.isfinite(self.held[rows]), self._body.world.mj_data.qpos[self._q[rows]], math.nan)

    @property
    def commanded(self) -> tuple[float, float, float]:
        """The speed (forward, left, turn) that the base is told to keep."""
        forward, left, turn = self.told[:3].tolist()
        return (forward, left, turn)

    def still(self) -> list[int]:
        """Returns the degrees of freedom of the joints that are told to stand still."""
        return self._v[3:][self.told[3:] == 0].tolist()

    def state(self) -> tuple[Any, ...]:
        """Returns what it holds as plain values."""
        held = (None if at != at else at for at in self.held.tolist())
        return (tuple(self.told.tolist()), tuple(held), self.calm, self._struck, self._pulls)

    def restore(self, state: tuple[Any, ...]) -> None:
        """Brings that back."""
        told, held, self.calm, self._struck, self._pulls = state
        self.told = np.array(told, dtype=np.float64)
        self.held = np.array([math.nan if at is None else at for at in held], dtype=np.float64)
        self._moves = bool(self.told[self._first :].any())

    def _own(self, values: NDArray[np.float64], way: int = 1) -> NDArray[np.float64]:
        """Turns the first two, along the world's axes, to those of the base, in place, or with -1 back."""
        if self.walks:
            heading = self._body.base.place[2]
            c, s = math.cos(heading), way * math.sin(heading)
            x, y = values[:2].tolist()
            values[:2] = c * x + s * y, c * y - s * x
        return values


def _loop(body: Body, dofs: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Returns which degrees of freedom are in a loop that an equality between two parts of a body closes."""
    model: Any = body.world.mj_model
    loop = np.zeros(len(dofs), dtype=bool)
    for number in range(int(model.neq)):
        ends = int(model.eq_obj1id[number]), int(model.eq_obj2id[number])
        kind = model.eq_type[number] == int(mjtEq.mjEQ_CONNECT) and model.eq_objtype[number] == int(mjtObj.mjOBJ_BODY)
        if kind and body.members[ends[0]] and body.members[ends[1]]:
            above = [_above(model, end) for end in ends]
            loop |= np.isin(model.dof_bodyid[dofs], list(above[0] ^ above[1]))
    return loop


def _above(model: Any, number: int) -> set[int]:
    """Returns a MuJoCo body and all that carry it."""
    found = {number}
    while number:
        number = int(model.body_parentid[number])
        found.add(number)
    return found
