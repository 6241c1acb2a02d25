"""Defines what a controller needs of a run, whether it is a simulation or a program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from actr3d.parameter_schema import LiveCommand
from actr3d.trace import Trace
from workbench.worker.names import Names, Top
from workbench.worker.shown import Shown
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

    @property
    def shown(self) -> Shown | None:
        """What is shown of the current simulation, if there is one."""
        ...

    def go_to(self, time: int) -> None:
        """Goes to another time of the run [us].

        Raises:
            SimulationError: If the run has not been there.
        """
        ...

    def live_parameter(self, name: str, value: Any) -> LiveCommand:
        """Returns how a parameter is changed during the run, after checking its new value.

        Raises:
            Actr3dError: If there is no such parameter, it cannot change during a run, or it cannot have this value.
        """
        ...

    def change(self, word: str, values: tuple[Any, ...], named: Mapping[str, Any], body: str | None, *, drop: bool) -> None:
        """Sends the simulation a command; the future of the run is kept as a branch.

        Args:
            word: The command.
            values: Its arguments.
            named: Its keyword arguments.
            body: The body that it is for, if any.
            drop: Whether what lies ahead may be lost if it cannot be kept.

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

    def tops(self) -> Sequence[Top]:
        """Returns the top models, or the agents of a simulation."""
        ...

    def curves(self, names: Sequence[str] | None, first: float, last: float | None, most: int) -> dict[str, Any]:
        """Returns curves of the known run; see `workbench.page_commands.bodies.Curves`."""
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
