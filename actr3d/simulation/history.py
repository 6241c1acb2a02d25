"""What a simulation keeps of its past, to go back to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from actr3d.simulation.commands import Command
from actr3d.world import World, WorldState

SPACING = 50
"""How many ticks lie between two kept states at first."""
MOST_STATES = 256
"""Of more kept states every second one is dropped, so that a long run needs no more memory than a short one."""
MOST_ANSWERS = 10_000
"""How many answers are kept, from the start of the run on: 100 s of looking each 10 ms. Beyond them the physics is
simulated anew where a run goes back."""


@dataclass(frozen=True, slots=True)
class Moment:
    """The physical side at the end of a tick."""

    tick: int
    world: WorldState
    bodies: Mapping[str, Any]
    """What each body's `state()` is."""

    @classmethod
    def of(cls, tick: int, world: World) -> Moment:
        """Returns the present moment."""
        return cls(tick, world.state(), {name: body.state() for name, body in world.bodies.items()})

    def bring_back(self, world: World) -> None:
        """Makes this moment the present."""
        world.restore(self.world)
        for name, state in self.bodies.items():
            world.bodies[name].restore(state)


class History:
    """Keeps every command, the first answers of the bodies, and now and then a moment.

    Args:
        start: The first moment.
    """

    def __init__(self, start: Moment) -> None:
        self.commands: list[Command] = []
        self.ticks = 0
        """How far the run has come."""
        self.answered = 0
        """Up to which tick every answer is kept."""
        self._answers: dict[int, tuple[Any, ...]] = {}
        self._kept = 0
        self._spacing = SPACING
        self._moments: dict[int, Moment] = {0: start}

    def wants(self, tick: int) -> bool:
        """Tells whether the moment at the end of a tick is to be kept."""
        return tick % self._spacing == 0

    def keep(self, moment: Moment) -> None:
        """Keeps a moment."""
        self._moments[moment.tick] = moment
        if len(self._moments) > MOST_STATES:
            self._spacing *= 2
            self._moments = {tick: kept for tick, kept in self._moments.items() if tick % self._spacing == 0}

    def add_tick(self, tick: int, answers: tuple[Any, ...]) -> None:
        """Takes in one more tick, and what the bodies answered at its end."""
        self.ticks = tick
        if self.answered == tick - 1 and self._kept + len(answers) <= MOST_ANSWERS:
            self.answered = tick
            if answers:
                self._answers[tick] = answers
                self._kept += len(answers)

    def answers(self, tick: int) -> tuple[Any, ...]:
        """Returns what the bodies answered at the end of a tick up to `answered`."""
        return self._answers.get(tick, ())

    def before(self, tick: int) -> Moment:
        """Returns the last kept moment that a run can go to without its physics, up to a tick."""
        return self._moments[max(known for known in self._moments if known <= min(tick, self.answered))]

    def cut(self, tick: int, commands: int) -> None:
        """Forgets what was after a tick, and all commands but the first few."""
        del self.commands[commands:]
        self.ticks = tick
        self.answered = min(self.answered, tick)
        self._moments = {known: moment for known, moment in self._moments.items() if known <= tick}
        for known in [known for known in self._answers if known > tick]:
            self._kept -= len(self._answers.pop(known))
