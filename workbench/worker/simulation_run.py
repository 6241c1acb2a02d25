"""A run of what a model file builds: agents and bodies in a world, which can go back and another way."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

from actr3d.actr.explain.snapshot import snapshot_of
from actr3d.actr.kernel.run_limits import EndOfRun, RunLimits, fresh_seed
from actr3d.actr.loading.global_seed import shared_random
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.clock import MICROSECONDS, microseconds, seconds
from actr3d.errors import Actr3dError, SimulationError
from actr3d.parameter_schema import LiveCommand
from actr3d.recording import Recording
from actr3d.runner.facts import built_facts
from actr3d.runner.model_factory import build
from actr3d.runner.model_stdout import BuiltOutput
from actr3d.runner.traceback_report import failure
from actr3d.simulation import Command, Simulation
from actr3d.trace import Trace
from actr3d.values import to_json
from workbench.branches import new_branch, superfluous_branches
from workbench.loader import ModelListing
from workbench.worker.error_report import UNFORESEEN, describe_error, notice_of
from workbench.worker.helper_messages import helpers_of
from workbench.worker.known_run import KnownRun
from workbench.worker.messages import Branched, Facts
from workbench.worker.names import Names, names_of
from workbench.worker.run_controller import RunController
from workbench.worker.shown import Shown
from workbench.worker.stop_conditions import Touches
from workbench.worker.top_models import Top

BLOCK = 0.008
"""How long the run continues before it checks for commands of users [s], approximately."""
MOST_TICKS = 64
"""The maximum number of ticks before it checks."""
ENDINGS = {"stop": "the model called stop()", "done": "no agent has anything left to do"}


class SimulationRun:
    """Runs a simulation under a controller.

    Args:
        controller: Decides when it continues.
        listing: What the model's text says of itself.
    """

    def __init__(self, controller: RunController, listing: ModelListing) -> None:
        self._controller = controller
        self._listing = listing
        self._start = controller.channel.start
        self._recording: Recording | None = None
        self._tick_time = 0.0
        self._end: tuple[int, str] | None = None
        """At which tick the run is over, and why, once that is known."""
        self._failed = False
        self._known_run: KnownRun | None = None
        """The recorded run that is repeated."""
        self._simulation: Simulation
        self._shown: Shown

    def play(self) -> None:
        """Builds and runs it, until the worker is to leave.

        Raises:
            Exception: What the model raises in being built.
        """
        start = self._start
        limits = RunLimits(seed=fresh_seed() if start.seed is None else start.seed)
        held = helpers_of(self._controller.channel, start.helpers)
        with limits, suppress(EndOfRun), shared_random(limits.program_seed), held as helpers, BuiltOutput() as output:
            simulation, parameters = build(start.source, start.path, start.settings, Path(start.folder), helpers)
            output.lead_to(simulation)
            self._simulation, self._shown = simulation, Shown(simulation)
            self._prepare(limits, parameters, helpers)
            if simulation.world.bodies:
                self._controller.embodied()
            try:
                self._controller.channel.post(self._facts(limits, parameters))
                self._controller.set_run(self)
                if self._known_run is not None:
                    self._controller.repeat_recorded(self._known_run)
                self._controller.show()
                self._controller.channel.flush()  # whatever the model does next, that it was built is known
                while True:
                    self._controller.attend()
                    self._go_on()
            finally:
                if self._recording is not None:
                    if self._controller.leaving:
                        self._recording.leave()
                    self._recording.close()

    def _prepare(self, limits: RunLimits, parameters: dict[str, Any], helpers: HelperTexts) -> None:
        simulation, start = self._simulation, self._start
        simulation.traced()
        if start.record is not None:
            facts = built_facts(start.path, start.source, parameters, limits.program_seed, limits.until, helpers.loaded)
            self._recording = simulation.record(start.record, **facts)
            helpers.heard = partial(self._recording.fact, "helpers")  # an agent may import one later
        if start.recorded is not None:
            self._known_run = known_run = KnownRun(Path(start.recorded), self._shown.kept.states.add)
            simulation.plan([Command.from_data(tick, data) for tick, data in start.commands], known_run.ticks)
            ended: dict[str, Any] | None = known_run.facts.get("ended")
            if ended is not None and ended.get("by") in ENDINGS:
                self._end = known_run.ticks, str(ended["by"])

    def _facts(self, limits: RunLimits, parameters: dict[str, Any]) -> Facts:
        return Facts(
            kind="simulation",
            seed=limits.program_seed,
            period=self._simulation.period,
            parameters=to_json(parameters).encode(),
            world=to_json(self._shown.world(self._listing.parameters)).encode(),
            mj_model=self._shown.mj_model,
        )

    def _go_on(self) -> None:
        """Goes on by a few ticks."""
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
        controller.passed()
        if over is None:
            controller.pace(self.clock)
            return
        self._end = simulation.ticks, over
        if self._recording is not None:
            self._recording.fact("ended", {"by": over})
            self._recording.fact("whole", True)
        controller.end("ended", ENDINGS[over])

    def run_ticks(self) -> str | None:
        """Runs a few ticks; returns why the run is over, if it is.

        Raises:
            Exception: What the simulation raises.
        """
        simulation, over = self._simulation, None
        begin, first, last = perf_counter(), simulation.ticks, simulation.ticks + self._allowance()
        while over is None and simulation.ticks < last:  # it ends at the same tick however many are done at once
            simulation.step()
            over = simulation.over
        self._tick_time = (perf_counter() - begin) / max(1, simulation.ticks - first)
        return over

    def _conclude(self) -> None:
        """Records the result, then the last output, in the order of a replay."""
        self._simulation.conclude()
        self._simulation.event_log.stdout.finish()

    def _allowance(self) -> int:
        """Returns how many ticks to go before looking again what users want."""
        controller = self._controller
        if controller.watch.fine:
            return 1
        most = min(MOST_TICKS, int(BLOCK / self._tick_time)) if self._tick_time > 0 else 1
        if controller.pacer.factor is not None:
            most = min(most, int(controller.pacer.factor * BLOCK * MICROSECONDS / self.period))
        if controller.watch.goal is not None:
            most = min(most, -(-(controller.watch.goal - self.clock) // self.period))
        return max(1, most)

    # -- calls from the controller

    @property
    def clock(self) -> int:
        """How much time has passed since its start [us]."""
        return self._simulation.ticks * self.period

    @property
    def furthest(self) -> int:
        """How far it has come [us]."""
        return microseconds(self._simulation.furthest)

    @property
    def period(self) -> int:
        """A tick [us]."""
        return microseconds(self._simulation.period)

    @property
    def trace(self) -> Trace | None:
        """The trace up to now."""
        return self._simulation.trace

    @property
    def shown(self) -> Shown:
        """What is shown of the simulation."""
        return self._shown

    def go_to(self, time: int) -> None:
        """Goes to the tick that is nearest to a time [us].

        Raises:
            SimulationError: If the run has not been there, or does not repeat what it did; then it has failed.
        """
        tick = round(time / self.period)
        try:
            self._simulation.seek(seconds(tick * self.period))
        except SimulationError as error:
            if self._simulation.timeline.lockstep.broken:
                self._controller.end("failed", str(error))
                self._controller.show()
            raise
        if self._end is None or tick != self._end[0]:
            self._controller.went_back()
            return
        self._conclude()
        self._controller.end("ended", ENDINGS[self._end[1]])

    def live_parameter(self, name: str, value: Any) -> LiveCommand:
        """Returns how a parameter is changed during the run, after checking its new value.

        Raises:
            Actr3dError: If there is no such parameter, it cannot change during a run, or it cannot have this value.
        """
        parameter = self._listing.parameter(name)
        if parameter.live is None:
            raise SimulationError(f"'{name}' cannot change while a run goes on; restart it with the new value")
        parameter.check(value)
        return parameter.live

    def change(self, word: str, values: tuple[Any, ...], named: Mapping[str, Any], body: str | None, *, drop: bool) -> None:
        """Sends the simulation a command; the future of the run is kept as a branch, or dropped if `drop` is true.

        Raises:
            SimulationError: If the run is over, or what lies ahead cannot be kept and may not be lost.
            Exception: What the world, a body or an agent raises.
        """
        if self._controller.status == "ended":
            raise SimulationError("the run is over: go back to an earlier time, or restart it")
        trace = self._simulation.trace
        before = 0 if trace is None else len(trace)
        ahead = self.furthest > self.clock
        at, until = seconds(self.clock), seconds(self.furthest)
        repeated = Path(self._start.recorded) if self._start.recorded is not None and self._controller.repeats_recording else None
        branch = self._keep_branch(at, until, drop=drop) if ahead and repeated is None else None
        try:
            self._simulation.command(word, *values, body=body, **named)
        except BaseException:
            if branch is not None:
                branch.unlink(missing_ok=True)  # nothing has changed
            raise
        kept = branch or (repeated if ahead else None)  # a repeated run is kept by its own recording
        if branch is not None:
            for old in superfluous_branches(Path(self._start.record or "")):
                old.unlink(missing_ok=True)
        if self._failed:
            self._record_failure(None)
        if self._end is not None:
            self._end = None
            if self._recording is not None:
                self._recording.fact("ended", None)
                self._recording.fact("whole", None)
        if kept is not None:
            self.flush()  # pages list recordings again when they hear of the branch
            self._controller.channel.post(Branched(recording=kept.stem, at=at, until=until))
        kept_as = "the rest was lost" if kept is None else "a branch was kept" if branch else "the recording keeps the rest"
        self._controller.goes_another_way(before, f"changed at {at:.2f} s; {kept_as}" if ahead else None)

    def _keep_branch(self, at: float, until: float, *, drop: bool) -> Path | None:
        """Keeps what has been recorded of the run, before something is changed in its past. Returns the file; None where it may be lost.

        Raises:
            SimulationError: If it cannot be kept, and may not be lost.
        """
        ahead = f"what lies ahead, from {at:g} to {until:g} s,"
        if self._recording is None or self._start.record is None:
            if drop:
                return None
            raise SimulationError(f"the run is not recorded: {ahead} would be lost; go to its newest moment, or allow it with `drop`")
        path = new_branch(Path(self._start.record), at)
        try:
            self._recording.copy_to(path, branched=at)  # a fact stays with the branch whatever it is called
        except Actr3dError as error:
            if drop:
                return None
            raise SimulationError(f"nothing was changed, because {ahead} cannot be kept: {error}; allow to lose it with `drop`") from None
        return path

    def _record_failure(self, text: str | None) -> None:
        """Records the exception of the model; None if the run continues differently now."""
        self._failed = text is not None
        if self._recording is not None:
            self._recording.fact("failed", text)

    def finish_output(self) -> None:
        """Traces an unfinished line."""
        self._simulation.event_log.stdout.finish()

    def flush(self) -> None:
        """Writes everything that is not written yet."""
        if self._recording is not None:
            self._recording.flush()

    def forget_ahead(self) -> None:
        """Forgets that it has been further than it is now."""
        self._simulation.forget_ahead()
        self._shown.kept.cut(self._simulation.ticks)
        if self._end is not None and self._end[0] > self._simulation.ticks:
            self._end = None

    def tops(self) -> list[Top]:
        """Returns the agents."""
        return [Top(agent) for agent in self._simulation.agents.values()]

    def curves(self, names: Sequence[str] | None, first: float, last: float | None, most: int) -> dict[str, Any]:
        """Returns curves of the known run; see `workbench.page_commands.bodies.Curves`."""
        return self._shown.curves(names, first, last, most)

    def scene(self) -> tuple[bytes | None, dict[str, float]]:
        """Returns the state of the physics, and how wide apertures are."""
        return self._shown.scene()

    def drawn(self, kinds: tuple[str, ...]) -> dict[str, Any]:
        """Returns what overlays show of the present, by kind."""
        return self._shown.drawn(kinds)

    def result(self) -> dict[str, Any] | None:
        """Returns what was measured of the run, if anything was."""
        return self._shown.result()

    def parts(self) -> dict[str, dict[str, Any]]:
        """Returns what all parts of all agents are like."""
        parts: dict[str, dict[str, Any]] = {}
        for agent in self._simulation.agents.values():
            parts |= snapshot_of(agent)
        return parts

    def names(self) -> Names:
        """Returns at what it can be stopped."""
        return names_of(self.tops(), self._simulation.world.bodies)

    def touches(self) -> Touches:
        """Returns what touches a body now, the ground left out."""
        return self._shown.touches()


def check(source: str, filename: str, folder: Path) -> dict[str, Any]:
    """Loads a model and builds what it describes with its defaults; runs nothing. Returns the values of its parameters."""
    limits = RunLimits(seed=0)
    with limits, BuiltOutput():
        _, parameters = build(source, filename, {}, folder)
    return json.loads(to_json(parameters))
