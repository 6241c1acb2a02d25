"""Defines what a controller needs of a run, whether it is a simulation or a program."""

from __future__ import annotations

from typing import Any, Protocol

from actr3d.trace import Trace
from workbench.worker.names import Names
from workbench.worker.stop_conditions import Touches


class ControlledRun(Protocol):
    """A run that a controller controls."""

    @property
    def clock(self) -> int:
        """The time since the start of the run [us]."""
        ...

    @property
    def furthest(self) -> int:
        """The furthest time that the run has reached [us]."""
        ...

    @property
    def period(self) -> int:
        """The length of a tick [us]."""
        ...

    @property
    def trace(self) -> Trace | None:
        """The trace so far."""
        ...

    def do(self, command: Any) -> None:
        """Carries out a command that changes the run itself.

        Raises:
            Exception: If the command cannot be carried out; its text says why.
        """
        ...

    def finish_output(self) -> None:
        """Traces an unfinished line, as nothing more will be printed."""
        ...

    def flush(self) -> None:
        """Writes buffered data to the recording, so that a paused run's recording is complete up to that moment."""
        ...

    def forget_ahead(self) -> None:
        """Removes the knowledge of times after the present."""
        ...

    def answer(self, question: Any) -> Any:
        """Returns the answer to a question as plain values.

        Raises:
            Exception: If the question cannot be answered; its text says why.
        """
        ...

    def scene(self) -> tuple[bytes | None, dict[str, float]]:
        """Returns the state of the physics, and the widths of apertures [m]."""
        ...

    def drawn(self, kinds: tuple[str, ...]) -> dict[str, Any]:
        """Returns the current data of overlays, by kind."""
        ...

    def result(self) -> dict[str, Any] | None:
        """Returns the measured result of the run, if any."""
        ...

    def parts(self) -> dict[str, dict[str, Any]]:
        """Returns the current state of all parts."""
        ...

    def names(self) -> Names:
        """Returns the names at which the run can be stopped."""
        ...

    def touches(self) -> Touches:
        """Returns the current contacts of bodies with anything but the ground."""
        ...
