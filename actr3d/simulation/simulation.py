"""Simulation: agents and their bodies in one world, in lockstep."""

from __future__ import annotations

import linecache
import sys
import threading
from collections import deque
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from concurrent.futures import Future
from contextlib import AbstractContextManager, contextmanager
from dataclasses import asdict, is_dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal
from zlib import crc32

from actr3d.actr.kernel.run_limits import RunLimits, fresh_seed
from actr3d.actr.kernel.source_code import SOURCE
from actr3d.clock import seconds
from actr3d.errors import RecordingError, SimulationError
from actr3d.notebook import show_in_notebook
from actr3d.recording import Recording
from actr3d.recording.facts import FACTS
from actr3d.simulation.agents import Factory
from actr3d.simulation.commands import Command
from actr3d.simulation.event_log import EventLog
from actr3d.simulation.global_random import GlobalRandom
from actr3d.simulation.lockstep import Lockstep
from actr3d.simulation.measure import Measure
from actr3d.simulation.observers import Glimpse, Observer, Observers
from actr3d.simulation.real_time import RealTime, RunReport, SimulationEnding
from actr3d.simulation.surroundings import scene_facts
from actr3d.simulation.timeline import Timeline
from actr3d.simulation.validation import check_names, count_of, factor_of, named_factories, seed_of, steps_of, whole_ticks, world_of
from actr3d.trace import Listener, Trace, TraceEvent
from actr3d.world import Scene, World


class Simulation:
    """Runs agents and their bodies through the same time: a tick of cognition, then a tock of physics, then sensing.

    A tick runs every agent for one period, events at its very end included. The tock carries out the commands of the agents to
    their bodies, simulates the physics of the same period, and reads the sensors that the agents asked for; the answers are
    available when the next tick begins. Wall-clock time never affects the result: it depends on scene, agents, seed and
    commands alone.

    A simulation belongs to the thread that makes it; other threads may `submit` commands.

    Args:
        scene: The description of the world; or a compiled world, at its start, with its own seed.
        agents: By a body's name, the factory of its agent: an agent's class, or a function without arguments. It is called again
            when the run goes back to an earlier time. A body that is not named has no agent.
        bodiless: By name, the factory of an agent without a body.
        period: Length of a tick [s]; a whole multiple of the physics step. Source of 10 ms: the original ACT-R 3D.
        seed: The seed of all random choices; None for the next seed of the program that runs, or else a new random one.
        trace: The level of the trace; see `actr3d.trace.LEVELS`.

    Raises:
        SimulationError: If the period is not a whole multiple of the physics step, an agent's body does not exist, the world is not
            at its start, or a value has the wrong type.
        ParameterError: If the trace's level is unknown.
    """

    def __init__(
        self,
        scene: Scene | World,
        agents: Mapping[str, Factory] | None = None,
        *,
        bodiless: Mapping[str, Factory] | None = None,
        period: float = 0.01,
        seed: int | str | None = None,
        trace: str = "none",
    ) -> None:
        self._limits = limits = RunLimits.current()
        self.seed: int | str = seed_of(seed) if seed is not None else fresh_seed() if limits is None else limits.next_seed()
        self._embodied = named_factories(agents, "Simulation.agents")
        self._bodiless = named_factories(bodiless, "Simulation.bodiless")
        self.world = world_of(scene, crc32(str(self.seed).encode()))
        """The world, to read it. Changes between ticks go through `command`: what `world` or its bodies are made to do directly is neither
        recorded nor repeated when the run goes back."""
        check_names(self._embodied, self._bodiless, self.world.bodies)
        self._steps = steps_of(period, self.world)
        self._period = self._steps * self.world.scene.timestep_us
        self.event_log = EventLog(trace, self.world)
        """Passes all events on; for recorders and runners."""
        if limits is not None and limits.trace is not None:
            self.event_log.join_program(limits.trace, limits.recorder, self._period)
        self._random = GlobalRandom()
        self._submitted: deque[tuple[Future[None], Callable[[], None]]] = deque()
        self._observers = Observers(self._random, self.world)
        self._measure: Measure | None = None
        self._calls = 0
        self.timeline = Timeline(self.world, self._begin, self.event_log)
        """The run in time; for recorders and runners."""
        self._owner = threading.get_ident()

    def _begin(self) -> Lockstep:
        factories = {**self._embodied, **self._bodiless}
        with self._random:
            return Lockstep(self.world, factories, frozenset(self._embodied), self.seed, self._steps, self._period, self.event_log)

    # -- the present

    @property
    def ticks(self) -> int:
        """Number of completed ticks."""
        return self.timeline.ticks

    @property
    def time(self) -> float:
        """The present time [s]."""
        return seconds(self.ticks * self._period)

    @property
    def period(self) -> float:
        """Length of a tick [s]."""
        return seconds(self._period)

    @property
    def furthest(self) -> float:
        """The latest time of the run [s]; after `seek` the present may be before it."""
        return seconds(self.timeline.furthest * self._period)

    @property
    def agents(self) -> dict[str, Any]:
        """The agents by name, read only: changes from outside are not repeated when the run goes back.

        Raises:
            SimulationError: If an agent cannot be made.
        """
        environment = self.timeline.lockstep.agents.environment
        return {name: environment[name] for name in (*self._embodied, *self._bodiless)}

    @property
    def embodied(self) -> tuple[str, ...]:
        """The names of the bodies that have an agent."""
        return tuple(self._embodied)

    @property
    def done(self) -> bool:
        """Whether no agent has anything left to do, now or ever, no body is on its way, and no command of a user waits."""
        return self.timeline.lockstep.done and not self._submitted and self.ticks >= self.timeline.furthest

    @property
    def over(self) -> Literal["stop", "done"] | None:
        """Why the run can end here: an agent called `stop`, or nothing is left to do (`done`); None if neither."""
        return "stop" if self.timeline.lockstep.agents.stopped else "done" if self.done else None

    @property
    def trace(self) -> Trace | None:
        """The trace of the run up to now; None if nothing is traced. After `seek` it is another one."""
        return self.timeline.lockstep.trace

    # -- running

    def tick(self) -> None:
        """Runs the agents for one period, after carrying out the commands that other threads have submitted.

        Raises:
            SimulationError: If the last tick has had no tock, or has failed; if this is another thread, an observer, or what an agent or
                a body does.
            Exception: What an agent raises.
        """
        self._enter()
        with self._random:
            self._tick()

    def tock(self) -> None:
        """Carries out the commands to the bodies, simulates the physics of the same period, and reads the sensors.

        Raises:
            SimulationError: If there has been no tick before, or something has failed.
            WorldError: If the physics diverges.
            Exception: What a body, an observer or a listener of the trace raises.
        """
        self._enter()
        with self._random:
            self._tock()

    def _tick(self) -> None:
        """Does what `tick` does, inside a call: with the random numbers of the agents, and after the checks of `_enter`."""
        if self._submitted:
            self.carry_out_submitted()
        if not self.timeline.ticks:
            self._notify_limits(0)
        self.timeline.tick()

    def _tock(self) -> None:
        """Does what `tock` does, inside a call."""
        self.timeline.tock()
        self._observers.show(self._glimpse)
        self.event_log.check()
        self._notify_limits(self._period)

    def _notify_limits(self, time: int) -> None:
        """Notifies the limits of the program that time has passed [us]; they may wait here."""
        if self._limits is not None and self._limits.ticked is not None:
            with self._random.aside():
                self._limits.ticked(self, time)

    def step(self, n: int = 1) -> None:
        """Runs a number of ticks, each with its tock.

        Raises:
            SimulationError: If the number is not a whole number, or is negative; and as `tick` does.
            Exception: As `tick` and `tock` do.
        """
        with self._call():
            for _ in range(count_of(n, "step(n)")):
                self._tick()
                self._tock()

    def advance(self, most: int) -> Literal["stop", "done"] | None:
        """Runs up to `most` ticks, at least one unless `most` is 0; stops when the run is over, and returns `over`.

        Raises:
            SimulationError: If the number is not a whole number, or is negative; and as `tick` does.
            Exception: As `tick` and `tock` do.
        """
        with self._call():
            for _ in range(count_of(most, "advance(most)")):
                self._tick()
                self._tock()
                if self.over is not None:
                    break
        return self.over

    def run(
        self, seconds: float | None = None, *, until: Callable[[Glimpse], bool] | None = None, real_time: float | None = None
    ) -> RunReport:
        """Runs until a time has passed, a condition is true, an agent calls `stop`, or nothing is left to do.

        Nothing is left to do when no agent has anything left to do, and no body is on its way to a point, a heading or a posture; a
        movement that something blocks does not count. This ends a run only if neither `seconds` nor `until` is given. An agent that calls
        `stop` ends the run after the present tick and its tock. The limits of the program (`actr3d run --until`) cut a run after
        the last whole tick that they leave time for.

        Args:
            seconds: Duration [s from now]; a whole number of ticks.
            until: Called after each tock; ends the run when it returns True.
            real_time: Greatest speed as a multiple of real time; None for as fast as possible.

        Returns:
            What ended the run, its speed, and its delays if it could not keep up with real time.

        Raises:
            SimulationError: If the time is not a whole number of ticks, the factor is not > 0, or `until` is not a function; and
                as `tick` does.
            EndOfRun: If the limits of the program leave no time for any tick.
            Exception: As `tick` and `tock` do.
        """
        factor = factor_of(real_time, "run(real_time)")
        if until is not None and not callable(until):
            raise SimulationError(f"run(until): must be a function that takes a Glimpse (got {until!r})")
        end = None if seconds is None else self.ticks + whole_ticks(seconds, self._period, "run(seconds)")
        held = self._limits is not None and self._limits.ticked is not None
        clock = RealTime(self._period, None if held else factor)  # limits that wait set the speed themselves
        with self._call():
            return clock.report(self._run_until(clock, end, until, open_end=end is None and until is None))

    def _run_until(self, clock: RealTime, end: int | None, until: Callable[[Glimpse], bool] | None, *, open_end: bool) -> SimulationEnding:
        """Runs until something ends the run, and returns what."""
        lockstep = self.timeline.lockstep
        agents, begin = lockstep.agents, self.ticks
        while end is None or self.ticks < end:
            if open_end and self.done:
                return "done"
            if self.ticks > begin and not lockstep.may_tick():
                lockstep.cut()
                return "limits"
            self._tick()
            self._tock()
            clock.tick()
            if agents.stopped:
                return "stop"
            if until is not None:
                with self.only_looking():
                    if until(self._glimpse()):
                        return "until"
        return "seconds"

    @contextmanager
    def _call(self) -> Generator[None]:
        """Uses the agents' random numbers inside the block; then calls the observers of calls, outside the outermost block only."""
        self._enter()
        self._calls += 1
        try:
            with self._random:
                yield
        finally:
            self._calls -= 1
            if not self._calls:
                self._observers.show(self._glimpse, of_calls=True)

    def _enter(self) -> None:
        if threading.get_ident() != self._owner:
            raise SimulationError("a simulation belongs to the thread that made it; another one may use submit")
        if self._observers.looking:
            raise SimulationError("observers, listeners and `until` cannot step or change the simulation")
        if self.timeline.running:
            raise SimulationError(
                "an agent or a body cannot run or change the simulation that runs it; an agent ends the run with self.stop(), and lets "
                "time pass with yield"
            )

    # -- commands

    def command(self, word: str, /, *values: Any, body: str | None = None, **named: Any) -> None:
        """Carries out a command at once, between two ticks: `command("aperture", 0.6)`, `command("walk", 1.2, body="walker")`.

        It is a change of the world or of an agent (see `actr3d.change.CHANGES`), or a command of a body. It is recorded with its
        tick, and repeated at the same tick when the run goes back and forward again. After the run went back, a new command starts
        another future: what came after the present is forgotten, also by the recording.

        Args:
            word: The command.
            values: Its values: numbers, texts, and tuples and dicts of these.
            body: The body that carries it out; the only one by default.
            named: More values, by name.

        Raises:
            SimulationError: If there is no such command or body, or a tick waits for its tock.
            Exception: What the world or the body raises; then nothing was done.
        """
        self.carry_out(word, values, named, body)

    def carry_out(self, word: str, values: Sequence[Any], named: Mapping[str, Any], body: str | None, *, by: str | None = None) -> None:
        """Does what `command` does; for runners.

        Args:
            word: The command.
            values: Its values.
            named: More values, by name.
            body: The body that carries it out; None for the only one.
            by: Who gives it; see `Command.by`.

        Raises:
            SimulationError: As `command` does.
            Exception: As `command` does.
        """
        with self._call():
            self.timeline.command(word, values, named, body, by)
        self.event_log.check()

    def plan(self, commands: Sequence[Command], ticks: int = 0) -> None:
        """Plans the commands of an earlier run, each after its tick, as if this run had gone back to its start.

        Args:
            commands: The commands of users.
            ticks: Length of the earlier run: this one can seek any time up to its end.

        Raises:
            SimulationError: If the run has begun already.
        """
        if self.timeline.begun:
            raise SimulationError("plan() must be called before the run starts")
        self.timeline.plan(commands, ticks)

    def forget_ahead(self) -> None:
        """Forgets that the run has been further than it is now; used when it differs from an earlier run."""
        self.timeline.forget_ahead()

    def submit(self, word: str, /, *values: Any, body: str | None = None, **named: Any) -> Future[None]:
        """Submits a command from any thread; it is carried out before the next tick.

        Returns:
            A future that is done when the command is, or raises its error.
        """
        future: Future[None] = Future()
        self._submitted.append((future, partial(self.command, word, *values, body=body, **named)))
        return future

    def carry_out_submitted(self) -> None:
        """Carries out submitted commands; `tick` does this itself, a paused run needs it."""
        while self._submitted:
            future, command = self._submitted.popleft()
            if not future.set_running_or_notify_cancel():
                continue
            try:
                command()
            except Exception as error:  # noqa: BLE001 - the future raises it
                future.set_exception(error)
            else:
                future.set_result(None)

    # -- going back

    def seek(self, time: float) -> None:
        """Moves the run to any time from its start to its latest time: to the end of that tick, before its commands.

        Continuing from there gives the same bytes as the first run, with all its commands.

        Args:
            time: When [s]; a whole number of ticks.

        Raises:
            SimulationError: If the time is after the end of the run, or is not a whole number of ticks.
        """
        with self._call():
            to = whole_ticks(time, self._period, "seek")
            if to > self.timeline.furthest:
                raise SimulationError(f"seek({time:g}): the run has only reached {self.furthest:g} s; continue it instead")
            self.timeline.seek(to)
            self.event_log.check()
            self._observers.show(self._glimpse)

    def undo(self) -> None:
        """Undoes the last command up to now: goes to its moment, before it, and forgets it and what came after it, also in the recording.

        A command of the present moment that is yet to be repeated after `seek` counts too.

        Raises:
            SimulationError: If there is no command up to now; and as `seek` does.
        """
        with self._call():
            self.timeline.undo()
            self.event_log.check()
            self._observers.show(self._glimpse)

    # -- observing, without an effect on the run

    def observe(self, observer: Observer, *, of_calls: bool = False) -> None:
        """Calls an observer with a `Glimpse` after each tock, and after `seek`; it receives copies and can change nothing.

        Args:
            observer: The function.
            of_calls: Whether it is called at the end of each `run`, `step`, `seek` and `command` instead, also of one that fails.

        Raises:
            SimulationError: If it is not a function.
        """
        self._observers.add(observer, of_calls=of_calls)

    def show(self, *, height: int = 560) -> Any:
        """Returns a widget that shows this simulation in a notebook: scene, timeline and buffers, which follow what cells do with it.

        A run that has begun is first repeated from its start, because its past is shown too.

        Args:
            height: Height of the widget [px].

        Raises:
            NotebookError: If the packages for notebooks are not installed, or this is not a notebook.
            SimulationError: As `seek` does, if the run has begun.
        """
        return show_in_notebook(self, height=height)

    def only_looking(self) -> AbstractContextManager[None]:
        """Returns a `with` block for code that reads the simulation, such as the sensors of its bodies: it cannot change anything, not even
        what agents will sense later, nor their random numbers."""
        return self._observers.only_looking()

    def _glimpse(self) -> Glimpse:
        return Glimpse(self.world, self.timeline.ticks)

    def listen(self, listener: Listener) -> None:
        """Calls a listener with every event of the trace from now on; not with those that `seek` repeats.

        Raises:
            ParameterError: If nothing is traced.
            SimulationError: If it is not a function.
        """
        if not callable(listener):
            raise SimulationError(f"listen(listener): must be a function that takes a TraceEvent (got {listener!r})")

        def listen_aside(event: TraceEvent) -> None:
            with self.only_looking():
                listener(event)

        self.event_log.listen(listen_aside)

    def traced(self, level: str = "all") -> None:
        """Sets the level of the trace to at least this one, and keeps its events: `trace` then has them all.

        Raises:
            SimulationError: If the run has begun already.
            ParameterError: If the level is unknown.
        """
        if self.timeline.begun:
            raise SimulationError("traced() must be called before the run starts")
        self.event_log.raise_level(level, keep=True)

    def measure(self, measure: Measure) -> None:
        """Adds a measure, which reads every physics step from the start of the run on; it computes the run's result.

        Raises:
            SimulationError: If the run has begun already, or has a measure; if it is not an object with the methods of a `Measure`.
            Exception: What the measure raises, if the world lacks what it measures.
        """
        if self.timeline.begun or self._measure is not None:
            raise SimulationError("measure() must be called once, before the run starts")
        if isinstance(measure, type) or not all(callable(getattr(measure, name, None)) for name in ("begin", "look", "result")):
            raise SimulationError(f"measure(measure): must be an object with the methods begin, look and result (got {measure!r})")
        with self.only_looking():
            measure.begin(self.world)
        self.world.watchers.append(measure.look)
        self._measure = measure

    def result(self) -> Any:
        """Returns the result of the measure up to now; None if there is none.

        Raises:
            SimulationError: If it is not an object of a dataclass.
            Exception: What the measure raises.
        """
        if self._measure is None:
            return None
        lockstep = self.timeline.lockstep
        with self.only_looking():
            found = self._measure.result(over=lockstep.agents.stopped or lockstep.done)
        if found is not None and (not is_dataclass(found) or isinstance(found, type)):
            raise SimulationError(f"{type(self._measure).__name__}.result: must return an object of a dataclass (returned {found!r})")
        return found

    def conclude(self) -> Any:
        """Returns the result, and traces it; the run must not continue."""
        result = self.result()
        if result is not None:
            self.event_log.result(self.timeline.lockstep.agents.time, asdict(result))
            self.event_log.check()
        return result

    def record(self, path: Path | str, **facts: Any) -> Recording:
        """Records the whole run to a new file, with every event, state, command and answer; the caller closes it.

        Args:
            path: The file; it must not exist.
            facts: More facts of the run: plain values, as of a `Recording`, by names that a recording does not use itself.

        Raises:
            SimulationError: If the run has begun already, or is being recorded.
            RecordingError: If the file exists, or cannot be made, or a fact cannot be recorded.
        """
        if self.timeline.begun:
            raise SimulationError("record() must be called before the run starts")
        if self.event_log.recorded:
            raise SimulationError("this run is being recorded already; what records it holds everything")
        recording = Recording(path, self.facts(**facts))
        self.event_log.record(recording)
        recording.ending = lambda: self.event_log.end_recording(whole=self.timeline.begun and not self.timeline.lockstep.broken)
        return recording

    def facts(self, **given: Any) -> dict[str, Any]:
        """Returns the facts that a recording of this simulation begins with: of its time, its seed, its world at the start, its agents.

        Args:
            given: More facts: plain values by names that a recording does not use itself.

        Raises:
            RecordingError: If a fact has such a name.
        """
        world = self.world
        own = {"seed": self.seed, "period_us": self._period, "timestep_us": world.scene.timestep_us, "scene": world.fingerprint}
        return _facts_of(own | scene_facts(world), given, [*self._embodied.values(), *self._bodiless.values()])


def _sources_of(factories: Iterable[Any]) -> dict[str, str]:
    """Returns by name the text of every file that defines agents; files without text are left out."""
    found: dict[str, str] = {}
    for factory in factories:
        module = sys.modules.get(getattr(factory, "__module__", ""))
        name = getattr(module, "__file__", None)
        if module is not None and name is not None and name not in found:
            text = module.__dict__.get(SOURCE) or "".join(linecache.getlines(name))
            if text:
                found[name] = text
    return found


def _facts_of(own: Mapping[str, Any], given: Mapping[str, Any], factories: Iterable[Any]) -> dict[str, Any]:
    """Returns the facts of a simulation: its own, those of its user, and the source of its agents.

    Raises:
        RecordingError: If the user gives a fact that a recording sets itself.
    """
    written = {*own, *(name for name, fact in FACTS.items() if fact.always or fact.of_end)}
    if taken := sorted(written & given.keys()):
        raise RecordingError(f"a recording sets '{taken[0]}' itself; give that fact another name")
    return {"kind": "simulation", **own, **given, "sources": given.get("sources") or _sources_of(factories)}
