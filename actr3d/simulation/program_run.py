"""A simulation as one of the runs that the trace of a whole program records."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from actr3d.kinds import KINDS, LEVELS
from actr3d.trace import Run, Trace, TraceEvent, top_path


class ProgramRun:
    """Hands a simulation's events on to the program's trace, under the name that the run has there: «top», «top#2» and so on.

    Args:
        trace: The program's.
        present: Returns the simulation's run as its own trace has it at present; None where there is none.
    """

    def __init__(self, trace: Trace, present: Callable[[], Run | None]) -> None:
        self._trace = trace
        self._present = present
        self._rank = LEVELS.index(trace.level)
        self._number = 0

    def take(self, event: TraceEvent) -> None:
        """Hands an event on, if the program's trace records as much. What a mind prints, whoever runs the program tells of.

        Raises:
            Exception: What a listener of that trace has raised.
        """
        if event.kind == "output" or LEVELS.index(KINDS[event.kind].level) > self._rank:
            return
        if not self._number:
            self._number = self._trace.begin(self)
        self._trace.emit(event.time_us, self._name(event.source), event.kind, event.data)
        self._trace.raise_failures()

    def _name(self, source: str) -> str:
        top = top_path(self._number)
        return source if self._number == 1 else top if source == "top" else f"{top}.{source}"

    # -- what the trace asks of it

    @property
    def model(self) -> Any:
        """The environment of its minds; None where it is gone."""
        present = self._present()
        return None if present is None else present.model

    def now_us(self) -> int | None:
        """Returns its present [us]; None where it is gone."""
        present = self._present()
        return None if present is None else present.now_us()

    def tell(self, trace: Trace) -> None:
        """Tells a trace what everything is like at present."""
        present = self._present()
        if present is not None:
            named = Trace(trace.level, keep=False)
            named.listen(lambda event: trace.emit(event.time_us, self._name(event.source), event.kind, event.data))
            present.tell(named)

    def stop(self) -> None:
        """Ends it with the present tick."""
        present = self._present()
        if present is not None:
            present.stop()
