"""A run of a program, with the simulations that it makes. It goes back by being run again from its start, with the same seed."""

from __future__ import annotations

from array import array
from collections import Counter, defaultdict, deque
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager, nullcontext, suppress
from functools import partial
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from typing import Any

from actr3d.actr.kernel.run_limits import Contacts, EndOfRun, RunLimits, fresh_seed
from actr3d.actr.kernel.scheduler import Scheduler
from actr3d.actr.kernel.tree import children_of
from actr3d.actr.loading import run_text
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.sweep import with_values
from actr3d.clock import seconds
from actr3d.configuration import Live
from actr3d.errors import SimulationError
from actr3d.recording import Recording
from actr3d.recording.reader import RecordedCommand
from actr3d.recording.writer import State as RecordedState
from actr3d.runner.facts import program_facts
from actr3d.runner.model_stdout import ProgramOutput
from actr3d.runner.program_changes import ProgramChanges
from actr3d.runner.traceback_report import failure
from actr3d.simulation import Simulation
from actr3d.trace import Run, Trace, TraceEvent, run_of, top_path
from actr3d.values import to_json
from workbench.curves import joined
from workbench.loader import ModelListing
from workbench.made_simulations import makes_simulations
from workbench.program_time import RunTimes
from workbench.time_text import time_text
from workbench.worker.change_menu import change_menu
from workbench.worker.controlled_run import ControlledRun, nothing_to_undo
from workbench.worker.error_report import UNFORESEEN, describe_error, notice_of
from workbench.worker.helper_messages import helpers_of
from workbench.worker.kept_branch import KeptBranch
from workbench.worker.known_run import KnownRun
from workbench.worker.messages import ENDED, Facts
from workbench.worker.names import Names, Top, names_of_program
from workbench.worker.run_controller import Leaving, RunController
from workbench.worker.simulation_display import SimulationDisplay
from workbench.worker.state_history import MAX_SIMULATIONS, StateHistory

PERIOD = 10_000
"""The length of a step [us]: that of a tick of a simulation."""
MAX_RUNS = 8
"""How many of the models that a program makes are shown: the latest ones."""


class _Again(EndOfRun):
    """Ends a program so that it can be run again up to an earlier time."""


class _PassRecorder:
    """Passes what a program does to its recording, except what an earlier pass through it has recorded; the order is always the same.

    Args:
        recording: The recording with the items of earlier passes.
        known: The names of the facts of simulations that are recorded; passes share it.
        left: Returns whether the program is being left: what it does then, as in `finally`, is not recorded.
    """

    def __init__(self, recording: Recording, known: set[str], left: Callable[[], bool]) -> None:
        self._recording = recording
        self._known = known
        self._begun: set[str] = set()
        """The names of those that have begun in this pass."""
        self._left = left
        self._counts: Counter[str] = Counter()
        self._held: list[Callable[[], object]] | None = None
        """Writes the items of a change that is being made; None otherwise."""

    @contextmanager
    def changing(self) -> Generator[None]:
        """Makes a change of a user in the block; if it succeeds, what an earlier pass has recorded after the present is removed."""
        counts = self._counts.copy()
        self._held = []
        try:
            yield
            self._cut(counts["event"], counts["command"])
        except BaseException:
            self._held.clear()
            raise
        finally:
            held, self._held = self._held, None
            for write in held:
                write()

    def cut(self) -> None:
        """Removes what an earlier pass has recorded after the present."""
        self._cut(self._counts["event"], self._counts["command"])

    def _cut(self, events: int, commands: int) -> None:
        """Removes what an earlier pass has recorded after a number of events and commands."""
        recording = self._recording
        if recording.events > events or recording.commands > commands:
            recording.cut(self._counts["state"] - 1, events, self._counts["answer"], commands)
        for name in self._known - self._begun:
            recording.fact(name, None)
        self._known &= self._begun

    def _is_new(self, sort: str, recorded: int) -> bool:
        """Counts an item of a sort; returns whether it is to be recorded, given how many are recorded already."""
        self._counts[sort] += 1
        return self._counts[sort] > recorded and not self._left()

    def fact(self, name: str, value: Any) -> None:
        self._begun.add(name)
        if name not in self._known and not self._left():
            self._known.add(name)
            self._recording.fact(name, value)

    def event(self, event: TraceEvent) -> None:
        new = self._is_new("event", self._recording.events)
        if self._held is not None:
            self._held.append(lambda: self._recording.event(event))  # whatever becomes of the recording, the change is made
        elif new:
            self._recording.event_alone(event)

    def state(self, run: int, tick: int, data: bytes, contacts: Contacts) -> None:
        if self._is_new("state", self._recording.states):
            self._recording.state(run, tick, data, contacts)

    def answer(self, run: int, tick: int, body: str, word: str, value: Any) -> None:
        if self._is_new("answer", self._recording.answers):
            self._recording.answer(run, tick, body, word, value)

    def command(self, run: int, tick: int, data: Mapping[str, Any]) -> None:
        new = self._is_new("command", self._recording.commands)
        if self._held is not None:
            self._held.append(lambda: self._recording.command(run, tick, data))
        elif new:
            self._recording.command(run, tick, data)


class ProgramRun(ControlledRun):
    """Runs a program under a controller; its time is that of all its runs, one after the other."""

    def __init__(self, controller: RunController, listing: ModelListing) -> None:
        start = controller.channel.start
        self._controller = controller
        self._listing = listing
        self._source = with_values(start.source, start.settings)
        self._simulates = makes_simulations(self._source, Path(start.folder), start.helpers)
        self._seed = fresh_seed() if start.seed is None else start.seed
        self._output: ProgramOutput | None = None
        self._furthest: int = 0
        self._seek_to: int | None = None
        """The time up to which it runs without being shown or paused [us]."""
        self._over = False
        """Whether the program has been at its end."""
        self._introduced = False
        """Whether the server knows that the run has begun."""
        self._simulations: dict[int, tuple[SimulationDisplay, int]] = {}
        """Those nearest to the present by number, and when each began [us]. They are kept when the program is run again: the stored past of
        a simulation is passed on to the one that begins in its place."""
        self._initial_widths: dict[int, dict[str, float]] = {}
        """The widths of apertures at the start of each simulation [m], by its number among all runs; kept likewise."""
        self._scene: tuple[bytes | None, bytes, bytes] = (None, b"null", b"[]")
        """The compiled scene, the world, and the widths at the start of simulations that the server knows."""
        self._scene_of: SimulationDisplay | None = None
        """The simulation that was shown last."""
        self._ahead: dict[int, StateHistory] = {}
        """The recorded states of simulations that have not begun yet in this repetition of a recording, by their number among all runs."""
        self._commands: list[RecordedCommand] = [RecordedCommand(*command) for command in start.commands]
        """The changes of users, which each pass through the program repeats."""
        self._recorded_simulations: set[str] = set()
        """The names of the facts of simulations that are recorded."""
        self._undoing: KeptBranch | None = None
        """While the program is run again up to a change that a user has undone: what is kept of its future."""
        self._helpers: dict[str, Sequence[str]] = dict(start.helpers)
        """The helper modules as they were the first time; see `actr3d.actr.loading.helper_modules`."""
        self._begin_pass()

    def _begin_pass(self) -> None:
        """Sets what each pass through the program begins with."""
        self._again = False
        self._clock: int = 0
        self._tick_begin: int | None = None
        """While a simulation ticks: its own time at the start of the tick [us], which is the time of the clock."""
        self._event_times = array("q")
        """The time of the clock at each event [us]."""
        self._run_times: defaultdict[int, RunTimes] = defaultdict(RunTimes)
        """The times of each run, by its number."""
        self._failed = ""
        """The memory from which the last retrieval failed; empty if it did not, or if a production has fired since."""
        self._begun = 0
        """The number of simulations that have begun."""
        self._held: deque[tuple[int, Run, Any]] = deque(maxlen=MAX_RUNS)
        """The latest runs: number, run and model."""
        self._runs = 0
        """How many runs there have been."""
        self._shown: SimulationDisplay | None = None
        """The simulation that has ticked last."""
        self._waits: tuple[Scheduler, int, int] | None = None
        """While a model without a body waits for its time to pass: its scheduler, the time of its latest event [us], and the time of the
        program then [us]."""
        self._ticked: Simulation | None = None
        """While a simulation waits for its next tick: this simulation."""
        self._made_at: list[int] = []
        """When each of the known changes up to the present was made: the time of the program [us]."""
        self._changed = False
        """Whether a user has changed something whose effects of the moment have not happened yet."""
        trace = Trace("all")
        trace.listen(self._note_time)
        trace.listen(self._note_failure)
        self._limits = RunLimits(seed=self._seed, trace=trace, passing=self._pass, ticked=self._tick)
        self._recorded: _PassRecorder | None = None
        if self._recording is not None:
            self._recorded = _PassRecorder(self._recording, self._recorded_simulations, lambda: self._left)
            self._limits.recorder = self._recorded
            trace.listen(self._recorded.event)
        self._changes = ProgramChanges(self._limits, self._commands)

    def play(self) -> None:
        """Runs the program, and again if a user goes back, until the worker must stop."""
        start, controller = self._controller.channel.start, self._controller
        if not self._simulates:
            self._introduce()
        try:
            if start.record is not None:
                facts = program_facts(start.path, self._source, self._seed, None)
                record = partial(Recording, start.record, {**facts, "named": Path(start.record).stem})
                self._begin_recording(record, may_fail=start.recorded is not None)
            while not controller.leaving:
                self._run_once()
                with suppress(_Again):
                    while not (self._again or controller.leaving):
                        controller.attend()
        except Leaving:
            pass
        finally:
            self.flush()
            self._close_recording(left=controller.leaving)

    def _show_recorded(self) -> None:
        """Shows the whole timeline of a recorded run that is run again."""
        recorded = self._controller.channel.start.recorded
        if recorded is not None:
            ahead: dict[int, StateHistory] = {}

            def keep(state: RecordedState) -> None:
                if state.run in ahead or len(ahead) < MAX_SIMULATIONS:
                    ahead.setdefault(state.run, StateHistory()).add_recorded(state)

            known_run = KnownRun(Path(recorded), keep)
            self._ahead = ahead
            if self._shown is not None:
                self._take_ahead(self._shown)
            self._furthest = max(self._furthest, known_run.time)
            self._controller.repeat_recorded(known_run)

    def _take_ahead(self, shown: SimulationDisplay) -> None:
        """Passes to a simulation what is recorded of its past and future."""
        number = shown.simulation.event_log.number
        if number is not None:
            shown.kept.states = self._ahead.pop(number, shown.kept.states)

    def _introduce(self) -> None:
        """Informs the server that the run has begun; for a program that makes a simulation, once this simulation is at its start."""
        if not self._introduced:
            self._introduced = True
            self._send_facts()
            self._controller.set_run(self)
            if self._shown is not None and self._shown.simulation.world.bodies:
                self._controller.use_real_time()
            self._show_recorded()
            if self._simulates:
                self._controller.show()
                self._controller.channel.flush()  # before the program does anything that could prevent it

    def _send_facts(self) -> None:
        known = {parameter.name: parameter.default for parameter in self._listing.parameters}
        self._scene = mj_model, world, initial_widths = self._scene_now()
        facts = Facts(
            kind="program",
            seed=self._seed,
            period=seconds(self.period),
            parameters=to_json({**known, **self._controller.channel.start.settings}).encode(),
            world=world,
            initial_widths=initial_widths,
            changes=change_menu(agents_only=self._shown is None),
            mj_model=mj_model,
        )
        self._controller.channel.post(facts)

    def _scene_now(self) -> tuple[bytes | None, bytes, bytes]:
        if self._shown is None:
            return None, b"null", b"[]"
        initial_widths = [next(same) for _, same in groupby(sorted(self._initial_widths.items()), key=itemgetter(1))]
        return self._shown.mj_model, to_json(self._shown.world(self._listing.parameters)).encode(), to_json(initial_widths).encode()

    def _run_once(self) -> None:
        """Runs the program from its start to its end, or until it is left."""
        controller = self._controller
        self._begin_pass()
        limits = self._limits
        if not self._simulates:  # otherwise it continues until its simulation is at its start
            self._hold_at_start()
        exited: SystemExit | None = None
        try:
            with helpers_of(controller.channel, self._helpers) as helpers, ProgramOutput(limits) as output:
                self._output = output
                helpers.on_load = self._keep_helpers
                if not self._again:
                    exited = self._run_text(limits, helpers)
                if not self._left:
                    output.finish()
        except _Again:
            return
        except UNFORESEEN as error:
            if controller.channel.left:
                raise  # in a copy of the process that the model has made, which ends with it
            if self._left:
                return
            self._introduce()
            controller.channel.post(notice_of(error))
            self._record(failed=failure(error))
            self._end("failed", describe_error(error))
            return
        if self._left:
            return
        self._record(ended={"by": "end" if exited is None else "exit"})
        if exited is None or not exited.code:
            failed = f"; a retrieval from {self._failed} failed, and no production fired after it" if self._failed else ""
            self._end("ended", f"the program is over{failed}")
        else:
            self._introduce()
            controller.channel.post(notice_of(exited))
            self._end("failed", describe_error(exited))

    def _note_time(self, event: TraceEvent) -> None:
        """Stores when an event happens: now, or within the tick of a simulation."""
        since = 0 if self._tick_begin is None else event.time_us - self._tick_begin
        time = self._clock + (since if 0 <= since <= self.period else 0)
        self._event_times.append(time)
        if event.kind != "output":  # which belongs to the program, and to none of its runs
            self._run_times[event.run].add(event.time_us, time)

    @property
    def _last_event(self) -> int:
        """The time of the clock at the last event [us]."""
        return self._event_times[-1] if self._event_times else 0

    def _note_failure(self, event: TraceEvent) -> None:
        """Stores whether a retrieval fails to which no production reacts."""
        if event.kind == "retrieval":
            self._failed = event.source if event.data["failed"] else ""
        elif event.kind == "fire":
            self._failed = ""

    def _hold_at_start(self) -> None:
        """Waits before the program begins, unless it is being run again to reach a later moment."""
        controller = self._controller
        if self._seek_to == 0 and self._undoing is None:
            self._arrive()
        if self._seek_to is None:
            controller.show()
            controller.channel.flush()  # before the program does anything that could prevent it
            with suppress(_Again):
                controller.attend()

    def _run_text(self, limits: RunLimits, helpers: HelperTexts) -> SystemExit | None:
        """Runs the program; returns its `SystemExit`, if it raised one."""
        start = self._controller.channel.start
        try:
            run_text(self._source, start.path, limits=limits, folder=Path(start.folder), helpers=helpers)
        except SystemExit as end:
            if self._controller.channel.left:
                raise
            return end
        return None

    @property
    def _left(self) -> bool:
        """Whether it is ended from outside, before its own end."""
        return self._again or self._controller.leaving

    def _end(self, status: Any, reason: str) -> None:
        self._seek_to = None
        if self._undoing is not None:
            self._finish_undo(self._undoing)  # it did not get there: it differs from the first time
        self._over = True
        self._introduce()
        self._clock = max(self._clock, self._last_event)
        self._furthest = max(self._furthest, self._clock)
        self._controller.end(status, reason)

    def _keep_helpers(self, loaded: Mapping[str, Sequence[str]]) -> None:
        new = {name: text for name, text in loaded.items() if name not in self._helpers}
        self._helpers |= new
        if new:
            self._record(helpers=self._helpers)

    def _pass(self, sch: Scheduler, end: int) -> bool:
        """Paces a model without a body: delays the program until the controller lets it continue; returns whether a user has changed it."""
        controller = self._controller
        if controller.channel.left:
            return False  # in a copy of the process that the model has made, which nobody watches
        self._introduce()
        self._hold_models()
        self._tick_begin = None
        if self._changed:  # its effects of the moment have happened
            self._changed = False
            controller.show()
        self._clock = max(self._clock, self._last_event)  # a tick of a simulation that failed counts up to its last event
        due = self._changes.due(sch, end)
        to = self._clock + (end if due is None else due) - sch.now_us
        self._waits = sch, sch.now_us, self._clock
        try:
            self._wait(to, again=due is not None)
        finally:
            self._waits = None
        if self._changed:
            return True
        if due is None or not self._changes.repeat(sch, end):
            return False
        self._note_made()
        return True

    def _note_made(self) -> None:
        """Stores when changes were made: now."""
        self._made_at += [self._clock] * (self._changes.made - len(self._made_at))

    def _arrive(self) -> None:
        """Pauses the program, which has reached the time that the user wants; if the user undoes a change, completes that."""
        self._seek_to = None
        if self._undoing is None:
            self._controller.went_back()
        else:
            self._finish_undo(self._undoing)

    def _finish_undo(self, branch: KeptBranch) -> None:
        """Completes the undoing of a change: the program is where it was before the change, and what came after that is forgotten."""
        self._undoing = None
        if self._recorded is not None:
            self._recorded.cut()
        self._continue_differently()
        branch.announce_undone()

    def _wait(self, to: int, *, again: bool) -> None:
        """Waits until the program may continue to a time [us], or a user has changed something before it.

        Args:
            to: The time.
            again: Whether a known change is repeated at that time; a user who goes to that time sees the moment before the change.
        """
        controller = self._controller
        while True:
            self._check_left()
            if self._seek_to is not None:
                # While a change is undone, the other changes of that moment are repeated before the program pauses.
                if to < self._seek_to or (to == self._seek_to and (not again or self._undoing is not None)):
                    self._clock = to
                    if self._goes_on():
                        return
                    continue
                self._clock = self._seek_to
                self._arrive()
            controller.attend()
            if self._again or self._seek_to is not None:
                continue
            if self._changed or (again and self._clock == to):
                return
            goal = controller.watch.goal
            stop = to if goal is None else min(to, goal)
            if not controller.pace(stop):
                continue
            self._clock = stop
            self._furthest = max(self._furthest, stop)
            controller.show_if_due()
            if stop == to and not again:
                return

    def _tick(self, simulation: Simulation, passed: int) -> None:
        """Processes that a simulation has ticked, or is about to begin; delays the program until it may continue."""
        controller = self._controller
        if controller.channel.left:
            return  # in a copy of the process that the model has made, which nobody watches
        self._show(simulation)
        self._hold_models()
        self._introduce()
        self._clock = max(self._clock + passed, self._last_event)
        self._tick_begin = simulation.ticks * self.period
        self._changes.count(simulation, passed)
        self._check_left()
        self._ticked = simulation
        try:
            self._wait_for_tick(simulation)
        finally:
            self._ticked = None
        self._repeat_in(simulation)

    def _wait_for_tick(self, simulation: Simulation) -> None:
        """Waits until a simulation may continue."""
        controller = self._controller
        self._furthest = max(self._furthest, self._clock)
        if self._seek_to is None:
            controller.after_ticks()
        while True:
            if self._seek_to is not None:
                if self._clock < self._seek_to:
                    if self._goes_on():
                        return
                    continue
                if self._undoing is not None and self._clock == self._seek_to:
                    self._repeat_in(simulation)  # the changes of that moment that are not undone come before the one that is
                    if self._changes.made < len(self._changes.known):
                        return  # they are those of another simulation, which begins at that moment
                self._arrive()
            controller.attend()
            if self._seek_to is None and controller.pace(self._clock):
                return

    def _repeat_in(self, simulation: Simulation) -> None:
        """Repeats the known changes of the present moment of a simulation."""
        self._changes.repeat_in(simulation)
        self._note_made()

    def _check_left(self) -> None:
        """Ends the program at the tick where it is to be left, even if it catches the exception and continues.

        Raises:
            EndOfRun: If it is to be left.
        """
        if self._controller.leaving:
            raise Leaving
        if self._again:
            raise _Again

    def _show(self, simulation: Simulation) -> None:
        """Shows this simulation from now on."""
        if self._shown is not None and self._shown.simulation is simulation:
            return
        self._shown = next((shown for shown, _ in self._simulations.values() if shown.simulation is simulation), None)
        if self._shown is None:
            with suppress(SimulationError):  # it has begun already; its past cannot be explained then
                simulation.traced()
            self._begun += 1
            earlier = self._simulations.get(self._begun)
            self._shown = shown = SimulationDisplay(simulation, None if earlier is None else earlier[0].kept)
            self._take_ahead(shown)
            self._simulations[self._begun] = shown, self._clock
            self._initial_widths[simulation.event_log.number or 1] = shown.initial_widths
            if len(self._simulations) > MAX_SIMULATIONS:
                del self._simulations[max(self._simulations, key=lambda number: abs(number - self._begun))]

    # -- calls from the controller; `ControlledRun` describes them

    @property
    def clock(self) -> int:
        return self._clock

    @property
    def furthest(self) -> int:
        return self._furthest

    @property
    def target(self) -> int | None:
        return self._seek_to

    @property
    def period(self) -> int:
        return PERIOD if self._shown is None else self._shown.period

    @property
    def trace(self) -> Trace:
        trace = self._limits.trace
        assert trace is not None, "each pass has one"
        return trace

    def events(self, first: int, end: int) -> list[TraceEvent]:
        times = self._event_times[first:end]  # of an event that another thread is adding there may be none yet
        return [TraceEvent(time, *event[1:]) for event, time in zip(super().events(first, end), times, strict=False)]

    def own_time(self, source: str, time: int) -> int | None:
        found = self._run_times[run_of(source)].own_at(time)
        return None if found is None else found[0]

    def whole_time(self, source: str, time: int) -> int:
        return self._run_times[run_of(source)].program_at(time)

    @property
    def shown(self) -> SimulationDisplay | None:
        return self._shown

    def live_parameter(self, name: str, value: Any) -> Live:
        raise SimulationError(f"'{name}': the parameters of a program cannot change while it runs; restart it with the new value")

    def change(self, word: str, values: tuple[Any, ...], named: Mapping[str, Any], body: str | None, *, drop: bool) -> None:
        make = self._change_now(word, values, named, body)
        before = len(self.trace)
        self.flush()
        branch = KeptBranch(self._controller, self._recording, self._clock, self._furthest, drop=drop)
        try:
            with self._recorded.changing() if self._recorded is not None else nullcontext():
                make()
        except BaseException:
            branch.undo()
            raise
        self._commands = self._changes.known
        self._note_made()
        if self._waits is not None:
            sch, _, _ = self._waits
            self._waits = sch, sch.now_us, self._clock
            self._changed = True
            self._controller.interrupt()
        self._continue_differently()
        branch.announce(before)

    def _change_now(self, word: str, values: tuple[Any, ...], named: Mapping[str, Any], body: str | None) -> Callable[[], None]:
        """Returns a function that makes a change at the present moment.

        Raises:
            SimulationError: If there is nothing that can be changed, or the command is not for an agent without a body that runs now.
        """
        changes = self._changes
        if self._ticked is not None:
            _ = self._ticked.agents  # they are made before what is recorded after the present is removed
            return partial(changes.make_in, self._ticked, word, values, named, body)
        if body is not None:
            raise SimulationError(f"'{word}' cannot be done: no simulation runs at this moment, but an agent without a body")
        changes.check(word)
        if self._waits is None:
            raise SimulationError(f"'{word}' cannot be done: the program has not begun, so there is no agent yet; step once first")
        sch, begin, clock = self._waits
        return partial(changes.make, sch, begin + self._clock - clock, word, values, named)

    def undo(self, *, drop: bool) -> None:
        changes = self._changes
        known = changes.made
        if self._ticked is not None:
            known = changes.up_to_now(self._ticked)
        elif self._waits is not None:
            sch, begin, clock = self._waits
            known = changes.up_to(sch, begin + self._clock - clock)
        if known == 0:
            raise nothing_to_undo(self._clock)
        moment = self._clock if known > changes.made else self._made_at[known - 1]
        self.flush()
        self._undoing = KeptBranch(self._controller, self._recording, moment, self._furthest, drop=drop)
        self._commands = changes.known[: known - 1]
        self._begin_seek(moment)
        self._again = True
        raise _Again

    def _continue_differently(self) -> None:
        """Forgets what lay ahead of the program, also how it ended."""
        self.forget_ahead()
        if self._over:
            self._over = False
            self._record(ended=None, failed=None)
        self.flush()

    def go_to(self, time: int) -> None:
        if time > self._furthest:
            raise SimulationError(f"the run has only reached {time_text(seconds(self._furthest))}; continue it instead")
        over = self._controller.status in ENDED
        if over and time == self._clock:
            return  # it is there
        self._begin_seek(time)
        if over or time < self._clock:
            self._again = True
            raise _Again

    def _begin_seek(self, time: int) -> None:
        """Starts to seek to another time [us]."""
        self._seek_to = time
        self._controller.begin_seek(f"going to {time_text(seconds(time), longest=seconds(self._furthest))}")

    def _goes_on(self) -> bool:
        """Carries out commands during a seek; returns whether the program still goes there, and was not paused
        or sent elsewhere."""
        wanted = self._seek_to
        self._controller.attend_seek(cancellable=self._undoing is None)
        if self._controller.status != "running":
            self._seek_to = None
        return self._seek_to == wanted

    def flush(self) -> None:
        self._record(reached=seconds(self._furthest))
        super().flush()

    def finish_output(self) -> None:
        if self._output is not None:
            self._output.finish()

    def forget_ahead(self) -> None:
        self._furthest = self._clock
        self._ahead.clear()
        for number in [number for number in self._simulations if number > self._begun]:
            del self._simulations[number]
        if self._shown is not None:
            self._shown.kept.cut(self._shown.simulation.ticks)

    def tops(self) -> list[Top]:
        self._hold_models()
        found: list[Top] = []
        for number, run, made in self._held:
            model = run.model or made
            # The environment of a simulation is its own; its children are agents.
            prefix = top_path(number) if number > 1 else ""
            found += [Top(agent, prefix) for agent in children_of(model)] if model.sch.in_lockstep else [Top(model)]
        return found

    def body_curves(self, names: Sequence[str] | None, first: float, last: float | None, most: int) -> dict[str, Any]:
        return joined(shown.curves(names, first, last, most, begin) for _, (shown, begin) in sorted(self._simulations.items()))

    def scene(self) -> tuple[bytes | None, dict[str, float]]:
        """Returns the state of the physics, and the widths of apertures [m]; first informs the server if the scene is another one."""
        if self._shown is not self._scene_of:
            self._scene_of = self._shown
            if self._scene_now() != self._scene:
                self._send_facts()
        return super().scene()

    def names(self) -> Names:
        bodies = () if self._shown is None else self._shown.simulation.world.bodies
        return names_of_program(self.tops(), bodies, self._listing, self._source, Path(self._controller.channel.start.folder))

    def _hold_models(self) -> None:
        """Keeps the latest models; otherwise garbage collection would decide which are shown."""
        for run in self.trace.runs[self._runs :]:
            self._runs += 1
            if run.model is not None:
                self._held.append((self._runs, run, run.model))
