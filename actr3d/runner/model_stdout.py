"""Records what a model file prints during its run: its lines become events."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.output import TeeOutput

if TYPE_CHECKING:
    from actr3d.simulation import Simulation
    from actr3d.simulation.stdout_capture import StdoutCapture


class ProgramOutput(TeeOutput):
    """Emits the lines of a program to its trace.

    Args:
        limits: The limits of the program; with a trace.
    """

    def __init__(self, limits: RunLimits) -> None:
        super().__init__(self._hear)
        self._limits = limits

    def _hear(self, text: str) -> None:
        if self._limits.trace is not None:
            self._limits.trace.emit(self._limits.clock(), "model", "output", {"text": text})


class BuiltOutput(TeeOutput):
    """Sends the lines that a file prints while it builds a simulation to that simulation, which itself captures those of its agents."""

    def __init__(self) -> None:
        super().__init__(self._hear)
        self._early: list[str] = []
        self._voice: StdoutCapture | None = None

    def attach_to(self, simulation: Simulation) -> None:
        """Sends all earlier and later lines to this simulation."""
        self.finish()
        for text in self._early:
            simulation.event_log.preface(text)
        self._voice = simulation.event_log.stdout

    def take(self, write: Callable[[Any], int], data: Any, encoded: bytes) -> int:
        """Writes data, and passes on its lines, including those that agents print to an output stored by their file."""
        if self._voice is None:
            return super().take(write, data, encoded)
        return self._voice.take(write, data, encoded) if self._voice.speaking else write(data)

    def _hear(self, text: str) -> None:
        self._early.append(text)
