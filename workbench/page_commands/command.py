"""Defines what all commands and questions of a page have in common, and their registry."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import nullcontext
from math import isfinite
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeVar

from pydantic import BeforeValidator, Field

from actr3d.errors import Actr3dError, alternatives
from actr3d.registry import Registry
from workbench.page_message import PageMessage
from workbench.worker.messages import Reply

if TYPE_CHECKING:
    from workbench.session import Session
    from workbench.worker.controlled_run import ControlledRun
    from workbench.worker.run_controller import RunController

Name = Annotated[str, Field(min_length=1, max_length=200)]
Text = Annotated[str, Field(max_length=1_000_000)]
Seconds = Annotated[float, Field(ge=0, lt=1e9, allow_inf_nan=False)]
LONGEST_TEXT = 10_000
"""Maximum length of a text that is a value [characters]."""


def _plain(value: Any) -> Any:
    """Checks a value here, because pydantic names each type of a union that does not fit."""
    if isinstance(value, str) and len(value) > LONGEST_TEXT:
        raise ValueError(f"a text has at most {LONGEST_TEXT:,} characters (this one has {len(value):,})")
    if not isinstance(value, (bool, int, float, str)) and value is not None:
        raise ValueError("must be a number, a text, true, false or null")
    if isinstance(value, float) and not isfinite(value):
        raise ValueError("must be a finite number")
    if isinstance(value, int) and not -(2**63) <= value < 2**63:
        raise ValueError("a whole number has at most 64 bits: it must be at least -2**63 and less than 2**63")
    return value


PlainValue = Annotated[bool | int | float | Annotated[str, Field(max_length=LONGEST_TEXT)] | None, BeforeValidator(_plain)]
"""A value that can be recorded."""


class PageCommand(PageMessage):
    """Base of the commands: what a user wants of a session or its run. A command is validated in the server, and sent to the worker.

    Each has a field `type`, a `Literal` with its name as the default.
    """

    takes_control: ClassVar[bool] = True
    """Whether the sender is shown to others as the one who controls the session."""
    of_shown_run: ClassVar[bool] = False
    """Whether it is for the run on screen even if a newer run is being built; otherwise it is for the newest run."""
    cancels_seek: ClassVar[bool] = False
    """Whether it cancels a seek that is in progress; otherwise it is carried out once the run is there."""

    async def submit(self, session: Session, who: str = "") -> Reply:
        """Does what the command is for; the reply holds the result or the error.

        Args:
            session: The session.
            who: The name of the user, as other users see it.
        """
        if self.takes_control:
            session.take_control(who)
        try:
            return await self.serve(session)
        except (Actr3dError, OSError) as error:
            return Reply(id=0, error=str(error))

    async def serve(self, session: Session) -> Reply:
        """Does in the server what the command is for: by default, the worker of the run carries it out.

        Raises:
            Actr3dError: If it cannot be done.
        """
        return await session.ask(self, of_shown_run=self.of_shown_run)

    def carry_out(self, controller: RunController) -> Any:
        """Does in the worker, between two ticks, what the command is for; returns plain values.

        Raises:
            Exception: If it cannot be done; the text says why.
        """
        raise NotImplementedError


class Question(PageCommand):
    """Base of the questions, which change nothing."""

    takes_control: ClassVar[bool] = False
    of_shown_run: ClassVar[bool] = True

    def carry_out(self, controller: RunController) -> Any:
        """Answers the question."""
        shown = controller.run.shown
        with nullcontext() if shown is None else shown.simulation.only_looking():
            return self.answer(controller.run)

    def answer(self, run: ControlledRun) -> Any:
        """Returns the answer as plain values.

        Raises:
            Actr3dError: If a name is unknown, or the question cannot be answered.
        """
        raise NotImplementedError


C = TypeVar("C", bound="type[PageCommand]")

COMMANDS: Registry[type[PageCommand]] = Registry("page command")
"""All commands and questions by name."""


def page_command(command: C) -> C:
    """Registers a command or question under the default of its field `type`, a `Literal`.

    Raises:
        ValueError: If there is a command of this name already.
    """
    COMMANDS.add(str(command.model_fields["type"].default), command)
    return command


def unknown(what: str, name: str, known: Iterable[str]) -> Actr3dError:
    """Returns the error for a name that does not exist, with the names that do."""
    return Actr3dError(f"no {what} '{name}'{alternatives(name, known)}")
