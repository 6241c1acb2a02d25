"""A run of a program: models without a world. It goes back by being run again from its start, with the same seed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from actr3d.actr.limits import EndOfRun, RunLimits, fresh_seed
from actr3d.actr.loading import run_text
from actr3d.actr.picture import picture_of
from actr3d.actr.sweep import with_values
from actr3d.clock import MICROSECONDS, seconds
from actr3d.errors import SimulationError
from actr3d.recording import Recording
from actr3d.running.printed import ProgramOutput
from actr3d.trace import Trace
from actr3d.values import to_json
from workbench import protocol as say
from workbench.curves import NOTHING
from workbench.loader import Listing
from workbench.worker.answers import answer
from workbench.worker.conductor import Conductor, Leaving
from workbench.worker.messages import Facts
from workbench.worker.names import Names, names_of_program
from workbench.worker.recorded_once import RecordedOnce
from workbench.worker.told_helpers import ToldHelpers
from workbench.worker.trouble import UNFORESEEN, notice_of, told_of
from workbench.worker.watch import Touches

PERIOD = 10_000
"""What a step is [us]: as long as a tick of a simulation."""
MOST_RUNS = 8
"""Of so many of the models that a program makes one after the other the latest parts are shown."""


class _Again(EndOfRun):
    """Ends a program so that it can be run again up to an earlier time."""


class ProgramRun:
    """Runs a program as a conductor says; its time is that of all its runs, one after the other.

    Args:
        conductor: Says when it goes on.
        listing: What the model's text says of itself.
    """

    def __init__(self, conductor: Conductor, listing: Listing) -> None:
        start = conductor.link.start
        self._conductor = conductor
        self._listing = listing
        self._source = with_values(start.source, start.settings)
        self._seed = fresh_seed() if start.seed is None else start.seed
        self._recording: Recording | None = None
        self._limits = RunLimits()
        self._clock: int = 0
        self._furthest: int = 0
        self._rush: int | None = None
        """Up to where it goes without being shown or held [us]."""
        self._again = False
        self._helpers: dict[str, Sequence[str]] = dict(start.helpers)
        """The helper modules as they were the first time; see `actr3d.actr.helper_texts`."""

    def play(self) -> None:
        """Runs it, and again where a user goes back, until the worker is to leave."""
        start, conductor = self._conductor.link.start, self._conductor
        known = {parameter.name: parameter.default for parameter in self._listing.parameters}
        parameters = to_json({**known, **start.settings}).encode()
        facts = Facts(kind="program", seed=self._seed, period=seconds(PERIOD), parameters=parameters, world=b"null", mj_model=None)
        conductor.link.post(facts)
        conductor.conduct(self)
        try:
            if start.record is not None:
                told = {"kind": "program", "file": start.path, "sources": {start.path: self._source}}
                self._recording = Recording(start.record, {**told, "seed": self._seed, "until": None})
            while not conductor.leaving:
                self._run_once()
                with suppress(_Again):
                    while not (self._again or conductor.leaving):
                        conductor.attend()
        except Leaving:
            pass
        finally:
            if self._recording is not None:
                self._recording.close()

    def _run_once(self) -> None:
        """Runs the program from its start to its end, or until it is left."""
        conductor = self._conductor
        self._again = False
        self._clock = 0
        trace = Trace("all")
        self._limits = limits = RunLimits(seed=self._seed, trace=trace, passing=self._pass)
        helpers = ToldHelpers(conductor.link, self._helpers)
        helpers.heard = self._keep_helpers
        if self._recording is not None:
            limits.recorder = again = RecordedOnce(self._recording)
            trace.listen(again.event)
        if self._rush == 0:
            self._rush = None
            conductor.went_back()
        if self._rush is None:
            conductor.show()
            conductor.link.flush()  # whatever the program does next, that it has begun is known
            with suppress(_Again):
                conductor.attend()
        try:
            with ProgramOutput(limits) as output:
                if not self._again:
                    self._run_text(limits, helpers)
                if not self._left:
                    output.finish()
        except _Again:
            return
        except UNFORESEEN as error:
            if self._left:
                return
            conductor.link.post(notice_of(error))
            if self._recording is not None:
                self._recording.fact("failed", told_of(error))
            self._end("failed", told_of(error))
            return
        if not self._left:
            if self._recording is not None:
                self._recording.fact("ended", {"by": "end"})
            self._end("ended", "the program is over")

    def _run_text(self, limits: RunLimits, helpers: ToldHelpers) -> None:
        start = self._conductor.link.start
        try:
            run_text(self._source, start.path, limits=limits, folder=Path(start.folder), helpers=helpers)
        except SystemExit as end:
            if end.code:  # else it is how a program says that it has come to its end
                raise

    @property
    def _left(self) -> bool:
        """Whether it did not come to its end by itself."""
        return self._again or self._conductor.leaving

    def _end(self, status: Any, reason: str) -> None:
        self._rush = None
        self._furthest = max(self._furthest, self._clock)
        self._conductor.end(status, reason)

    def _keep_helpers(self, loaded: Mapping[str, Sequence[str]]) -> None:
        new = {name: text for name, text in loaded.items() if name not in self._helpers}
        self._helpers |= new
        if new and self._recording is not None:
            self._recording.fact("helpers", self._helpers)

    def _pass(self, begin: int, end: int) -> None:
        """Lets time pass, as fast as the conductor says; holds the program up meanwhile."""
        conductor = self._conductor
        to = self._clock + end - begin
        while True:
            if conductor.leaving:
                raise Leaving
            if self._again:
                raise _Again
            if self._rush is not None:
                if to <= self._rush:
                    self._clock = to
                    return
                self._clock, self._rush = self._rush, None
                conductor.went_back()
            conductor.attend()
            if self._again or self._rush is not None:
                continue
            goal = conductor.watch.goal
            stop = to if goal is None else min(to, goal)
            if not conductor.pace(stop):
                continue
            self._clock = stop
            self._furthest = max(self._furthest, stop)
            conductor.show_if_due()
            if stop == to:
                return

    # -- what the conductor asks

    @property
    def clock(self) -> int:
        """How much time has passed in all its runs [us]."""
        return self._clock

    @property
    def furthest(self) -> int:
        """How far it has come [us]."""
        return self._furthest

    @property
    def period(self) -> int:
        """What a step is [us]."""
        return PERIOD

    @property
    def trace(self) -> Trace | None:
        """The trace of all its runs."""
        return self._limits.trace

    def do(self, command: Any) -> None:
        """Goes to another time; nothing else can be done to a program.

        Raises:
            SimulationError: If it is anything else, or the run has not been there.
            EndOfRun: To leave the program.
        """
        if isinstance(command, say.Back):
            to = max(0, (self._clock - 1) // PERIOD - command.ticks + 1) * PERIOD
        elif isinstance(command, say.Seek):
            to = round(command.time * MICROSECONDS)
        else:
            raise SimulationError("a program without `build(parameters) -> Simulation` takes no commands while it runs")
        if to > self._furthest:
            raise SimulationError(f"the run has come to {seconds(self._furthest):g} s only; run it on instead")
        over = self._conductor.status in ("ended", "failed")
        self._rush = to
        self._conductor.status = "running"
        if over or to < self._clock:
            self._again = True
            raise _Again

    def answer(self, question: Any) -> Any:
        """Returns what is asked.

        Raises:
            Exception: Says why it cannot be told.
        """
        if isinstance(question, say.Curves):
            return NOTHING
        return answer(question, self.trace, list(self._models()), None)

    def scene(self) -> tuple[bytes | None, dict[str, float]]:
        """Returns nothing: a program has no world that is shown."""
        return None, {}

    def drawn(self, kinds: tuple[str, ...]) -> dict[str, Any]:
        """Returns nothing: there is nothing to draw on."""
        return {}

    def result(self) -> dict[str, Any] | None:
        """Returns nothing: a program is not measured."""
        return None

    def parts(self) -> dict[str, dict[str, Any]]:
        """Returns what all parts of its latest models are like."""
        told: dict[str, dict[str, Any]] = {}
        for model in list(self._models())[-MOST_RUNS:]:
            told |= picture_of(model)
        return told

    def names(self) -> Names:
        """Returns at what it can be stopped."""
        return names_of_program(self._models(), self._listing, self._source, Path(self._conductor.link.start.folder))

    def touches(self) -> Touches:
        """Returns nothing: there are no bodies."""
        return frozenset()

    def _models(self) -> Iterator[Any]:
        for run in self._limits.trace.runs if self._limits.trace is not None else ():
            if run.model is not None:
                yield run.model
