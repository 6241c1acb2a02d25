"""Movements under way: what each tells the body, how it gets on, and how it ends."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from actr3d.motor.limbs import BASE_GROUP
from actr3d.world.sensors.motion import AT_LIMIT
from actr3d.world.sensors.proprioception import Proprioception

HELD = 0.25
"""A movement that makes less than this part of its way, and no more of it than before, does not advance: pressed joints give way by
about a tenth, and legs that something touches take some 0.2 s to get going. Ours."""

FASTER = 1.2
"""How many times more than before is more. Ours."""

INFINITE = float("inf")

Order = tuple[str, tuple[Any, ...], Mapping[str, Any]]
"""What the body is told: a word, its values, and more by name."""


class Step(NamedTuple):
    """What has happened since the body was last felt."""

    duration: float
    """How long that is [s]."""
    before: tuple[float, ...]
    """Where the joints were, in the order of the body [rad] or [m]."""
    reading: Proprioception
    """How the body stands now."""


class Movement:
    """One movement of one muscle group, at a constant speed.

    Args:
        name: What the modeller calls it, with the side if there is one.
        group: The muscle group.
        pace: How fast it is [rad/s] or [m/s].
        place: `file:line` where it was asked for.
    """

    base = False
    """Whether the legs carry it out."""

    def __init__(self, name: str, group: str, pace: float, place: str) -> None:
        self.name = name
        self.group = group
        self.pace = pace
        self.place = place
        self.begun = False
        """Whether the body has been told."""
        self._felt = False
        self._before = self._gone = self._time = 0.0

    def ended(self, step: Step, patience: float | None) -> str | None:
        """Returns how it has ended: «done», «limit», «blocked» or «stopped»; None while it goes on.

        Args:
            step: What has happened.
            patience: How long it may fail to advance [s]; None for ever.
        """
        end = self._arrived(step)
        if end is not None:
            return end
        if self._felt:  # of the first step, some may have been before it began
            self._gone += self._way(step)
            self._time += step.duration
        self._felt = True
        if patience is None or self._time < patience:
            return None
        slow = self._gone < HELD * self.pace * self._time and self._gone <= FASTER * self._before
        self._before, self._gone, self._time = self._gone, 0.0, 0.0
        if not slow:
            return None
        return "done" if self._rest(step) <= self.pace * step.duration else "blocked"

    def told(self) -> dict[str, Any]:
        """Returns what a trace keeps of it."""
        raise NotImplementedError

    def _arrived(self, step: Step) -> str | None:
        """Returns how it has ended, but for being blocked."""
        raise NotImplementedError

    def _way(self, step: Step) -> float:
        """Returns how far it has come in a step [rad] or [m]."""
        raise NotImplementedError

    def _rest(self, step: Step) -> float:
        """Returns how far it still has to go [rad] or [m]; who is as near as a tick's way, and weak, is there."""
        return INFINITE


class JointMovement(Movement):
    """Turns joints of one part.

    Args:
        name: What the modeller calls it.
        group: The muscle group.
        pace: How fast [rad/s] or [m/s].
        place: `file:line` where it was asked for.
        ways: By joint, where it goes [rad] or [m]; infinite where there is no end.
        order: The joints of the body in its order.
        to_limit: Whether it was to go on until its limit.
    """

    def __init__(
        self, name: str, group: str, pace: float, place: str, *, ways: Mapping[str, float], order: Sequence[str], to_limit: bool
    ) -> None:
        super().__init__(name, group, pace, place)
        self.ways = ways
        self.to_limit = to_limit
        self._number = {joint: order.index(joint) for joint in ways}
        self._left = set(ways)

    def begin(self) -> Iterable[Order]:
        """Yields what begins it. A limit in its way is where it goes to, so that it meets it exactly."""
        for joint, target in self.ways.items():
            if abs(target) < INFINITE:
                yield "position", (joint, target, self.pace), {}
            else:
                yield "joint", (joint, self.pace if target > 0 else -self.pace), {}

    def halt(self) -> Iterable[Order]:
        """Yields what ends it at once."""
        for joint in self.ways:
            yield "joint", (joint, 0.0), {}

    def told(self) -> dict[str, Any]:
        """Returns what a trace keeps of it."""
        ends = {joint: target if abs(target) < INFINITE else None for joint, target in self.ways.items()}
        return {"movement": self.name, "group": self.group, "to": ends, "speed": self.pace}

    def _arrived(self, step: Step) -> str | None:
        self._left.intersection_update(step.reading.moving)
        if self._left:
            return None
        if any(abs(step.reading.positions[self._number[joint]] - target) > AT_LIMIT for joint, target in self.ways.items()):
            return "stopped"  # by someone else, such as the user
        return "limit" if self.to_limit else "done"

    def _way(self, step: Step) -> float:
        before, now = step.before, step.reading.positions
        return max([abs(now[n] - before[n]) for n in (self._number[joint] for joint in self._left)])

    def _rest(self, step: Step) -> float:
        return max(abs(step.reading.positions[self._number[joint]] - self.ways[joint]) for joint in self._left)


class Walk(Movement):
    """Walks at a speed [m/s], backward where it is negative, until told to stop."""

    base = True

    def __init__(self, speed: float, place: str) -> None:
        super().__init__("walk", BASE_GROUP, abs(speed), place)
        self.speed = speed

    def told(self) -> dict[str, Any]:
        """Returns what a trace keeps of it."""
        return {"movement": self.name, "group": self.group, "speed": self.speed}

    def _arrived(self, step: Step) -> str | None:
        return None if step.reading.walking else "stopped"

    def _way(self, step: Step) -> float:
        return step.reading.speed[0] * step.duration * (1 if self.speed > 0 else -1)


class Turn(Movement):
    """Turns the whole body by an angle [rad, left is positive], or until told to stop at a rate [rad/s]."""

    base = True

    def __init__(self, angle: float | None, rate: float, place: str) -> None:
        super().__init__("turn", BASE_GROUP, abs(rate), place)
        self.rate = rate
        self.rest = angle
        """How far it still goes, as last felt; None for ever."""

    def told(self) -> dict[str, Any]:
        """Returns what a trace keeps of it."""
        return {"movement": self.name, "group": self.group, "speed": self.rate, **({} if self.rest is None else {"to": self.rest})}

    def _arrived(self, step: Step) -> str | None:
        if self.rest is None:
            return None if step.reading.walking else "stopped"
        before, self.rest = self.rest, step.reading.turning
        if self.rest:
            return None
        return "done" if not self._felt or abs(before) <= 1.5 * self.pace * step.duration else "stopped"

    def _way(self, step: Step) -> float:
        rest = self.rate if self.rest is None else self.rest
        return step.reading.speed[2] * step.duration * (1 if rest > 0 else -1)


def gait(walk: Walk | None, turn: Turn | None) -> Iterable[Order]:
    """Yields what makes the legs walk and turn so, and nothing else."""
    yield "walk", (walk.speed if walk else 0.0,), {"turn": turn.rate if turn and turn.rest is None else 0.0}
    if turn is not None and turn.rest is not None:
        yield "turn", (turn.rest, turn.pace), {}
