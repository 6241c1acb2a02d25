"""The command that runs until a condition is true."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from actr3d.clock import MICROSECONDS, seconds
from actr3d.errors import Actr3dError
from workbench.page_commands.command import Name, PageCommand, Seconds, page_command
from workbench.time_text import time_text

if TYPE_CHECKING:
    from workbench.worker.run_controller import RunController


@page_command
class Until(PageCommand):
    """Runs until one of the given conditions is true."""

    type: Literal["until"] = "until"
    time: Seconds | None = None
    """This time is reached [s]."""
    production: Name | None = None
    """A production of this name fires."""
    buffer: Name | None = None
    """The buffer at this path matches `pattern`."""
    pattern: Annotated[str, Field(max_length=2000)] | None = None
    contact: Annotated[str, Field(max_length=200)] | None = None
    """This body touches something other than the ground; an empty text means any body."""

    def carry_out(self, controller: RunController) -> None:
        """Checks, before the run continues, that each condition can occur.

        Raises:
            FieldError: If a name is unknown, the pattern is invalid, it names a slot that no chunk can have, or the time has passed.
            Actr3dError: If there is no condition.
        """
        from workbench.worker.controlled_run import FieldError
        from workbench.worker.slots import check_slots

        if not self.model_dump(exclude={"type", "pattern"}, exclude_none=True):
            raise Actr3dError("until: must name a time, a production, a buffer with a pattern, or a contact")
        run, start = controller.run, controller.channel.start
        names = run.names()
        with _of("buffer"):
            buffer = names.buffer(self.buffer) if self.buffer else None
        if self.production:
            with _of("production"):
                names.check("production", self.production)
        with _of("contact"):
            if self.contact is not None and not names.bodies:
                raise Actr3dError("there is no body in this run that could touch anything")
            if self.contact:
                names.check("body", self.contact)
        is_fed = buffer is None or buffer in names.fed or buffer not in names.buffers
        sources = (start.source, *(text for _, text in start.helpers.values()))
        with _of("pattern"):
            check_slots(self.pattern or "", sources, names.modules if is_fed else (), start.folder)
        goal = None if self.time is None else round(self.time * MICROSECONDS)
        if goal is not None and goal <= run.clock:
            raise FieldError("time", f"must be after the present one, {time_text(seconds(run.clock))}; a click on the timeline goes back")
        controller.go(
            goal=goal,
            goal_reason="" if self.time is None else f"at {time_text(self.time)}",
            production=self.production,
            buffer=buffer,
            called=self.buffer or "",
            pattern=self.pattern or "",
            contact=self.contact,
            touching=run.touches() if self.contact is not None else frozenset[tuple[str, str, str]](),
        )
        controller.reason = controller.watch.pending
        controller.show()


@contextmanager
def _of(field: str) -> Generator[None]:
    """Makes an error inside the block one of a field."""
    from workbench.worker.controlled_run import FieldError

    try:
        yield
    except Actr3dError as error:
        raise FieldError(field, str(error)) from None
