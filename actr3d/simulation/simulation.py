"""Simulation: minds and their bodies in one world, in lockstep."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from functools import partial
from typing import Any
from zlib import crc32

from actr3d.actr.kernel.run_limits import RunLimits, fresh_seed
from actr3d.clock import seconds
from actr3d.errors import SimulationError
from actr3d.simulation.arguments import check_names, count_of, factor_of, named_minds, seed_of, steps_of, whole_ticks, world_of
from actr3d.simulation.commands import Command
from actr3d.simulation.course import Course
from actr3d.simulation.glimpse import Glimpse
from actr3d.simulation.global_random import GlobalRandom
from actr3d.simulation.journal import Journal
from actr3d.simulation.lockstep import Lockstep
from actr3d.simulation.looked_on import LookedOn
from actr3d.simulation.minds import Factory
from actr3d.simulation.pace import Ending, Pace, RunReport
from actr3d.simulation.sources import told_facts
from actr3d.simulation.submissions import Submissions
from actr3d.world import Scene, World


class Simulation(LookedOn):
    """Runs minds and their bodies through the same time: a tick of cognition, then a tock of physics, then sensing.

    A tick lets every mind think for one period, events at its very end included. The tock carries out what the minds
    told their bodies meanwhile, simulates the physics of the same period, and lets the bodies answer what they were
    asked; the answers are there when the next tick begins. However long a tick takes on the wall, the result is the
    same: it depends on scene, minds, seed and commands alone.

    A simulation belongs to the thread that makes it; others may `submit` commands.

    Args:
        scene: What the world is made of; or a world that is compiled already, at its start, with a seed of its own.
        minds: By a body's name, what makes its mind: an agent's class, or a function without arguments. It is called again
            where the run goes back to an earlier time. A body that is not named has no mind.
        bodiless: By a name, what makes a mind that has no body.
        period: How long a tick is [s]; a whole multiple of the physics step. Source of 10 ms: the original ACT-R 3D.
        seed: What all random choices come from; None takes the program's, or draws one.
        trace: How much of what happens is kept; see `actr3d.trace.LEVELS`.

    Raises:
        SimulationError: If the period is no whole multiple of the physics step, a mind's body is not there, the world is not
            at its start, or something is of another kind than it should be.
        ParameterError: If the trace's level is unknown.
    """

    def __init__(
        self,
        scene: Scene | World,
        minds: Mapping[str, Factory] | None = None,
        *,
        bodiless: Mapping[str, Factory] | None = None,
        period: float = 0.01,
        seed: int | str | None = None,
        trace: str = "none",
    ) -> None:
        self._limits = limits = RunLimits.current()
        self.seed: int | str = seed_of(seed) if seed is not None else fresh_seed() if limits is None else limits.next_seed()
        self._minds = named_minds(minds, "Simulation.minds")
        self._bodiless = named_minds(bodiless, "Simulation.bodiless")
        world = world_of(scene, crc32(str(self.seed).encode()))
        check_names(self._minds, self._bodiless, world.bodies)
        self._steps = steps_of(period, world)
        self._period = self._steps * world.scene.timestep_us
        journal = Journal(trace)
        if limits is not None and limits.trace is not None:
            journal.tell_program(limits.trace, limits.recorder)
        self._random = GlobalRandom()
        self._submitted = Submissions()
        super().__init__(world, Course(world, self._begin, journal), journal, self._random)
        self._owner = threading.get_ident()

    def _begin(self) -> Lockstep:
        minds = {**self._minds, **self._bodiless}
        with self._random:
            return Lockstep(self.world, minds, frozenset(self._minds), self.seed, self._steps, self._period, self._journal)

    def _told(self, facts: Mapping[str, Any]) -> dict[str, Any]:
        own = {"seed": self.seed, "period_us": self._period, "timestep_us": self.world.scene.timestep_us, "scene": self.world.fingerprint}
        return told_facts(own, facts, [*self._minds.values(), *self._bodiless.values()])

    # -- where it stands

    @property
    def ticks(self) -> int:
        """How many whole ticks the run has gone."""
        return self._course.ticks

    @property
    def time(self) -> float:
        """The present [s]."""
        return seconds(self.ticks * self._period)

    @property
    def period(self) -> float:
        """How long a tick is [s]."""
        return seconds(self._period)

    @property
    def furthest(self) -> float:
        """How far the run has come [s]; after `seek` the present may lie before that."""
        return seconds(self._course.furthest * self._period)

    @property
    def minds(self) -> dict[str, Any]:
        """The minds by name, to look at: what is changed here from outside is not repeated when the run goes back.

        Raises:
            SimulationError: If a mind cannot be made.
        """
        environment = self._course.lockstep.minds.environment
        return {name: environment[name] for name in (*self._minds, *self._bodiless)}

    @property
    def done(self) -> bool:
        """Whether no mind has anything left to do, now or ever, and no user has asked for anything."""
        return self._course.lockstep.minds.done and not self._submitted and self.ticks >= self._course.furthest

    # -- going on

    def tick(self) -> None:
        """Lets the minds think for one period, after carrying out what other threads have submitted.

        Raises:
            SimulationError: If the last tick has had no tock, or has failed; if this is another thread, or an observer.
            Exception: What a mind raises.
        """
        self._enter()
        if self._submitted:
            self.carry_out_submitted()
        if not self.ticks:
            self._pass(0)
        with self._random:
            self._course.tick()

    def tock(self) -> None:
        """Lets the bodies do what they were told, simulates the physics of the same period, and lets them answer.

        Raises:
            SimulationError: If there has been no tick before, or something has failed.
            WorldError: If the physics diverges.
            Exception: What a body, an observer or a listener of the trace raises.
        """
        self._enter()
        self._course.tock()
        self._onlookers.show(self._glimpse)
        self._journal.check()
        self._pass(self._period)

    def _pass(self, time: int) -> None:
        """Lets the limits of the program know that time has passed [us]; they may hold it up here."""
        if self._limits is not None and self._limits.ticked is not None:
            with self._random.aside():
                self._limits.ticked(self, time)

    def step(self, n: int = 1) -> None:
        """Goes on by a number of ticks, each with its tock.

        Raises:
            SimulationError: If the number is no whole one, or negative; and as `tick` does.
            Exception: As `tick` and `tock` do.
        """
        with self._random:
            for _ in range(count_of(n, "step(n)")):
                self.tick()
                self.tock()

    def run(
        self, seconds: float | None = None, *, until: Callable[[Glimpse], bool] | None = None, real_time: float | None = None
    ) -> RunReport:
        """Goes on until a time has passed, something has come true, a mind says `stop`, or no mind has anything left to do.

        The last of these ends a run only where neither a time nor a condition is given. A mind that says `stop` ends the
        run after the present tick and its tock. The limits of the program (`actr3d run --until`) cut a run after the last
        whole tick that they leave time for.

        Args:
            seconds: How long [s from now]; a whole number of ticks.
            until: Asked after each tock; ends the run when it returns True.
            real_time: How many times as fast as real time it is to go, at most; None for as fast as possible.

        Returns:
            How it went: what ended it, how fast it was, and how late where it could not keep to real time.

        Raises:
            SimulationError: If the time is no whole number of ticks, the factor is not above 0, or `until` is no function; and
                as `tick` does.
            EndOfRun: If the limits of the program leave no time for any tick.
            Exception: As `tick` and `tock` do.
        """
        factor = factor_of(real_time, "run(real_time)")
        if until is not None and not callable(until):
            raise SimulationError(f"run(until): must be a function that takes a Glimpse (got {until!r})")
        end = None if seconds is None else self.ticks + whole_ticks(seconds, self._period, "run(seconds)")
        held = self._limits is not None and self._limits.ticked is not None
        pace = Pace(self._period, None if held else factor)  # who holds the program up says how fast it goes
        with self._random:
            return pace.report(self._go_on(pace, end, until, open_end=end is None and until is None))

    def _go_on(self, pace: Pace, end: int | None, until: Callable[[Glimpse], bool] | None, *, open_end: bool) -> Ending:
        """Goes on until something ends the run; says what."""
        lockstep = self._course.lockstep
        minds, begin = lockstep.minds, self.ticks
        while end is None or self.ticks < end:
            if open_end and self.done:
                return "done"
            if self.ticks > begin and not lockstep.may_tick():
                lockstep.cut()
                return "limits"
            self.tick()
            self.tock()
            pace.tick()
            if minds.stopped:
                return "stop"
            if until is not None:
                with self._onlookers.only_looking():
                    if until(self._glimpse()):
                        return "until"
        return "seconds"

    def _enter(self) -> None:
        if threading.get_ident() != self._owner:
            raise SimulationError("a simulation belongs to the thread that made it; another one may use submit")
        if self._onlookers.looking:
            raise SimulationError("an observer only looks, as a listener and `until` do: it cannot step or change the simulation")

    # -- commands

    def command(self, word: str, /, *values: Any, body: str | None = None, **named: Any) -> None:
        """Does something to the run, at once, between two ticks: `command("aperture", 0.6)`, `command("walk", 1.2, body="walker")`.

        A word of the world (`aperture`), of the minds (`parameter`, a path and a value), or any word that a body takes. It
        is recorded with its tick, and done again at the same tick where the run goes back and on again. Where the run
        has gone back, a new command makes it go another way: what came after the present is forgotten, also by the
        recording.

        Args:
            word: What to do.
            values: With what; numbers, texts, and tuples and dicts of these.
            body: Which body is to do it; the only one unless named.
            named: More values, by name.

        Raises:
            SimulationError: If there is no such command or body, or a tick waits for its tock.
            Exception: What the world or the body raises; then nothing was done.
        """
        self._enter()
        with self._random:
            self._course.command(word, values, named, body)
        self._journal.check()

    def plan(self, commands: Sequence[Command], ticks: int = 0) -> None:
        """Lets the commands of an earlier run be done again, each after its tick, as if this run had gone back to its start.

        Args:
            commands: What users did.
            ticks: How far the earlier run came: this one can go to any time up to there.

        Raises:
            SimulationError: If the run has begun already.
        """
        if self._course.begun:
            raise SimulationError("commands are planned before the run begins, and this one has begun already")
        self._course.plan(commands, ticks)

    def forget_ahead(self) -> None:
        """Forgets that the run has been further than it is now, as where it does not do again what an earlier run did."""
        self._course.forget_ahead()

    def submit(self, word: str, /, *values: Any, body: str | None = None, **named: Any) -> Future[None]:
        """Asks for a command from any thread; it is carried out before the next tick.

        Returns:
            What tells when it is done, or raises what went wrong with it.
        """
        return self._submitted.add(partial(self.command, word, *values, body=body, **named))

    def carry_out_submitted(self) -> None:
        """Carries out what other threads have submitted; `tick` does so by itself, this is for a run that is paused."""
        self._submitted.carry_out()

    # -- going back

    def seek(self, time: float) -> None:
        """Brings the run to any time from its start to the furthest it has come; to the end of that tick, before what users did then.

        Going on from there gives what the first run gave, with all its commands, byte for byte.

        Args:
            time: When [s]; a whole number of ticks.

        Raises:
            SimulationError: If the run has not come so far, or the time is no whole number of ticks.
        """
        self._enter()
        to = whole_ticks(time, self._period, "seek")
        if to > self._course.furthest:
            raise SimulationError(f"seek({time:g}): the run has come to {self.furthest:g} s only; run it on instead")
        with self._random:
            self._course.seek(to)
        self._journal.check()
        self._onlookers.show(self._glimpse)
