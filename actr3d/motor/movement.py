"""Movements in progress: their commands to the body, their progress and their end."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from actr3d.actr.modules.port import CallSite
from actr3d.motor.limbs import BASE_GROUP
from actr3d.world.sensors.motion import AT_LIMIT
from actr3d.world.sensors.proprioception import Proprioception

HELD = 0.25
"""A movement makes no progress if, during `patience`, it covers less than this fraction of the distance at its commanded speed, and not
clearly more than in the period before. Joints that press against something yield by about a tenth; legs in contact with something need
about 0.2 s to start. Source: chosen for this library."""

FASTER = 1.2
"""Factor above which progress counts as more than before. Source: chosen for this library."""

INFINITE = float("inf")

Order = tuple[str, tuple[Any, ...], Mapping[str, Any]]
"""A command to the body: its name, its values, and more values by name."""


class Step(NamedTuple):
    """Changes since the last reading of the body."""

    duration: float
    """Time since then [s]."""
    before: tuple[float, ...]
    """Former positions of the joints, in the order of the body [rad] or [m]."""
    reading: Proprioception
    """The present reading."""


class Movement:
    """One movement of one muscle group, at a constant speed.

    Args:
        name: Its name in the command, with the side if there is one.
        group: The muscle group.
        site: The line of the modeller's code that gives the command.
    """

    def __init__(self, name: str, group: str, site: CallSite | None) -> None:
        self.name = name
        self.group = group
        self.site = site
        self.begun = False
        """Whether the body has received the command."""
        self._felt = False
        self._before = self._gone = self._time = 0.0

    def ended(self, step: Step, patience: float | None) -> str | None:
        """Returns how it has ended: «done», «limit», «blocked» or «stopped»; None while it continues.

        Args:
            step: Changes since the last reading.
            patience: Time without progress after which it is blocked [s]; None for never.
        """
        end = self._arrived(step)
        if end is not None:
            return end
        if self._felt:  # it may have begun within the first step
            self._gone += self._progress(step)
            self._time += step.duration
        self._felt = True
        if patience is None or self._time < patience:
            return None
        slow = self._gone < HELD * self._time and self._gone <= FASTER * self._before
        self._before, self._gone, self._time = self._gone, 0.0, 0.0
        if not slow:
            return None
        return "done" if self._remaining(step) <= step.duration else "blocked"

    def trace_data(self) -> dict[str, Any]:
        """Returns its data for the trace."""
        raise NotImplementedError

    def _arrived(self, step: Step) -> str | None:
        """Returns how it has ended, except «blocked»."""
        raise NotImplementedError

    def _progress(self, step: Step) -> float:
        """Returns the time that the distance moved in a step takes at its speed [s]."""
        raise NotImplementedError

    def _remaining(self, step: Step) -> float:
        """Returns the time that the remaining distance takes at its speed [s]; a blocked movement counts as done within one step."""
        return INFINITE


class JointMovement(Movement):
    """Turns joints of one part.

    Args:
        name: Its name in the command.
        group: The muscle group.
        paces: By joint, its speed [rad/s] or [m/s].
        site: The line of the modeller's code that gives the command.
        targets: By joint, its target [rad] or [m]; infinite without an end.
        order: The joints of the body in its order.
        to_limit: Whether the target is its limit.
    """

    def __init__(
        self,
        name: str,
        group: str,
        paces: Mapping[str, float],
        site: CallSite | None,
        *,
        targets: Mapping[str, float],
        order: Sequence[str],
        to_limit: bool,
    ) -> None:
        super().__init__(name, group, site)
        self.paces = paces
        self.targets = targets
        self.to_limit = to_limit
        self._number = {joint: order.index(joint) for joint in targets}
        self._left = set(targets)

    def begin(self) -> Iterable[Order]:
        """Yields the commands that begin it. A movement towards a limit has the limit as its target, and reaches it exactly."""
        for joint, target in self.targets.items():
            if abs(target) < INFINITE:
                yield "position", (joint, target, self.paces[joint]), {}
            else:
                yield "joint", (joint, math.copysign(self.paces[joint], target)), {}

    def halt(self) -> Iterable[Order]:
        """Yields the commands that end it at once."""
        for joint in self.targets:
            yield "joint", (joint, 0.0), {}

    def trace_data(self) -> dict[str, Any]:
        """Returns its data for the trace."""
        ends = {joint: target if abs(target) < INFINITE else None for joint, target in self.targets.items()}
        return {"movement": self.name, "group": self.group, "to": ends, "speed": next(iter(self.paces.values()))}

    def _arrived(self, step: Step) -> str | None:
        self._left.intersection_update(step.reading.moving)
        if self._left:
            return None
        if any(abs(step.reading.positions[self._number[joint]] - target) > AT_LIMIT for joint, target in self.targets.items()):
            return "stopped"  # by another command, such as the user's
        return "limit" if self.to_limit else "done"

    def _progress(self, step: Step) -> float:
        before, now = step.before, step.reading.positions
        return max([abs(now[n] - before[n]) / self.paces[joint] for joint, n in self._number.items() if joint in self._left])

    def _remaining(self, step: Step) -> float:
        at = step.reading.positions
        return max(abs(at[self._number[joint]] - self.targets[joint]) / self.paces[joint] for joint in self._left)


class Walk(Movement):
    """Walks at a speed [m/s], backward if negative, until it is stopped."""

    def __init__(self, speed: float, site: CallSite | None) -> None:
        super().__init__("walk", BASE_GROUP, site)
        self.speed = speed

    def trace_data(self) -> dict[str, Any]:
        """Returns its data for the trace."""
        return {"movement": self.name, "group": self.group, "speed": self.speed}

    def _arrived(self, step: Step) -> str | None:
        return None if step.reading.walking else "stopped"

    def _progress(self, step: Step) -> float:
        return step.reading.speed[0] / self.speed * step.duration


class Turn(Movement):
    """Turns the whole body by an angle [rad, left is positive], or without an end at a rate [rad/s]."""

    def __init__(self, angle: float | None, rate: float, site: CallSite | None) -> None:
        super().__init__("turn", BASE_GROUP, site)
        self.rate = rate
        self.rest = angle
        """Rest of the angle at the last reading [rad]; None without an end."""

    def trace_data(self) -> dict[str, Any]:
        """Returns its data for the trace."""
        return {"movement": self.name, "group": self.group, "speed": self.rate, **({} if self.rest is None else {"to": self.rest})}

    def _arrived(self, step: Step) -> str | None:
        if self.rest is None:
            return None if step.reading.walking else "stopped"
        before, self.rest = self.rest, step.reading.turning
        if self.rest:
            return None
        return "done" if not self._felt or abs(before) <= 1.5 * abs(self.rate) * step.duration else "stopped"

    def _progress(self, step: Step) -> float:
        rate = self.rate if self.rest is None else math.copysign(self.rate, self.rest)
        return step.reading.speed[2] / rate * step.duration


def gait(walk: Walk | None, turn: Turn | None) -> Iterable[Order]:
    """Yields the commands that make the legs do exactly this walk and this turn."""
    yield "walk", (walk.speed if walk else 0.0,), {"turn": turn.rate if turn and turn.rest is None else 0.0}
    if turn is not None and turn.rest is not None:
        yield "turn", (turn.rest, abs(turn.rate)), {}
