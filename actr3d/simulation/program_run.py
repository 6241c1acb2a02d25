"""A simulation as one of the runs in the trace of a whole program."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from actr3d.actr.changes import AgentChange
from actr3d.actr.kernel.run_limits import Contacts, Recorder
from actr3d.actr.modules.port import Request
from actr3d.change import CHANGES
from actr3d.recording.facts import SIMULATION
from actr3d.simulation.commands import Command
from actr3d.simulation.surroundings import scene_facts
from actr3d.trace import Run, Trace, TraceEvent, renumbered, with_number
from actr3d.trace_kinds import LEVELS, rank_of
from actr3d.world import World


class ProgramRun:
    """Passes the events of a simulation on to the program's trace and recorder, as one run of it: «top», «top#2» and so on.

    Args:
        trace: The trace of the program.
        recorder: The recorder of the program; None for none.
        period: Length of a tick [us].
        present: Returns the simulation's run in its own trace; None if there is none.
    """

    def __init__(self, trace: Trace, recorder: Recorder | None, period: int, present: Callable[[], Run | None]) -> None:
        self._trace = trace
        self._recorder = recorder
        self._period = period
        self._present = present
        self._rank = LEVELS.index(trace.level)
        self._run_number = 0

    def take(self, event: TraceEvent) -> None:
        """Passes an event on, if the program's trace records its level; except output of agents, which the program's runner traces.

        Raises:
            Exception: What a listener of that trace has raised.
        """
        if event.kind == "output" or rank_of(event.kind) > self._rank:
            return
        self._pass_on(event, self._trace)
        self._trace.raise_failures()

    def state(self, tick: int, world: World, contacts: Contacts) -> None:
        """Passes the physics state at the end of a tick on, and the contacts in that tick; before the first one, the scene.

        Raises:
            Exception: What the recorder raises.
        """
        if self._recorder is not None:
            if tick == 0:
                self._recorder.fact(SIMULATION.format(self.number), {"period_us": self._period, **scene_facts(world)})
            self._recorder.state(self.number, tick, world.state_bytes(), contacts)

    def answer(self, tick: int, request: Request, value: Any) -> None:
        """Passes the answer of a body in a tick on."""
        if self._recorder is not None:
            self._recorder.answer(self.number, tick, request.body, request.word, value)

    def command(self, command: Command) -> None:
        """Passes a command of a user on."""
        if self._recorder is not None:
            self._recorder.command(self.number, command.tick, command.to_data())

    @property
    def number(self) -> int:
        """Its number among the runs of the program, from 1 on."""
        if not self._run_number:
            self._run_number = self._trace.begin(self)
        return self._run_number

    def _pass_on(self, event: TraceEvent, trace: Trace) -> None:
        trace.emit(*with_number(_with_path(event, self.number), self.number))

    # -- for the trace

    @property
    def model(self) -> Any:
        """The environment of its agents; None if it is gone."""
        present = self._present()
        return None if present is None else present.model

    def now_us(self) -> int | None:
        """Returns its present time [us]; None if it is gone."""
        present = self._present()
        return None if present is None else present.now_us()

    def emit_state(self, trace: Trace) -> None:
        """Traces the present state of everything."""
        present = self._present()
        if present is not None:
            named = Trace(trace.level, keep=False)
            named.listen(lambda event: self._pass_on(event, trace))
            present.emit_state(named)

    def stop(self) -> None:
        """Ends it with the present tick."""
        present = self._present()
        if present is not None:
            present.stop()


def _with_path(event: TraceEvent, number: int) -> TraceEvent:
    """Returns an event; if it is a change of an agent, with the path of the changed part in the trace of the program."""
    if number == 1 or event.kind != "command":
        return event
    change, given = CHANGES.get(event.data["command"]), event.data["data"]
    if change is None or not issubclass(change, AgentChange) or "values" not in given:  # `Trace.command` takes any data
        return event
    values, named = change.renamed(given["values"], given["named"], lambda path: renumbered(path, number))
    return TraceEvent(event.time_us, event.source, event.kind, {**event.data, "data": {**given, "values": values, "named": named}})
