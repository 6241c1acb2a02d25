"""A run of what a model file builds: minds and bodies in a world, which can go back and another way."""

from __future__ import annotations

import json
from contextlib import suppress
from dataclasses import asdict
from functools import cached_property, partial
from pathlib import Path
from time import perf_counter
from typing import Any

from actr3d.actr.helper_texts import HelperTexts
from actr3d.actr.limits import EndOfRun, RunLimits, fresh_seed
from actr3d.actr.picture import picture_of
from actr3d.actr.shared_random import shared_random
from actr3d.clock import MICROSECONDS, microseconds, seconds
from actr3d.errors import Actr3dError, SimulationError
from actr3d.recording import Recording
from actr3d.running.building import build
from actr3d.running.printed import BuiltOutput
from actr3d.simulation import Command, Simulation
from actr3d.trace import Trace
from actr3d.values import to_json
from actr3d.world import Aperture, Floor
from actr3d.world.sensors.touch import present
from workbench import protocol as say
from workbench.compiled import loaded, saved, to_text
from workbench.curves import Curves
from workbench.loader import Listing
from workbench.worker.answers import answer
from workbench.worker.conductor import Conductor
from workbench.worker.drawings import Drawings
from workbench.worker.messages import Facts
from workbench.worker.names import Names, names_of
from workbench.worker.past import Past
from workbench.worker.surroundings import surroundings
from workbench.worker.told_helpers import ToldHelpers
from workbench.worker.trouble import UNFORESEEN, notice_of, told_of
from workbench.worker.watch import Touches
from workbench.worker.widths import widths

BLOCK = 0.008
"""For about so long [s] the run goes on before it looks whether a user has said something."""
MOST_TICKS = 64
"""And for no more ticks than these."""
ENDINGS = {"stop": "the model called stop()", "done": "no mind has anything left to do"}


class BuiltRun:
    """Runs a simulation as a conductor says.

    Args:
        conductor: Says when it goes on.
        listing: What the model's text says of itself.
    """

    def __init__(self, conductor: Conductor, listing: Listing) -> None:
        self._conductor = conductor
        self._listing = listing
        self._start = conductor.link.start
        self._recording: Recording | None = None
        self._tick_time = 0.0
        self._end: tuple[int, str] | None = None
        """At which tick the run is over, and why, once that is known."""
        self._failed = False
        self._past = Past()
        self._simulation: Simulation

    def play(self) -> None:
        """Builds and runs it, until the worker is to leave.

        Raises:
            Exception: What the model raises in being built.
        """
        start = self._start
        limits = RunLimits(seed=fresh_seed() if start.seed is None else start.seed)
        with limits, suppress(EndOfRun), shared_random(limits.program_seed), BuiltOutput() as output:
            helpers = ToldHelpers(self._conductor.link, start.helpers)
            simulation, parameters = build(start.source, start.path, start.settings, Path(start.folder), helpers)
            output.lead_to(simulation)
            self._simulation = simulation
            self._prepare(limits, parameters, helpers)
            try:
                self._conductor.link.post(self._facts(limits, parameters))
                self._conductor.conduct(self)
                self._conductor.show()
                self._conductor.link.flush()  # whatever the model does next, that it was built is known
                while True:
                    self._conductor.attend()
                    self._go_on()
            finally:
                if self._recording is not None:
                    self._recording.close()

    def _prepare(self, limits: RunLimits, parameters: dict[str, Any], helpers: HelperTexts) -> None:
        simulation, start = self._simulation, self._start
        simulation.traced()
        simulation._journal.keeper = self._past.keep
        if start.record is not None:
            facts: dict[str, Any] = {"file": start.path, "sources": {start.path: start.source}, "parameters": parameters, "built": True}
            facts.update(helpers=helpers.loaded, program_seed=limits.program_seed)
            facts.update(compiled=to_text(saved(simulation.world.mj_model)), world=surroundings(simulation.world))
            self._recording = simulation.record(start.record, **facts)
            helpers.heard = partial(self._recording.fact, "helpers")  # a mind may import one later
        if start.commands:
            simulation.plan([Command.from_data(tick, data) for tick, data in start.commands])

    def _facts(self, limits: RunLimits, parameters: dict[str, Any]) -> Facts:
        world = surroundings(self._simulation.world)
        return Facts(
            kind="simulation",
            seed=limits.program_seed,
            period=self._simulation.period,
            parameters=to_json(parameters).encode(),
            world=to_json({**world, "widths": widths(world["apertures"], self._listing.parameters)}).encode(),
            mj_model=saved(self._simulation.world.mj_model),
        )

    def _go_on(self) -> None:
        """Goes on by a few ticks."""
        conductor, simulation = self._conductor, self._simulation
        ticks = self._allowance()
        begin = perf_counter()
        try:
            report = simulation.run(ticks * simulation.period)
            over = "stop" if report.ended_by == "stop" else "done" if simulation.done else None
            if over is not None:
                self._conclude()
        except UNFORESEEN as error:
            conductor.link.post(notice_of(error))
            self._tell_failure(told_of(error))
            conductor.end("failed", told_of(error))
            return
        self._tick_time = (perf_counter() - begin) / max(1, report.ticks)
        conductor.passed()
        if over is None:
            conductor.pace(self.clock)
            return
        self._end = simulation.ticks, over
        if self._recording is not None:
            self._recording.fact("ended", {"by": over})
        conductor.end("ended", ENDINGS[over])

    def _conclude(self) -> None:
        """Tells the result, and what was printed last; in the order of a replay."""
        self._simulation.conclude()
        self._simulation._journal.voice.finish()

    def _allowance(self) -> int:
        """Returns how many ticks to go before looking again what users want."""
        conductor = self._conductor
        if conductor.watch.fine:
            return 1
        most = min(MOST_TICKS, int(BLOCK / self._tick_time)) if self._tick_time > 0 else 1
        if conductor.pacer.factor is not None:
            most = min(most, int(conductor.pacer.factor * BLOCK * MICROSECONDS / self.period))
        if conductor.watch.goal is not None:
            most = min(most, -(-(conductor.watch.goal - self.clock) // self.period))
        return max(1, most)

    @cached_property
    def _curves(self) -> Curves:
        """What makes curves of its past, once somebody asks; from a copy of the scene."""
        model = loaded(saved(self._simulation.world.mj_model))
        return Curves(model, surroundings(self._simulation.world))

    @cached_property
    def _drawings(self) -> Drawings:
        """What tells what overlays show, once somebody looks."""
        return Drawings(self._simulation, self._past)

    # -- what the conductor asks

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

    def do(self, command: Any) -> None:
        """Does what a user wants of the simulation.

        Raises:
            SimulationError: If it cannot be done.
            Exception: What the world, a body or a mind raises.
        """
        match command:
            case say.Back():
                self._seek(max(0, self._simulation.ticks - command.ticks))
            case say.Seek():
                self._seek(round(command.time * MICROSECONDS / self.period))
            case say.Aperture():
                self._command("aperture", (command.width,), {"name": command.name}, None)
            case say.Say():
                self._command(command.word, command.values, command.named, command.body)
            case say.Set():
                parameter = self._listing.parameter(command.name)
                if parameter.live is None:
                    raise SimulationError(f"'{command.name}' cannot change while a run goes on; begin again with the new value")
                parameter.check(command.value)
                live = parameter.live
                self._command(live.word, (*live.before, command.value), {}, live.body)
            case _:
                raise SimulationError(f"'{command.type}' is nothing that is said to a run")

    def _command(self, word: str, values: tuple[Any, ...], named: dict[str, Any], body: str | None) -> None:
        if self._conductor.status == "ended":
            raise SimulationError("the run is over: go back to an earlier time, or begin again")
        trace = self._simulation.trace
        before = 0 if trace is None else len(trace)
        self._simulation.command(word, *values, body=body, **named)
        self._past.cut(self._simulation.ticks)
        self._drawings.cut(self._simulation.ticks)
        if self._failed:
            self._tell_failure(None)
        if self._end is not None:
            self._end = None
            if self._recording is not None:
                self._recording.fact("ended", None)
        self._conductor.goes_another_way(before)

    def _tell_failure(self, text: str | None) -> None:
        """Records what the model raised; None where the run goes another way now."""
        self._failed = text is not None
        if self._recording is not None:
            self._recording.fact("failed", text)

    def _seek(self, tick: int) -> None:
        self._simulation.seek(seconds(tick * self.period))
        if self._end is None or tick != self._end[0]:
            self._conductor.went_back()
            return
        self._conclude()
        self._conductor.end("ended", ENDINGS[self._end[1]])

    def answer(self, question: Any) -> Any:
        """Returns what is asked.

        Raises:
            Exception: Says why it cannot be told.
        """
        if isinstance(question, say.Curves):
            return self._told_curves(question)
        return answer(question, self.trace, list(self._simulation.minds.values()), self._simulation.world)

    def _told_curves(self, question: say.Curves) -> dict[str, Any]:
        first = -(-microseconds(question.first) // self.period)
        moments = ((seconds(tick * self.period), state) for tick, state in self._past.since(first, question.most))
        return self._curves.told(moments, question.names)

    def scene(self) -> tuple[bytes | None, dict[str, float]]:
        """Returns the physics' state, and how wide apertures are."""
        world = self._simulation.world
        names = [part.name for part in world.scene.parts if isinstance(part, Aperture)]
        return world.state_bytes(), {name: world.aperture_width(name) for name in names}

    def drawn(self, kinds: tuple[str, ...]) -> dict[str, Any]:
        """Returns what overlays show of the present, by kind; nothing of what cannot be told, as after a physics that diverged."""
        with suppress(Actr3dError):
            return self._drawings.told(kinds)
        return {}

    def result(self) -> dict[str, Any] | None:
        """Returns what was measured of the run, if anything was."""
        result = self._simulation.result()
        return None if result is None else asdict(result)

    def parts(self) -> dict[str, dict[str, Any]]:
        """Returns what all parts of all minds are like."""
        told: dict[str, dict[str, Any]] = {}
        for mind in self._simulation.minds.values():
            told |= picture_of(mind)
        return told

    def names(self) -> Names:
        """Returns at what it can be stopped."""
        return names_of(self._simulation.minds.values(), self._simulation.world.bodies)

    def touches(self) -> Touches:
        """Returns what touches a body now, the ground left out."""
        world = self._simulation.world
        ground = {part.name for part in world.scene.parts if isinstance(part, Floor)}
        return frozenset(
            (name, touch.part, touch.other) for name, body in world.bodies.items() for touch in present(body) if touch.other not in ground
        )


def check(source: str, filename: str, folder: Path) -> dict[str, Any]:
    """Loads a model and builds what it describes with its defaults; runs nothing. Returns the values of its parameters."""
    limits = RunLimits(seed=0)
    with limits, BuiltOutput():
        _, parameters = build(source, filename, {}, folder)
    return json.loads(to_json(parameters))
