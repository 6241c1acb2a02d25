"""A run to look on at: who sees it go on, and what of it is traced, measured and recorded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from actr3d.errors import SimulationError
from actr3d.recording import Recording
from actr3d.simulation.course import Course
from actr3d.simulation.glimpse import Glimpse
from actr3d.simulation.global_random import GlobalRandom
from actr3d.simulation.journal import Journal, Listener
from actr3d.simulation.measuring import Measure
from actr3d.simulation.onlookers import Observer, Onlookers
from actr3d.trace import Trace, TraceEvent
from actr3d.world import World


class LookedOn:
    """Lets others look on at a run, which goes as it would without them.

    Args:
        world: The world.
        course: The course of the run.
        journal: Who is told of everything.
        random: The random numbers as the minds have them.
    """

    def __init__(self, world: World, course: Course, journal: Journal, random: GlobalRandom) -> None:
        self.world = world
        self._course = course
        self._journal = journal
        self._onlookers = Onlookers(random)
        self._measure: Measure | None = None

    @property
    def trace(self) -> Trace | None:
        """The trace of the run up to now; None where nothing is traced. After `seek` it is another one."""
        return self._course.lockstep.trace

    def observe(self, observer: Observer) -> None:
        """Calls an observer with a `Glimpse` after each tock, and after `seek`; it sees copies and can change nothing."""
        self._onlookers.add(observer)

    def traced(self, level: str = "all") -> None:
        """Lets the trace hold at least so much, whoever made the simulation, and keep it: `trace` then has it all.

        Raises:
            SimulationError: If the run has begun already.
            ParameterError: If the level is unknown.
        """
        if self._course.begun:
            raise SimulationError("a trace holds a run from its start on, and this one has begun already")
        self._journal.raise_level(level, keep=True)

    def measure(self, measure: Measure) -> None:
        """Lets a measure look at every physics step from the start of the run on; what it finds is the run's result.

        Raises:
            SimulationError: If the run has begun already, or has a measure.
            Exception: What the measure raises, of what it does not find in the world.
        """
        if self._course.begun or self._measure is not None:
            raise SimulationError("a run has one measure, which looks at it from its start on")
        measure.begin(self.world)
        self.world.watchers.append(measure.look)
        self._measure = measure

    def result(self) -> Any:
        """Returns what has been measured of the run up to now; None where nothing is."""
        if self._measure is None:
            return None
        minds = self._course.lockstep.minds
        return self._measure.result(over=minds.stopped or minds.done)

    def conclude(self) -> Any:
        """Returns the result, and tells the trace of it: the run is not to go on."""
        result = self.result()
        if result is not None:
            self._journal.result(self._course.lockstep.minds.time, asdict(result))
            self._journal.check()
        return result

    def listen(self, listener: Listener) -> None:
        """Calls a listener with every event of the trace from now on; not with those that `seek` goes through again.

        Raises:
            ParameterError: If nothing is traced.
        """

        def listen_aside(event: TraceEvent) -> None:
            with self._onlookers.only_looking():
                listener(event)

        self._journal.listen(listen_aside)

    def record(self, path: Path | str, **facts: Any) -> Recording:
        """Records the whole run to a new file, with every event, state, command and answer; to be closed by who asks for it.

        Args:
            path: The file; it must not exist.
            facts: What else is to be told of the run: plain values by names that a recording does not use itself.

        Raises:
            SimulationError: If the run has begun already, or is being recorded.
            RecordingError: If the file exists, or cannot be made, or a fact cannot be recorded.
        """
        if self._course.begun:
            raise SimulationError("a recording holds a run from its start on, and this one has begun already")
        if self._journal.recorded:
            raise SimulationError("this run is being recorded already; what records it holds everything")
        recording = Recording(path, self._told(facts))
        self._journal.record(recording)
        recording.ending = self._end_recording
        return recording

    def _end_recording(self) -> None:
        self._journal.end_recording(whole=self._course.begun and not self._course.lockstep.broken)

    def _told(self, facts: Mapping[str, Any]) -> dict[str, Any]:
        """Returns what a recording is told of the run from the first, with what else is to be told.

        Raises:
            RecordingError: If a fact cannot be recorded.
        """
        raise NotImplementedError

    def _glimpse(self) -> Glimpse:
        return Glimpse(self.world, self._course.ticks)
