"""Commands that take a while: they choose the speeds of each tick until they are done."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from actr3d.world.body import Body

THERE = 3e-4
"""What is nearer to its target than this [m] or [rad] after a tick is put there exactly: more than what the pull of other limbs
makes its way in that tick miss the target by, and less than anyone sees."""

ASTRAY = 0.1
"""Who walks to a point and faces it worse than this [rad] stands while turning. Ours."""

HEADING = "heading"
"""What the base's turning to a heading is called among targets."""

TURN = "(turn)"
"""What its turning by an angle is called there: to a heading too, but as far round as was said, and not the shorter way."""


class Running:
    """Holds the commands of one body that are on their way: joints to positions, a walk to a point, a brake.

    Once before each tick they set the speeds for all of it. The speed is constant, and in the last tick it is the rest of
    the way over the tick, so that the end is reached exactly at a tick's end.
    """

    def __init__(self, body: Body) -> None:
        self._body = body
        self.targets: dict[str, tuple[float, float]] = {}
        """By joint, or `HEADING` or `TURN`: the position it goes to and its speed, [rad] [rad/s]."""
        self.waypoint: tuple[float, float, float, float] | None = None
        """Where the body walks: x, y, speed, speed of turning, [m] [m] [m/s] [rad/s]."""
        self.brake = 0.0
        """How far the brake is pressed, 0 to 1."""

    def __bool__(self) -> bool:
        return bool(self.targets) or self.waypoint is not None or self.brake > 0

    def before_step(self, duration: float) -> None:
        """Sets the speeds for the next `duration` [s]."""
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
        """Ends the commands that are done: puts what is there exactly there, and stops it.

        A joint that is there keeps its target until all are: those that still move would push it away from there.
        """
        body = self._body
        base = body.base
        there = [name for name in self.targets if self._arrived(name)]
        if len(there) == len(self.targets):
            self.targets.clear()
        if self.waypoint is not None and math.dist(self.waypoint[:2], base.place[:2]) <= THERE:
            x, y, _, _ = self.waypoint
            self.waypoint = None
            base.place = (x, y, base.place[2])
            body.holding.stand()
            base.drive((0.0, 0.0, 0.0), body)

    def turning(self) -> float:
        """Returns how far the base still turns, of the angle that it was told to turn by [rad]; 0 if it was not, or has."""
        rest = self._rest(TURN) if TURN in self.targets else 0.0
        return rest if abs(rest) > THERE else 0.0

    def state(self) -> tuple[Any, ...]:
        """Returns all commands as plain values."""
        return (tuple(self.targets.items()), self.waypoint, self.brake)

    def restore(self, state: tuple[Any, ...]) -> None:
        """Brings commands back."""
        targets, self.waypoint, self.brake = state
        self.targets = dict(targets)

    def _arrived(self, name: str) -> bool:
        """Returns whether a joint or the heading is at its target; then puts it exactly there and stops it."""
        body, base = self._body, self._body.base
        target, _ = self.targets[name]
        if name in (HEADING, TURN):
            x, y, heading = base.place
            rest = self._rest(name)
            if abs(rest) <= THERE:
                base.place = (x, y, heading + rest)
                body.holding.stand()
                base.drive((*body.holding.commanded[:2], 0.0), body)
                return True
        elif abs(target - body.joints[name].position) <= THERE:
            body.joints[name].put(target)
            body.holding.stand(name)
            body.joints[name].drive(0.0, body)
            return True
        return False

    def _move(self, name: str, duration: float) -> None:
        """Moves one joint on."""
        joint = self._body.joints[name]
        target, speed = self.targets[name]
        joint.drive(_bounded((target - joint.position) / duration, speed), self._body)

    def _turn(self, name: str, duration: float) -> None:
        """Turns the base on."""
        body, base = self._body, self._body.base
        forward, left, _ = body.holding.commanded
        base.drive((forward, left, _bounded(self._rest(name) / duration, self.targets[name][1])), body)

    def _rest(self, name: str) -> float:
        """Returns how far the base still has to turn [rad]."""
        rest = self.targets[name][0] - self._body.base.place[2]
        return rest if name == TURN else _wrapped(rest)

    def _walk(self, x: float, y: float, speed: float, turn: float, duration: float) -> None:
        """Turns towards the point and walks straight to it."""
        base = self._body.base
        at_x, at_y, heading = base.place
        way = math.dist((x, y), (at_x, at_y))
        off = _wrapped(math.atan2(y - at_y, x - at_x) - heading)
        # Near the point its direction means little, and turning to it would only swing the body.
        spin = _bounded(off / duration, turn) if way > speed * duration else 0.0
        pace = min(speed, way / duration) if spin == 0 or abs(off) < ASTRAY else 0.0
        base.drive((pace * math.cos(off), pace * math.sin(off), spin), self._body)

    def _brake(self, duration: float) -> None:
        """Holds back with what the pressed brake can, and with no more than stops the car in this tick."""
        body = self._body
        assert body.anatomy.steering is not None
        speed = body.base.speed[0]
        most = self.brake * body.anatomy.steering.brake
        mass = float(body.world.mj_model.body_subtreemass[body.root])
        body.world.mj_data.ctrl[body.control("brake")] = -_bounded(mass * speed / duration, most)


def _bounded(value: float, bound: float) -> float:
    return max(-bound, min(bound, value))


def _wrapped(angle: float) -> float:
    """Returns the same direction in -pi to pi [rad]."""
    return math.remainder(angle, 2 * math.pi)
