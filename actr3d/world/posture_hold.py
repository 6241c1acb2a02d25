"""Keeps a body at its commands: speeds while it moves, the positions of base and joints while it stands."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from actr3d.world.actuated_dofs import ActuatedDofs, Row
from actr3d.world.base import Base
from actr3d.world.contacts import BodyContacts
from actr3d.world.gait import STANCE, GaitCycle
from actr3d.world.joints import Joint
from actr3d.world.physics import Physics

SLIGHT_WAY, SLIGHT_SPEED = 1e-5, 1e-2
"""Deviations that need no correction: of position [m] [rad] and of speed [m/s] [rad/s]. Source: chosen for this library."""

YIELD = 1e-3
"""Distance by which contacts can push the base before it stays where it was pushed [m] [rad]. Source: chosen for this library."""

UNHINDERED, HINDERED = (0.02, 2.0), (0.1, 0.5)
"""Time constant of corrections [s] and their greatest speed [m/s] [rad/s], while nothing touches the body and while something does:
a fast correction against a wall would bounce off it. Source: chosen for this library."""


class PostureHold:
    """Keeps one body's base and joints at their commands, once before each tick.

    It corrects the effects of the body's own limbs: while nothing touches the body, speeds are as commanded, and joints that are commanded
    to stand return to where they stood. In contact, only the servos act. Their force is limited, so a stronger push moves the body;
    afterwards limbs return when they can, and the base stays where it was pushed.

    Args:
        physics: The compiled scene and its state.
        members: (nbody,) by MuJoCo body: whether it is part of the body.
        dofs: The actuated degrees of freedom of the body.
        base: The base of the body.
        contacts: The contacts of the body.
        gait: How it walks; None if it glides.
    """

    def __init__(
        self,
        physics: Physics,
        members: NDArray[np.bool_],
        dofs: ActuatedDofs,
        base: Base,
        contacts: BodyContacts,
        gait: GaitCycle | None = None,
    ) -> None:
        self._physics = physics
        self._members = members
        self._dofs = dofs
        self._base = base
        self._contacts = contacts
        self._gait = gait
        self._trunk = [self._dofs.joints.get(joint) for joint in (STANCE, "torso_yaw")]
        self._rows = dofs.base
        self.commanded: Row = np.zeros(len(dofs.q))
        """The commanded speeds of base and joints, in the rows of `ActuatedDofs`."""
        self.held: Row = dofs.positions
        """The places to hold; NaN where it is commanded to move."""
        self.calm = True
        """Whether nothing has touched it since its base last had the commanded speed."""
        self._struck = False
        """Whether something has touched it since the last tick began."""
        self._pulls = False
        """Whether the last tick made a correction."""
        self._moves = False
        """Whether any joint is commanded to move."""

    def row(self, joint: str) -> int | None:
        """Returns the row of a joint; None if it has no servo that this class controls."""
        return self._dofs.joints.get(joint)

    @property
    def added_by_gait(self) -> tuple[Sequence[str], Row]:
        """The joints that gait moves, and by how much it has moved each from the position at which it was commanded to stop [rad] [m]: an
        array that stays up to date."""
        return ((), np.zeros(0)) if self._gait is None else (self._gait.joints, self._gait.added)

    # -- commands

    def joint_speed(self, joint: Joint) -> float:
        """Returns the commanded speed of a joint [rad/s]; 0 if it is not actuated."""
        row = self.row(joint.name)
        return joint.control if row is None else float(self.commanded[row])

    def drive_joint(self, joint: Joint, speed: float) -> None:
        """Commands a joint to keep a speed [rad/s].

        It stops at once. It starts at once if nothing touches the body and both hands do not hold one load with it; otherwise its
        servo accelerates it, so that no command can press a limb into a wall, or throw the body about.

        Raises:
            WorldError: If no servo moves it, and the speed is not 0.
        """
        if self.joint_speed(joint) == speed:
            return
        row = self.row(joint.name)
        if row is None:
            joint.control = speed
        else:
            self._command(slice(row, row + 1), speed)
            self.held[row] = self._dofs.positions[row] if speed == 0 else math.nan
            self._moves = bool(self.commanded[self._rows :].any())
        if speed == 0:
            self._halt([joint.v])
        elif self._may_start(row):
            joint.velocity = speed

    @property
    def base_command(self) -> tuple[float, float, float]:
        """The commanded speed of the base: forward, left, turn [m/s] [m/s] [rad/s]."""
        forward, left, turn = self.commanded[:3].tolist()
        return (forward, left, turn)

    def drive_base(self, speed: tuple[float, float, float]) -> None:
        """Commands the base to keep a speed (forward, left, turn), with the rules of `drive_joint`.

        When it stops, the joints that are commanded to stand stop with it: a contact may have turned them at the speed of the base, and a
        limb that continued to move would hit the obstacle.
        """
        if speed == self.base_command:
            return
        self._command(slice(3), speed)
        if speed == (0, 0, 0):
            self._end_correction()
        here = self._dofs.positions
        self.held[:2] = here[:2] if speed == (0, 0, 0) else math.nan
        if speed[2] != 0:
            self.held[2] = math.nan
        elif math.isnan(self.held[2]):
            self.held[2] = here[2]
        if speed == (0, 0, 0):
            v = self._base.v
            self._halt([v, v + 1, v + 2, *self._dofs.v[3:][self.commanded[3:] == 0].tolist()])
        elif self._may_start():
            self._base.speed = speed

    def stand(self, joint: str | None = None) -> None:
        """Holds the base, or a joint, at its present place if it is commanded to stand; used after it was moved at once."""
        row = None if joint is None else self.row(joint)
        if joint is not None and row is None:
            return
        rows = slice(self._rows) if row is None else slice(row, row + 1)
        self.held[rows] = np.where(np.isfinite(self.held[rows]), self._dofs.positions[rows], math.nan)

    def _command(self, rows: slice, speed: float | tuple[float, ...]) -> None:
        self.commanded[rows] = speed
        self._dofs.set_controls(speed, rows)

    def _may_start(self, row: int | None = None) -> bool:
        """Returns whether the base, or the joint in a row, may reach its commanded speed at once: nothing touches the body or has
        just pushed it, and the joint is in no loop."""
        return self.calm and (row is None or not self._dofs.looped[row]) and self._contacts.none()

    def _halt(self, dofs: list[int]) -> None:
        """Stops degrees of freedom at once.

        If other joints move, this can increase the kinetic energy of the body; then all its speeds are reduced, so that the energy stays
        the same.
        """
        self._physics.refresh_inertia()  # otherwise it would matter whether somebody has looked at this state
        model, data = self._physics.mj_model, self._physics.mj_data
        product = np.zeros(model.nv)
        mujoco.mj_mulM(model, data, product, data.qvel)
        before = float(data.qvel @ product)
        data.qvel[dofs] = 0
        mujoco.mj_mulM(model, data, product, data.qvel)
        after = float(data.qvel @ product)
        if after > before > 0:
            own = self._members[model.dof_bodyid]
            data.qvel[own] *= np.sqrt(before / after)

    # -- once a tick

    def before_step(self, duration: float) -> None:
        """Corrects deviations, for the next `duration` [s]."""
        if self._moves and self._loop_moves():  # which moves standing joints too: they hold their present places
            stand = self._dofs.looped & np.isfinite(self.held)
            self.held[stand] = self._dofs.positions[stand]
        held = self.held if self._gait is None else self._walk(self._gait, duration)
        deviations = self._dofs.deviations(held, self.commanded, duration if self._moves else 0.0, SLIGHT_WAY, SLIGHT_SPEED)
        if deviations is None:
            self.calm, self._struck = not self._struck, False
            if self.calm and self._pulls:
                self._end_correction()
        else:
            self._correct(*deviations)

    def _walk(self, gait: GaitCycle, duration: float) -> Row:
        """Moves the places that standing joints hold as the gait does, for the next `duration` [s], and commands the speeds for it.

        Returns:
            The places to hold; NaN for what moves, also by the gait.
        """
        dofs = self._dofs
        forward, left, _ = self.base_command
        stance, torso = (0.0 if row is None else dofs.position(row) for row in self._trunk)
        changes = gait.advance(forward, left, stance, torso, self.held, duration)
        held = self.held.copy()
        if dofs.shift_held(gait.rows, changes, self.held, self.commanded, held, duration):
            self._moves = bool(self.commanded[self._rows :].any())
        return held

    def after_part(self) -> None:
        """Notes whether anything touches the body in the physics step just made, which had contacts."""
        if not self._struck:
            self._struck = self._contacts.any_in_step()

    def strike(self) -> None:
        """Records that a user pushes the body: as in contact, only the servos resist, with their limited force."""
        self._struck = True

    def _correct(self, ways: Row, off: Row, wanted: Row) -> None:
        """Corrects deviations of position and speed; see `ActuatedDofs.deviations`."""
        dofs = self._dofs
        self._pulls = True
        free = not self._struck and self._contacts.none()
        self.calm = free and (self.calm or float(np.abs(off[: self._rows]).max(initial=0.0)) <= SLIGHT_SPEED)
        self._struck = False
        if self.calm:
            time, most = UNHINDERED
            dofs.apply_corrections(ways, wanted, time, most, SLIGHT_SPEED, loops=not self._loop_moves())
        else:
            # The place to which the base was pushed is accepted, except for slight deviations.
            ways[: self._rows] = np.clip(ways[: self._rows], -YIELD, YIELD)
            self.held[: self._rows] = dofs.positions[: self._rows] + ways[: self._rows]
            self._push(ways, wanted)

    def _push(self, ways: Row, wanted: Row) -> None:
        """Sets the servos so that they push towards the needed speeds: adds the speed that the load has taken away, up to the servos'
        limits."""
        dofs, (time, most) = self._dofs, HINDERED
        back = dofs.along_base(np.clip(ways / time, -most, most))
        speeds, band = dofs.speeds, dofs.band
        more = np.clip(dofs.controls - speeds + back - speeds, -band, band)
        dofs.set_controls(np.where(np.isfinite(back), speeds + more, wanted))

    def _loop_moves(self) -> bool:
        return self._dofs.loops and bool(np.isnan(self.held[self._dofs.looped]).any())

    def _end_correction(self) -> None:
        """Stops what has returned to its place."""
        self._dofs.rest(np.isfinite(self.held) & (self.commanded == 0))
        self._pulls = False

    # -- the state

    def state(self) -> tuple[Any, ...]:
        """Returns the commands and the correction in progress as plain values."""
        held = (None if at != at else at for at in self.held.tolist())
        gait = () if self._gait is None else (self._gait.state(),)
        return (tuple(self.commanded.tolist()), tuple(held), self.calm, self._struck, self._pulls, *gait)

    def restore(self, state: tuple[Any, ...]) -> None:
        """Restores a state that `state` returned."""
        commanded, held, self.calm, self._struck, self._pulls, *gait = state
        if self._gait is not None:
            self._gait.restore(*gait)
        self.commanded = np.array(commanded, dtype=np.float64)
        self.held = np.array([math.nan if at is None else at for at in held], dtype=np.float64)
        self._moves = bool(self.commanded[self._rows :].any())
