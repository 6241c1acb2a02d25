"""The timeline of a run: forward, back, and forward again."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping, Sequence
from itertools import islice, zip_longest
from typing import Any

from actr3d.clock import seconds
from actr3d.errors import SimulationError
from actr3d.simulation.commands import Command, command_of
from actr3d.simulation.event_log import EventLog
from actr3d.simulation.lockstep import Lockstep
from actr3d.trace import Trace, TraceEvent
from actr3d.values import shortened
from actr3d.world import World, WorldState

SHOWN = 120
"""Greatest length of an event in an error [characters]."""
SPACING = 50
"""Ticks between two stored states at first."""
MAX_STATES = 256
"""Greatest number of stored states; beyond it every second one is dropped, so that a long run needs no more memory than a short one."""
MAX_ANSWERS = 10_000
"""Greatest number of stored answers, from the start of the run on: 100 s with one view each 10 ms. Beyond them the physics is
simulated again when a run goes back."""


class History:
    """Stores every command, the first answers of the bodies, and a state at intervals.

    Args:
        start: The state at the start.
    """

    def __init__(self, start: WorldState) -> None:
        self.commands: list[Command] = []
        self.ticks = 0
        """Length of the run in ticks, including ticks that are only known from a recording."""
        self.simulated = 0
        """Last tick that ran here; up to it states are stored."""
        self.answered = 0
        """Last tick up to which every answer is stored."""
        self._answers: dict[int, tuple[Any, ...]] = {}
        self._kept = 0
        self._spacing = SPACING
        self._states: dict[int, WorldState] = {0: start}
        self._events = array("q")
        """The number of traced events at the end of each tick from `_counted_from` on; an untraced run needs no memory for it."""
        self._counted_from = 1
        self._counted: tuple[str, bool] | None = None
        """The level of the trace in which they were counted, and whether it keeps events; None for no trace."""

    def wants(self, tick: int) -> bool:
        """Returns whether to store the state at the end of a tick."""
        return tick % self._spacing == 0

    def keep(self, tick: int, state: WorldState) -> None:
        """Stores the state at the end of a tick."""
        self._states[tick] = state
        if len(self._states) > MAX_STATES:
            self._spacing *= 2
            self._states = {tick: kept for tick, kept in self._states.items() if tick % self._spacing == 0}

    def add_tick(self, tick: int, answers: tuple[Any, ...], trace: Trace | None) -> None:
        """Adds a tick, with the answers of the bodies at its end, and the trace up to there."""
        self.simulated = tick
        if trace is None:
            self._counted = None
        else:
            counted = trace.level, trace.keep
            if counted != self._counted or tick != self._counted_from + len(self._events):
                self._counted, self._counted_from, self._events = counted, tick, array("q")
            self._events.append(len(trace))
        self.ticks = max(self.ticks, tick)
        if self.answered == tick - 1 and self._kept + len(answers) <= MAX_ANSWERS:
            self.answered = tick
            if answers:
                self._answers[tick] = answers
                self._kept += len(answers)

    def answers(self, tick: int) -> tuple[Any, ...]:
        """Returns the answers of the bodies at the end of a tick up to `answered`."""
        return self._answers.get(tick, ())

    def events(self, tick: int, trace: Trace) -> int | None:
        """Returns the number of events of a trace up to the end of a tick; None if they were not counted in a trace of its level."""
        place = tick - self._counted_from
        is_known = (trace.level, trace.keep) == self._counted and 0 <= place < len(self._events) and tick <= self.simulated
        return self._events[place] if is_known else None

    def before(self, tick: int) -> tuple[int, WorldState]:
        """Returns the tick of the last stored state that is at most at `tick` and at `answered`, and the state.

        Up to `answered`, the agents can repeat the run without physics.
        """
        last = max(known for known in self._states if known <= min(tick, self.answered))
        return last, self._states[last]

    def cut(self, tick: int, commands: int) -> None:
        """Forgets what was after a tick, and all but the first `commands`."""
        del self.commands[commands:]
        self.ticks = tick
        self.simulated = min(self.simulated, tick)
        self.answered = min(self.answered, tick)
        self._states = {known: state for known, state in self._states.items() if known <= tick}
        del self._events[max(0, tick + 1 - self._counted_from) :]
        for known in [known for known in self._answers if known > tick]:
            self._kept -= len(self._answers.pop(known))


class Timeline:
    """Moves a run through its time, stores what is needed to go back, and reports what is new to the event log.

    After going back, known ticks run again with all their commands; a new command starts another future from there.

    Args:
        world: The world, at its start.
        begin: Makes the agents, and connects them to the world.
        log: Receives everything that happens.
    """

    def __init__(self, world: World, begin: Callable[[], Lockstep], log: EventLog) -> None:
        self._world = world
        self._begin = begin
        self._log = log
        self._history = History(world.state())
        self._lockstep: Lockstep | None = None
        self._beginning = False
        """Whether the agents are being made."""

    @property
    def begun(self) -> bool:
        """Whether the agents have been made."""
        return self._lockstep is not None

    @property
    def lockstep(self) -> Lockstep:
        """The present; makes the agents if there are none yet.

        Raises:
            SimulationError: If an agent cannot be made, or the function that makes one asks for the present.
        """
        if self._lockstep is None:
            if self._beginning:
                raise SimulationError("a function that makes an agent cannot use the agents, or run or change the simulation")
            self._beginning = True
            try:
                self._lockstep = self._begin()
            finally:
                self._beginning = False
            self._log.state(0)
        return self._lockstep

    @property
    def running(self) -> bool:
        """Whether agents or bodies are doing something at this moment."""
        return self._lockstep is not None and self._lockstep.running

    @property
    def ticks(self) -> int:
        """Number of completed ticks up to the present."""
        return 0 if self._lockstep is None else self._lockstep.ticks

    @property
    def furthest(self) -> int:
        """Length of the run in ticks, also after it went back."""
        return self._history.ticks

    @property
    def commands(self) -> Sequence[Command]:
        """The commands of users that were carried out up to the present."""
        return [] if self._lockstep is None else self._history.commands[: self._lockstep.commands]

    # -- forward

    def tick(self) -> None:
        """Repeats the known commands of this moment, and runs the agents for one period.

        Raises:
            SimulationError: If the last tick has had no tock, or has failed.
            Exception: What an agent raises.
        """
        lockstep = self._lockstep or self.lockstep
        if lockstep.commands < len(self._history.commands):
            lockstep.repeat_commands(self._history.commands)
        lockstep.tick()

    def tock(self) -> None:
        """Simulates the physics of that tick, and stores what is new.

        Raises:
            SimulationError: If there has been no tick before, or something has failed.
            Exception: What the world or a body raises.
        """
        lockstep, history = self.lockstep, self._history
        answers = lockstep.tock()
        ticks = lockstep.ticks
        if ticks > history.simulated:
            history.add_tick(ticks, answers, self._log.trace)
            if history.wants(ticks):
                history.keep(ticks, self._world.state())
        self._log.state(ticks)

    def command(self, word: str, values: Sequence[Any], named: Mapping[str, Any], body: str | None, by: str | None) -> None:
        """Carries out a new command of a user; after the run went back, its former future is forgotten.

        Raises:
            SimulationError: If there is no such command or body, or a tick waits for its tock.
            Exception: What the world or the body raises; then nothing is forgotten.
        """
        lockstep, history = self.lockstep, self._history
        command, before = command_of(lockstep.ticks, word, values, named, body, by, self._world), lockstep.commands
        with self._log.holding():
            lockstep.command(command)
            if lockstep.ticks < history.ticks or before < len(history.commands):
                history.cut(lockstep.ticks, before)
                self._log.cut(lockstep.ticks, before)
            history.commands.append(command)
        lockstep.trace_command(command)
        self._log.command(command)

    @property
    def latest(self) -> Command | None:
        """The last known command up to the present moment, even if it has not been repeated here yet; None if there is none."""
        return next((command for command in reversed(self._history.commands) if command.tick <= self.ticks), None)

    def undo(self) -> None:
        """Goes to the moment of the latest command, before it, and forgets this command and what came after it.

        Raises:
            SimulationError: If there is no command up to the present, or as `seek` does.
        """
        known = [command for command in self._history.commands if command.tick <= self.ticks]
        if not known:
            raise SimulationError(f"undo: there is no command up to {seconds(self.lockstep.agents.time):g} s")
        *kept, latest = known
        self.seek(latest.tick)
        self.lockstep.repeat_commands(kept)
        self._history.cut(latest.tick, len(kept))
        self._log.cut(latest.tick, len(kept))

    # -- known commands

    def plan(self, commands: Sequence[Command], ticks: int) -> None:
        """Sets the commands of an earlier run, and its length in ticks; this run has not begun."""
        self._history.commands[:] = commands
        self._history.ticks = ticks

    def forget_ahead(self) -> None:
        """Forgets that the run has been further than it is now; planned commands stay."""
        self._history.cut(self.ticks, len(self._history.commands))

    def repeat_commands(self) -> None:
        """Repeats the known commands of this moment, without a tick.

        Raises:
            Exception: What the world or a body raises.
        """
        self.lockstep.repeat_commands(self._history.commands)

    # -- back

    def seek(self, to: int) -> None:
        """Goes to the end of a known tick, before the commands of that moment.

        To go back, the agents are made again and repeat what was before, with the stored answers; the world comes from a stored
        state.

        Raises:
            SimulationError: If the agents act differently than the first time, as far as the trace shows it.
        """
        present, before = self.lockstep, self._log.trace
        if present.broken or to <= present.ticks:
            self._lockstep = None
            self._world.restore(self._history.before(0)[1])
        self._log.silent = True
        try:
            self._repeat(to)
        finally:
            self._log.silent = False
        if before is not None and self._log.trace is not None and before is not self._log.trace:
            try:
                _check_repeated(before, self._log.trace, self._history.events(to, before))
            except SimulationError:
                self.lockstep.fail()
                raise

    def _repeat(self, to: int) -> None:
        history, lockstep = self._history, self.lockstep
        kept, state = history.before(self._log.kept(to))
        if kept > lockstep.ticks:
            while lockstep.ticks < kept:
                lockstep.repeat_commands(history.commands, only_agents=True)
                lockstep.repeat_tick(history.answers(lockstep.ticks + 1))
            self._world.restore(state)
        while lockstep.ticks < to:
            self.tick()
            self.tock()


def _check_repeated(first: Trace, again: Trace, number: int | None) -> None:
    """Compares the events of a repeated run with those of the first time.

    Args:
        first: The trace of the first time.
        again: The trace of the repeated run.
        number: The number of events that the first run had up to where the repeated one is; None if it was not there.

    Raises:
        SimulationError: If they differ.
    """
    pairs = zip(first, again, strict=False) if number is None else zip_longest(islice(first, number), again)
    for was, now in pairs:
        if was != now and (was is None or now is None or was.to_json() != now.to_json()):
            time = seconds(min(event.time_us for event in (was, now) if event is not None))
            raise SimulationError(
                f"the agents act differently than the first time from {time:.3f} s on (then: {_brief(was)}; now: {_brief(now)}): they "
                "use something that neither comes from the seed nor belongs to an agent, such as a global variable or an attribute of a "
                "class that the model changes; keep it in the agent, such as self.count in init()"
            )


def _brief(event: TraceEvent | None) -> str:
    if event is None:
        return "nothing"
    return shortened(f"{event.source} {event.kind} {event.data_text}", SHOWN)
