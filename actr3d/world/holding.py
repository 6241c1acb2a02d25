"""What a body does to keep what it is told: speeds while it moves, its place and the angles of its joints while it stands."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from actr3d.world.driven import Driven, Row
from actr3d.world.expectation import Expectation

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
    """

    def __init__(self, body: Body) -> None:
        self._body = body
        self._driven = Driven(body)
        self._base = self._driven.base
        self.told: Row = np.zeros(len(self._driven.q))
        """The speeds that base and joints are told to keep, in the rows of `Driven`."""
        self.held: Row = self._driven.places
        """Where they are told to stand still; NaN while they are told to move."""
        self.calm = True
        """Whether nothing has touched it since its base last had the speed that it is told."""
        self._struck = False
        """Whether something has touched it since the last tick began."""
        self._pulls = False
        """Whether something was off at the last tick."""
        self._moves = False
        """Whether any joint is told to move."""
        self._expected: Expectation | None = None
        """What is so while nothing is off; None before it is worth knowing: while anything moves, is off, or is told."""
        self._new = True
        """Whether it has been told anything since the last tick began."""
        self._mine = np.append(body.members[body.world.mj_model.geom_bodyid], False)  # the last: soft things, whose geom is -1

    def row(self, joint: str) -> int | None:
        """Returns the row of a joint; None has no servo of ours."""
        return self._driven.joints.get(joint)

    def before_step(self, duration: float) -> float:
        """Brings back what is off, for the next `duration` [s].

        Returns:
            A speed that no point of the body exceeds [m/s], where it is quickly known; else infinity.
        """
        if self._expected is not None and self._expected.met():
            self._go_on()
            return self._expected.fastest
        if self._moves:
            self._let_loop_go()
        ways, off = self.held - self._driven.places, self._driven.speeds - self._driven.controls
        wanted = self._wanted(duration) if self._moves else self.told
        # NaN, what moves, is never off its place.
        if wanted is not self.told or (np.abs(ways) > SLIGHT_WAY).any() or (np.abs(off) > SLIGHT_SPEED).any():
            self._bring_back(ways, off, wanted)
        else:
            self._go_on()
            if not (self._new or self._moves):
                self._expected = Expectation(self._body.world, self._driven, self.told, self.held)
            self._new = False
        return math.inf

    def _go_on(self) -> None:
        """Does nothing, for nothing is off."""
        self.calm, self._struck = not self._struck, False
        if self.calm and self._pulls:
            self._let_be()

    def _bring_back(self, ways: Row, off: Row, wanted: Row) -> None:
        """Sets out to undo what is off."""
        self._pulls = True
        self._expected = None
        free = not self._struck and self._body.free()
        self.calm = free and (self.calm or float(np.abs(off[: self._base]).max(initial=0.0)) <= SLIGHT_SPEED)
        self._struck = False
        if not self.calm:
            self._give_way(ways)
        time, most = UNHINDERED if self.calm else HINDERED
        back = self._driven.along_base(np.clip(ways / time, -most, most))
        if self.calm:
            self._set(np.where(np.isfinite(back), back, wanted))
        else:
            self._push(back, wanted)

    def _set(self, wanted: Row) -> None:
        """Gives base and joints the speeds that they need at once."""
        driven = self._driven
        driven.set_controls(wanted)
        # What is hardly off is left to its servo: to lag a little is how it carries what turns.
        wrong = np.abs(wanted - driven.speeds) > SLIGHT_SPEED
        wrong[: self._base] = wrong[: self._base].any()
        if self._loop_moves():  # speeds that do not agree with its closing would throw the base about: its servos find some that do
            wrong &= ~driven.looped
        driven.set_speeds(wanted, wrong)

    def _push(self, back: Row, wanted: Row) -> None:
        """Lets the servos push towards the speeds that are needed: what the load has taken off a speed is added, as much as they can."""
        driven = self._driven
        speeds, band = driven.speeds, driven.band
        more = np.clip(driven.controls - speeds + back - speeds, -band, band)
        driven.set_controls(np.where(np.isfinite(back), speeds + more, wanted))

    def _give_way(self, ways: Row) -> None:
        """Lets the base stay where it was pushed, but for what is slight."""
        ways[: self._base] = np.clip(ways[: self._base], -YIELD, YIELD)
        self.held[: self._base] = self._driven.places[: self._base] + ways[: self._base]

    def _let_loop_go(self) -> None:
        """Holds joints that stand where they are now, while another one in the same loop moves and takes them along."""
        if self._loop_moves():
            stand = self._driven.looped & np.isfinite(self.held)
            self.held[stand] = self._driven.places[stand]

    def _loop_moves(self) -> bool:
        return bool(np.isnan(self.held[self._driven.looped]).any())

    def _wanted(self, duration: float) -> Row:
        """Returns the speeds told, and for joints that would run into a limit what brings them there just at the end."""
        at = self._driven.places
        wanted = np.clip(self.told, (self._driven.lower - at) / duration, (self._driven.upper - at) / duration)
        return self.told if (wanted == self.told).all() else wanted

    def _let_be(self) -> None:
        """Stops what has come back."""
        self._driven.rest(np.isfinite(self.held))
        self._pulls = False

    def tell(self, row: int, speed: float) -> None:
        """Notes what a joint is told: to stand still where it is, or to move at a speed [rad/s]."""
        self._say(slice(row, row + 1), speed)
        self.held[row] = self._driven.places[row] if speed == 0 else math.nan
        self._moves = bool(self.told[self._base :].any())

    def tell_base(self, speed: tuple[float, float, float]) -> None:
        """Notes what the base is told: to stand, to go straight, or to move (forward, left, turn) [m/s] [m/s] [rad/s]."""
        self._say(slice(3), speed)
        if speed == (0, 0, 0):
            self._let_be()
        here = self._driven.places
        self.held[:2] = here[:2] if speed == (0, 0, 0) else math.nan
        if speed[2] != 0:
            self.held[2] = math.nan
        elif math.isnan(self.held[2]):
            self.held[2] = here[2]

    def _say(self, rows: slice, speed: float | tuple[float, ...]) -> None:
        self._told_anew()
        self.told[rows] = speed
        self._driven.set_controls(speed, rows)

    def _told_anew(self) -> None:
        self._new, self._expected = True, None

    def stand(self, joint: str | None = None) -> None:
        """Holds the base, or a joint, where it has just been put, if it is told to stand still; others come back to where they stood."""
        row = None if joint is None else self.row(joint)
        if joint is not None and row is None:
            return
        self._told_anew()
        rows = slice(self._base) if row is None else slice(row, row + 1)
        self.held[rows] = np.where(np.isfinite(self.held[rows]), self._driven.places[rows], math.nan)

    def steady(self, row: int | None = None) -> bool:
        """Returns whether it, or the joint in a row, may have the speed that it is told at once: nothing touches it or has just
        pushed it, and the joint is in no loop."""
        return self.calm and (row is None or not self._driven.looped[row]) and self._body.free()

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

    @property
    def commanded(self) -> tuple[float, float, float]:
        """The speed (forward, left, turn) that the base is told to keep."""
        forward, left, turn = self.told[:3].tolist()
        return (forward, left, turn)

    def still(self) -> list[int]:
        """Returns the degrees of freedom of the joints that are told to stand still."""
        return self._driven.v[3:][self.told[3:] == 0].tolist()

    def state(self) -> tuple[Any, ...]:
        """Returns what it holds as plain values."""
        held = (None if at != at else at for at in self.held.tolist())
        return (tuple(self.told.tolist()), tuple(held), self.calm, self._struck, self._pulls)

    def restore(self, state: tuple[Any, ...]) -> None:
        """Brings that back."""
        self._told_anew()
        told, held, self.calm, self._struck, self._pulls = state
        self.told = np.array(told, dtype=np.float64)
        self.held = np.array([math.nan if at is None else at for at in held], dtype=np.float64)
        self._moves = bool(self.told[self._base :].any())
