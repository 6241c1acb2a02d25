"""What a model file prints while its run is recorded: its lines are events, too."""

from __future__ import annotations

from typing import TYPE_CHECKING

from actr3d.actr.limits import RunLimits
from actr3d.printing import ToldOutput

if TYPE_CHECKING:
    from actr3d.simulation import Simulation


class ProgramOutput(ToldOutput):
    """Tells the trace of a program of its lines.

    Args:
        limits: What the program is held to; with a trace.
    """

    def __init__(self, limits: RunLimits) -> None:
        super().__init__(self._hear)
        self._limits = limits

    def _hear(self, text: str) -> None:
        if self._limits.trace is not None:
            self._limits.trace.emit(self._limits.clock(), "model", "output", {"text": text})


class BuiltOutput(ToldOutput):
    """Tells a simulation of the lines of the file that builds it, also of those from before it was built.

    Args:
        limits: What the file is held to.
    """

    def __init__(self, limits: RunLimits) -> None:
        super().__init__(self._hear)
        self._limits = limits
        self._early: list[str] = []
        self._simulation: Simulation | None = None

    def lead_to(self, simulation: Simulation) -> None:
        """Tells this simulation of everything."""
        self._simulation = simulation
        for text in self._early:
            self._hear(text)

    def _hear(self, text: str) -> None:
        if self._simulation is None:
            self._early.append(text)
        else:
            self._simulation._journal.output(self._limits.clock(), text)
