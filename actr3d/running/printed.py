"""What a model file prints while its run is recorded: its lines are events, too."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.printing import ToldOutput

if TYPE_CHECKING:
    from actr3d.simulation import Simulation
    from actr3d.simulation.stdout_capture import StdoutCapture


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
    """Tells a simulation of the lines that the file prints which builds it; of those of its minds the simulation knows by itself."""

    def __init__(self) -> None:
        super().__init__(self._hear)
        self._early: list[str] = []
        self._voice: StdoutCapture | None = None

    def lead_to(self, simulation: Simulation) -> None:
        """Tells this simulation of what came until now."""
        self.finish()
        for text in self._early:
            simulation.event_log.preface(text)
        self._voice = simulation.event_log.stdout

    def take(self, write: Callable[[Any], int], data: Any, encoded: bytes) -> int:
        """Writes something, and tells of its lines; also of what minds print to an output that their file has kept."""
        if self._voice is None:
            return super().take(write, data, encoded)
        return self._voice.take(write, data, encoded) if self._voice.speaking else write(data)

    def _hear(self, text: str) -> None:
        self._early.append(text)
