"""What a conductor conducts: a run, whatever it is of."""

from __future__ import annotations

from typing import Any, Protocol

from actr3d.trace import Trace
from workbench.worker.names import Names
from workbench.worker.watch import Touches


class Conducted(Protocol):
    """What is conducted."""

    @property
    def clock(self) -> int:
        """How much time has passed since its start [us]."""
        ...

    @property
    def furthest(self) -> int:
        """How far it has come [us]."""
        ...

    @property
    def period(self) -> int:
        """A tick [us]."""
        ...

    @property
    def trace(self) -> Trace | None:
        """The trace up to now."""
        ...

    def do(self, command: Any) -> None:
        """Does what a user wants of the run itself.

        Raises:
            Exception: Says why it cannot be done.
        """
        ...

    def flush(self) -> None:
        """Writes what is still to be recorded: who sees where the run is held finds it in its recording."""
        ...

    def forget_ahead(self) -> None:
        """Forgets that it has been further than it is now."""
        ...

    def answer(self, question: Any) -> Any:
        """Returns what is asked, as plain values.

        Raises:
            Exception: Says why it cannot be told.
        """
        ...

    def scene(self) -> tuple[bytes | None, dict[str, float]]:
        """Returns the physics' state, and how wide apertures are."""
        ...

    def drawn(self, kinds: tuple[str, ...]) -> dict[str, Any]:
        """Returns what overlays show of the present, by kind."""
        ...

    def result(self) -> dict[str, Any] | None:
        """Returns what was measured of the run, if anything was."""
        ...

    def parts(self) -> dict[str, dict[str, Any]]:
        """Returns what all parts are like."""
        ...

    def names(self) -> Names:
        """Returns at what it can be stopped."""
        ...

    def touches(self) -> Touches:
        """Returns what touches a body now, the ground left out."""
        ...
