"""The course of a run through time: on, back, and on again."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from actr3d.simulation.commands import Command, command_of
from actr3d.simulation.history import History
from actr3d.simulation.journal import Journal
from actr3d.simulation.lockstep import Lockstep
from actr3d.world import World


class Course:
    """Moves a run through its time, keeps what going back needs, and tells the journal what is new.

    After going back, what was known is lived through again with all its commands; a new command makes the run go
    another way from there.

    Args:
        world: The world, at its start.
        begin: Makes the minds, and joins them with the world.
        journal: Who is told of everything.
    """

    def __init__(self, world: World, begin: Callable[[], Lockstep], journal: Journal) -> None:
        self._world = world
        self._begin = begin
        self._journal = journal
        self._history = History(world.state())
        self._lockstep: Lockstep | None = None

    @property
    def begun(self) -> bool:
        """Whether the minds have been made."""
        return self._lockstep is not None

    @property
    def lockstep(self) -> Lockstep:
        """The present, whose minds are made where there are none yet.

        Raises:
            SimulationError: If a mind cannot be made.
        """
        if self._lockstep is None:
            self._lockstep = self._begin()
            self._journal.state(0, self._world)
        return self._lockstep

    @property
    def ticks(self) -> int:
        """How many whole ticks lie behind."""
        return 0 if self._lockstep is None else self._lockstep.ticks

    @property
    def furthest(self) -> int:
        """How many ticks the run has come at most."""
        return self._history.ticks

    # -- on

    def tick(self) -> None:
        """Repeats the commands that are known of this moment, and lets the minds think for one period.

        Raises:
            SimulationError: If the last tick has had no tock, or has failed.
            Exception: What a mind raises.
        """
        lockstep = self._lockstep or self.lockstep
        if lockstep.commands < len(self._history.commands):
            lockstep.repeat_commands(self._history.commands)
        lockstep.tick()

    def tock(self) -> None:
        """Does the physics of that tick, and keeps what is new.

        Raises:
            SimulationError: If there has been no tick before, or something has failed.
            Exception: What the world or a body raises.
        """
        lockstep, history = self.lockstep, self._history
        answers = lockstep.tock()
        ticks = lockstep.ticks
        if ticks > history.lived:
            history.add_tick(ticks, answers)
            if history.wants(ticks):
                history.keep(ticks, self._world.state())
        self._journal.state(ticks, self._world)

    def command(self, word: str, values: tuple[Any, ...], named: Mapping[str, Any], body: str | None) -> None:
        """Carries out something new that a user does; where the run has gone back, what came after is forgotten.

        Raises:
            SimulationError: If there is no such command or body, or a tick waits for its tock.
            Exception: What the world or the body raises; then nothing is forgotten.
        """
        lockstep, history = self.lockstep, self._history
        command, before = command_of(lockstep.ticks, word, values, named, body, self._world), lockstep.commands
        with self._journal.holding():
            lockstep.command(command)
            if lockstep.ticks < history.ticks or before < len(history.commands):
                history.cut(lockstep.ticks, before)
                self._journal.cut(lockstep.ticks, before)
            history.commands.append(command)
        lockstep.tell(command)
        self._journal.command(command)

    # -- what is known of it

    def plan(self, commands: Sequence[Command], ticks: int) -> None:
        """Takes the commands of an earlier run, and how far that came; this one has not begun."""
        self._history.commands[:] = commands
        self._history.ticks = ticks

    def forget_ahead(self) -> None:
        """Forgets that the run has been further than it is now; commands that were planned stay."""
        self._history.cut(self.ticks, len(self._history.commands))

    def repeat_commands(self) -> None:
        """Repeats the commands that are known of this moment, without going on.

        Raises:
            Exception: What the world or a body raises.
        """
        self.lockstep.repeat_commands(self._history.commands)

    # -- back

    def seek(self, to: int) -> None:
        """Goes to the end of a tick that is known, before the commands of that moment.

        Where it lies behind, the minds are made anew and live through what was before, with the answers that were kept; the
        world comes from a kept state.

        Raises:
            SimulationError: If the minds do something else than the first time.
        """
        present = self.lockstep
        if present.broken or to <= present.ticks:
            self._lockstep = None
            self._world.restore(self._history.before(0)[1])
        self._journal.silent = True
        try:
            self._live_through(to)
        finally:
            self._journal.silent = False

    def _live_through(self, to: int) -> None:
        history, lockstep = self._history, self.lockstep
        kept, state = history.before(to)
        if kept > lockstep.ticks:
            while lockstep.ticks < kept:
                lockstep.repeat_commands(history.commands, only_minds=True)
                lockstep.remember(history.answers(lockstep.ticks + 1))
            self._world.restore(state)
        while lockstep.ticks < to:
            self.tick()
            self.tock()
