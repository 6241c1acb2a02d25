"""Commands that take a while: they choose the speeds of each tick until they are done."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from actr3d.world.anatomy import Steering
from actr3d.world.base import Base
from actr3d.world.frames import wrapped
from actr3d.world.joints import Joint
from actr3d.world.physics import Physics
from actr3d.world.posture_hold import PostureHold

ARRIVAL_TOLERANCE = 3e-4
"""Distance below which a joint or the base is moved exactly to its target after a tick [m] or [rad]: greater than the error that other
limbs cause in a tick, and too small to be visible."""

MIN_PROGRESS = 0.01
"""Fraction of its commanded speed below which a movement counts as blocked. Source: chosen for this library."""

MAX_DIRECTION_ERROR = 0.1
"""Direction error above which a body that walks to a point stops and turns first [rad]. Source: chosen for this library."""

HEADING = "heading"
"""Key in `targets` of a turn of the base to a heading."""

TURN = "(turn)"
"""Key in `targets` of a turn of the base by an angle. Its target is a heading, too, but the whole angle is turned, not the shorter way."""


class MotionCommands:
    """Holds the unfinished commands of one body: joints to positions, a walk to a point, a brake.

    Before each tick they set the speeds for the whole tick. A movement has a constant speed; in its last tick the speed is the remaining
    distance divided by the length of the tick, so that the target is reached exactly at the end of a tick.

    Args:
        physics: The compiled scene and its state.
        root: The MuJoCo body that carries all others of the body.
        base: The base of the body.
        joints: The joints of the body by name.
        hold: Keeps the speeds that these commands choose.
        steering: How it is driven; None if it is not a vehicle.
        brake_control: Where the brake's control is in MuJoCo's `ctrl`; None without a brake.
    """

    def __init__(
        self,
        physics: Physics,
        root: int,
        base: Base,
        joints: Mapping[str, Joint],
        hold: PostureHold,
        steering: Steering | None,
        brake_control: slice | None,
    ) -> None:
        self._physics = physics
        self._root = root
        self._base = base
        self._joints = joints
        self._hold = hold
        self._steering = steering
        self._brake_control = brake_control
        self.targets: dict[str, tuple[float, float]] = {}
        """By joint, or `HEADING` or `TURN`: its target position and its speed, [rad] [rad/s]."""
        self.waypoint: tuple[float, float, float, float] | None = None
        """Where the body walks to: x, y, speed, speed of turning, [m] [m] [m/s] [rad/s]."""
        self.brake = 0.0
        """Position of the brake pedal, 0 to 1."""
        self._before = self._movements()
        """The movements at the start of the last step."""

    def __bool__(self) -> bool:
        return bool(self.targets) or self.waypoint is not None or self.brake > 0

    @property
    def under_way(self) -> bool:
        """Whether a movement with a target has not reached it yet, and still makes progress."""
        if not self.targets and self.waypoint is None:
            return False
        return self._before != self._movements() or self._base_moves() or any(self._joint_moves(name) for name in self.targets)

    def before_step(self, duration: float) -> None:
        """Sets the speeds for the next `duration` [s]."""
        self._before = self._movements()
        for name in tuple(self.targets):
            if name in (HEADING, TURN):
                self._turn(name, duration)
            else:
                self._move(name, duration)
        if self.waypoint is not None:
            self._walk(*self.waypoint, duration)
        if self.brake > 0:
            self._brake(duration)

    def after_step(self) -> None:
        """Ends the commands that have reached their targets: moves the body to them exactly, and stops it.

        A joint at its target keeps the target until all are at theirs: those that still move would push it away.
        """
        base = self._base
        there = [name for name in self.targets if self._finish_if_arrived(name)]
        if len(there) == len(self.targets):
            self.targets.clear()
        if self.waypoint is not None and math.dist(self.waypoint[:2], base.pose[:2]) <= ARRIVAL_TOLERANCE:
            x, y, _, _ = self.waypoint
            self.waypoint = None
            base.pose = (x, y, base.pose[2])
            self._hold.stand()
            self._hold.drive_base((0.0, 0.0, 0.0))

    def cancel_base_movements(self) -> None:
        """Ends the walk to a point and the turns of the base, because another command moves it now."""
        self.waypoint = None
        self.targets.pop(HEADING, None)
        self.targets.pop(TURN, None)

    def turning(self) -> float:
        """Returns the rest of a turn by an angle [rad]; 0 if there is none."""
        rest = self._rest(TURN) if TURN in self.targets else 0.0
        return rest if abs(rest) > ARRIVAL_TOLERANCE else 0.0

    def state(self) -> tuple[Any, ...]:
        """Returns all commands as plain values."""
        return (*self._movements(), self.brake, self._before)

    def restore(self, state: tuple[Any, ...]) -> None:
        """Restores commands that `state` returned."""
        targets, self.waypoint, self.brake, self._before = state
        self.targets = dict(targets)

    def _movements(self) -> tuple[Any, ...]:
        """Returns the commands of movements that have an end."""
        return (tuple(self.targets.items()), self.waypoint)

    def _base_moves(self) -> bool:
        """Returns whether the base is on its way to a point or a heading."""
        if self.waypoint is None and not {HEADING, TURN} & self.targets.keys():
            return False
        return math.hypot(*self._base.speed) > MIN_PROGRESS * math.hypot(*self._hold.base_command)

    def _joint_moves(self, name: str) -> bool:
        """Returns whether a joint is on its way to its target."""
        if name in (HEADING, TURN):
            return False
        joint = self._joints[name]
        rest, speed = abs(self.targets[name][0] - joint.position), self._hold.joint_speed(joint)
        return rest > ARRIVAL_TOLERANCE and abs(joint.velocity) > MIN_PROGRESS * abs(speed)

    def _finish_if_arrived(self, name: str) -> bool:
        """If a joint or the heading is at its target, moves it there exactly, stops it, and returns True."""
        base, hold = self._base, self._hold
        target, _ = self.targets[name]
        if name in (HEADING, TURN):
            x, y, heading = base.pose
            rest = self._rest(name)
            if abs(rest) <= ARRIVAL_TOLERANCE:
                base.pose = (x, y, heading + rest)
                hold.stand()
                hold.drive_base((*hold.base_command[:2], 0.0))
                return True
        elif abs(target - self._joints[name].position) <= ARRIVAL_TOLERANCE:
            self._joints[name].put(target)
            hold.stand(name)
            hold.drive_joint(self._joints[name], 0.0)
            return True
        return False

    def _move(self, name: str, duration: float) -> None:
        """Sets the speed of one joint."""
        joint = self._joints[name]
        target, speed = self.targets[name]
        self._hold.drive_joint(joint, _bounded((target - joint.position) / duration, speed))

    def _turn(self, name: str, duration: float) -> None:
        """Sets the turning speed of the base."""
        forward, left, _ = self._hold.base_command
        self._hold.drive_base((forward, left, _bounded(self._rest(name) / duration, self.targets[name][1])))

    def _rest(self, name: str) -> float:
        """Returns the rest of a turn of the base [rad]."""
        rest = self.targets[name][0] - self._base.pose[2]
        return rest if name == TURN else wrapped(rest)

    def _walk(self, x: float, y: float, speed: float, turn: float, duration: float) -> None:
        """Turns towards the point and walks straight to it."""
        at_x, at_y, heading = self._base.pose
        way = math.dist((x, y), (at_x, at_y))
        off = wrapped(math.atan2(y - at_y, x - at_x) - heading)
        # Near the point its direction means little, and turning to it would only swing the body.
        spin = _bounded(off / duration, turn) if way > speed * duration else 0.0
        pace = min(speed, way / duration) if spin == 0 or abs(off) < MAX_DIRECTION_ERROR else 0.0
        self._hold.drive_base((pace * math.cos(off), pace * math.sin(off), spin))

    def _brake(self, duration: float) -> None:
        """Brakes with the force of the pedal, at most with the force that stops the car within this tick."""
        assert self._steering is not None
        speed = self._base.speed[0]
        most = self.brake * self._steering.brake
        mass = float(self._physics.mj_model.body_subtreemass[self._root])
        self._physics.mj_data.ctrl[self._brake_control] = -_bounded(mass * speed / duration, most)


def _bounded(value: float, bound: float) -> float:
    return max(-bound, min(bound, value))
