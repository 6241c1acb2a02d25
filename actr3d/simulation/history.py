"""What a simulation keeps of its past, to go back to."""

from __future__ import annotations

from typing import Any

from actr3d.simulation.commands import Command
from actr3d.world import WorldState

SPACING = 50
"""How many ticks lie between two kept states at first."""
MOST_STATES = 256
"""Of more kept states every second one is dropped, so that a long run needs no more memory than a short one."""
MOST_ANSWERS = 10_000
"""How many answers are kept, from the start of the run on: 100 s of looking each 10 ms. Beyond them the physics is
simulated anew where a run goes back."""


class History:
    """Keeps every command, the first answers of the bodies, and now and then a state.

    Args:
        start: The state at the start.
    """

    def __init__(self, start: WorldState) -> None:
        self.commands: list[Command] = []
        self.ticks = 0
        """How far the run has come, also in an earlier life of it that is only known from a recording."""
        self.lived = 0
        """How far it has come here: up to this tick states are kept."""
        self.answered = 0
        """Up to which tick every answer is kept."""
        self._answers: dict[int, tuple[Any, ...]] = {}
        self._kept = 0
        self._spacing = SPACING
        self._states: dict[int, WorldState] = {0: start}

    def wants(self, tick: int) -> bool:
        """Tells whether the state at the end of a tick is to be kept."""
        return tick % self._spacing == 0

    def keep(self, tick: int, state: WorldState) -> None:
        """Keeps the state at the end of a tick."""
        self._states[tick] = state
        if len(self._states) > MOST_STATES:
            self._spacing *= 2
            self._states = {tick: kept for tick, kept in self._states.items() if tick % self._spacing == 0}

    def add_tick(self, tick: int, answers: tuple[Any, ...]) -> None:
        """Takes in one more tick, and what the bodies answered at its end."""
        self.lived = tick
        self.ticks = max(self.ticks, tick)
        if self.answered == tick - 1 and self._kept + len(answers) <= MOST_ANSWERS:
            self.answered = tick
            if answers:
                self._answers[tick] = answers
                self._kept += len(answers)

    def answers(self, tick: int) -> tuple[Any, ...]:
        """Returns what the bodies answered at the end of a tick up to `answered`."""
        return self._answers.get(tick, ())

    def before(self, tick: int) -> tuple[int, WorldState]:
        """Returns the last kept state that a run can go to without its physics, up to a tick, and its tick."""
        last = max(known for known in self._states if known <= min(tick, self.answered))
        return last, self._states[last]

    def cut(self, tick: int, commands: int) -> None:
        """Forgets what was after a tick, and all commands but the first few."""
        del self.commands[commands:]
        self.ticks = tick
        self.lived = min(self.lived, tick)
        self.answered = min(self.answered, tick)
        self._states = {known: state for known, state in self._states.items() if known <= tick}
        for known in [known for known in self._answers if known > tick]:
            self._kept -= len(self._answers.pop(known))
