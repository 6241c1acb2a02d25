"""A run of what a model file builds: agents and bodies in a world, which can go back and continue differently."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

from actr3d.actr.kernel.run_limits import EndOfRun, RunLimits, fresh_seed
from actr3d.actr.loading.global_seed import shared_random
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.clock import MICROSECONDS, microseconds, seconds
from actr3d.configuration import Live
from actr3d.errors import SimulationError
from actr3d.runner.facts import built_facts
from actr3d.runner.model_factory import Blueprint
from actr3d.runner.model_stdout import BuiltOutput
from actr3d.runner.traceback_report import failure
from actr3d.simulation import Command, Simulation
from actr3d.trace import Trace
from actr3d.values import to_json
from workbench.live_parameters import parameter_set_by
from workbench.loader import ModelListing
from workbench.worker.change_menu import change_menu
from workbench.worker.controlled_run import ControlledRun, nothing_to_undo
from workbench.worker.error_report import UNFORESEEN, describe_error, notice_of
from workbench.worker.helper_messages import helpers_of
from workbench.worker.kept_branch import KeptBranch
from workbench.worker.known_run import KnownRun
from workbench.worker.messages import Facts
from workbench.worker.names import Names, Top, names_of
from workbench.worker.run_controller import RunController
from workbench.worker.simulation_display import SimulationDisplay

BLOCK = 0.008
"""How long the run continues before it checks for commands of users [s], approximately."""
MAX_TICKS = 64
"""The maximum number of ticks before it checks."""
ENDINGS = {"stop": "the model called stop()", "done": "no agent has anything left to do"}


class SimulationRun(ControlledRun):
    """Runs a simulation under a controller."""

    def __init__(self, controller: RunController, listing: ModelListing) -> None:
        self._controller = controller
        self._listing = listing
        self._commands: Sequence[Command] = []
        self._changed: dict[str, Any] = {}
        """The values of parameters that these commands of users have set."""
        self._start = controller.channel.start
        self._tick_time = 0.0
        self._end: tuple[int, str] | None = None
        """At which tick the run is over, and why, once that is known."""
        self._failed = False
        self._failed_at: int | None = None
        """When the tick after the last whole one fails [us], if that is known."""
        self._known_run: KnownRun | None = None
        """The recorded run that is repeated."""
        self._simulation: Simulation
        self._shown: SimulationDisplay

    def play(self) -> None:
        """Builds the simulation and runs it until the worker must stop.

        Raises:
            Exception: What the model raises in being built.
        """
        start = self._start
        limits = RunLimits(seed=fresh_seed() if start.seed is None else start.seed)
        held = helpers_of(self._controller.channel, start.helpers)
        with limits, suppress(EndOfRun), shared_random(limits.program_seed), held as helpers, BuiltOutput() as output:
            simulation, parameters = Blueprint(start.source, start.path, Path(start.folder), helpers).build(start.settings)
            output.attach_to(simulation)
            self._simulation, self._shown = simulation, SimulationDisplay(simulation)
            self._prepare(limits, parameters, helpers)
            if simulation.world.bodies:
                self._controller.use_real_time()
            try:
                self._controller.channel.post(self._facts(limits.program_seed, parameters))
                self._controller.set_run(self)
                if self._known_run is not None:
                    self._controller.repeat_recorded(self._known_run)
                self._controller.show()
                self._controller.channel.flush()  # before the model does anything that could prevent it
                while True:
                    self._controller.attend()
                    self._go_on()
            finally:
                self._close_recording(left=self._controller.leaving)

    def _prepare(self, limits: RunLimits, parameters: dict[str, Any], helpers: HelperTexts) -> None:
        simulation, start = self._simulation, self._start
        simulation.traced()
        if start.record is not None:
            facts = built_facts(start.path, start.source, parameters, limits.program_seed, limits.until, helpers.loaded)
            record = partial(simulation.record, start.record, **{**facts, "named": Path(start.record).stem})
            self._begin_recording(record, may_fail=start.recorded is not None)
            helpers.on_load = lambda loaded: self._record(helpers=loaded)  # an agent may import one later
        if start.recorded is not None:
            self._known_run = known_run = KnownRun(Path(start.recorded), self._shown.kept.states.add_recorded)
            if self._recording is not None:
                for command in start.commands:
                    self._recording.command(*command)
            simulation.plan([Command.from_data(tick, data) for _, tick, data in start.commands], known_run.ticks)
            ended: dict[str, Any] | None = known_run.facts.get("ended")
            if ended is not None and ended.get("by") in ENDINGS:
                self._end = known_run.ticks, str(ended["by"])
            if known_run.facts.get("failed") is not None:
                self._failed_at = known_run.time

    def _facts(self, seed: int | str, parameters: dict[str, Any]) -> Facts:
        return Facts(
            kind="simulation",
            seed=seed,
            period=self._simulation.period,
            parameters=to_json(parameters).encode(),
            world=to_json(self._shown.world(self._listing.parameters)).encode(),
            initial_widths=to_json([(1, self._shown.initial_widths)]).encode(),
            mj_model=self._shown.mj_model,
            changes=change_menu(agents_only=False),
            live=to_json(
                [{"name": one.name, "unit": one.unit, **asdict(one.live)} for one in self._listing.parameters if one.live is not None]
            ).encode(),
        )

    def _go_on(self) -> None:
        """Runs a few ticks, and reports the end or the failure to the controller."""
        controller, simulation = self._controller, self._simulation
        try:
            over = self.run_ticks()
            if over is not None:
                self._conclude()
        except UNFORESEEN as error:
            if controller.channel.left:
                raise  # in a copy of the process that the model has made, which ends with it
            controller.channel.post(notice_of(error))
            self._record_failure(failure(error))
            controller.end("failed", describe_error(error))
            return
        controller.after_ticks()
        if over is None:
            controller.pace(self.clock)
            return
        self._end = simulation.ticks, over
        self._record(ended={"by": over}, whole=True)
        controller.end("ended", ENDINGS[over])

    def run_ticks(self) -> str | None:
        """Runs a few ticks; returns why the run is over, if it is.

        Raises:
            Exception: What the simulation raises.
        """
        simulation = self._simulation
        begin, first = perf_counter(), simulation.ticks
        over = simulation.advance(self._allowance())  # it ends at the same tick however many are done at once
        self._tick_time = (perf_counter() - begin) / max(1, simulation.ticks - first)
        return over

    def _conclude(self) -> None:
        """Records the result, then the last output, in the order of a replay."""
        self._simulation.conclude()
        self._simulation.event_log.stdout.finish()

    def _allowance(self) -> int:
        """Returns the number of ticks until the next check for commands of users."""
        controller = self._controller
        if controller.watch.fine:
            return 1
        most = min(MAX_TICKS, int(BLOCK / self._tick_time)) if self._tick_time > 0 else 1
        if controller.pacer.factor is not None:
            most = min(most, int(controller.pacer.factor * BLOCK * MICROSECONDS / self.period))
        if controller.watch.goal is not None:
            most = min(most, -(-(controller.watch.goal - self.clock) // self.period))
        return max(1, most)

    # -- calls from the controller; `ControlledRun` describes them

    @property
    def clock(self) -> int:
        return self._simulation.timeline.lockstep.agents.time  # after a failure also within a tick

    @property
    def furthest(self) -> int:
        return max(microseconds(self._simulation.furthest), self._failed_at or 0)

    @property
    def period(self) -> int:
        return microseconds(self._simulation.period)

    @property
    def trace(self) -> Trace:
        trace = self._simulation.trace
        assert trace is not None, "a simulation that was prepared has one"
        return trace

    @property
    def shown(self) -> SimulationDisplay:
        return self._shown

    def go_to(self, time: int) -> None:
        last = self._simulation.timeline.furthest
        if self.clock > last * self.period:
            self._failed_at = self.clock
        fails = self._failed_at is not None and last * self.period < time <= self._failed_at
        tick = last if fails else round(time / self.period)
        self._move(lambda: self._simulation.seek(seconds(tick * self.period)))
        if fails:
            try:
                self._simulation.advance(1)
            except UNFORESEEN as error:
                self._controller.end("failed", describe_error(error))
                return
        if self._end is None or tick != self._end[0]:
            self._controller.went_back()
            return
        self._conclude()
        self._controller.end("ended", ENDINGS[self._end[1]])

    def _move(self, move: Callable[[], None]) -> None:
        """Goes to another time; reports a failure if the run does not repeat itself on the way."""
        try:
            move()
        except SimulationError as error:
            if self._simulation.timeline.lockstep.broken:
                self._controller.end("failed", str(error))
                self._controller.show()
            raise

    def live_parameter(self, name: str, value: Any) -> Live:
        parameter = self._listing.parameter(name)
        if parameter.live is None:
            raise SimulationError(f"'{name}' cannot change while a run goes on; restart it with the new value")
        parameter.check(value)
        return parameter.live

    def change(self, word: str, values: tuple[Any, ...], named: Mapping[str, Any], body: str | None, *, drop: bool) -> None:
        set_by = parameter_set_by(self._listing.parameters, word, values, named, body)
        if set_by is not None:
            parameter, value = set_by
            parameter.check(value)
        before = len(self.trace)
        branch = KeptBranch(self._controller, self._recording, self.clock, self.furthest, drop=drop)
        try:
            self._simulation.command(word, *values, body=body, **named)
        except BaseException:
            branch.undo()
            raise
        self._forget_end()
        branch.announce(before)

    def undo(self, *, drop: bool) -> None:
        latest = self._simulation.timeline.latest
        if latest is None:
            raise nothing_to_undo(self.clock)
        branch = KeptBranch(self._controller, self._recording, latest.tick * self.period, self.furthest, drop=drop)
        try:
            self._move(self._simulation.undo)
        except BaseException:
            branch.undo()
            raise
        self._forget_end()
        branch.announce_undone()

    def _forget_end(self) -> None:
        """Forgets how the run ended or failed, because it continues differently now."""
        self._failed_at = None
        if self._failed:
            self._record_failure(None)
        if self._end is not None:
            self._end = None
            self._record(ended=None, whole=None)

    def changed_parameters(self) -> dict[str, Any]:
        commands = self._simulation.timeline.commands
        if commands != self._commands:
            found = (parameter_set_by(self._listing.parameters, one.word, one.values, one.named, one.body) for one in commands)
            self._changed = {one[0].name: one[1] for one in found if one is not None}
            self._commands = commands
        return self._changed

    def _record_failure(self, text: str | None) -> None:
        """Records the exception of the model; None if the run continues differently now."""
        self._failed = text is not None
        self._record(failed=text)

    def finish_output(self) -> None:
        self._simulation.event_log.stdout.finish()

    def forget_ahead(self) -> None:
        self._simulation.forget_ahead()
        self._shown.kept.cut(self._simulation.ticks)
        self._failed_at = None
        if self._end is not None and self._end[0] > self._simulation.ticks:
            self._end = None

    def tops(self) -> list[Top]:
        return [Top(agent) for agent in self._simulation.agents.values()]

    def body_curves(self, names: Sequence[str] | None, first: float, last: float | None, most: int) -> dict[str, Any]:
        return self._shown.curves(names, first, last, most)

    def names(self) -> Names:
        return names_of(self.tops(), self._simulation.world.bodies)


def check(source: str, filename: str, folder: Path) -> None:
    """Loads a model, builds what it describes with its defaults, and runs one tick, at whose beginning productions are checked."""
    with RunLimits(seed=0), BuiltOutput():
        simulation, _ = Blueprint(source, filename, folder).build({})
        simulation.advance(1)
