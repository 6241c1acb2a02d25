"""Defines the messages of a page on its websocket; `workbench.page_commands` has the commands and questions in them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias, Union, cast

from pydantic import Discriminator, Field, Tag, TypeAdapter

from workbench.page_commands import COMMANDS, Name, PageCommand
from workbench.page_message import PageMessage

if TYPE_CHECKING:
    AnyCommand = PageCommand
else:
    AnyCommand = Annotated[Union[*COMMANDS.values()], Field(discriminator="type")]

COMMAND: TypeAdapter[PageCommand] = TypeAdapter(AnyCommand)
"""Validates a command or question."""


class Attach(PageMessage):
    """The first message of a page on its websocket: the session to show, and what the page already knows of it."""

    type: Literal["attach"] = "attach"
    session: Name
    born: float | None = None
    """When the session began that the page has shown before, as its facts say it; None if it has shown none."""
    run: int = Field(default=0, ge=0)
    """The number of the run whose events the page knows."""
    epoch: int = Field(default=0, ge=0)
    events: int = Field(default=0, ge=0)
    """The number of events that it knows."""
    page: str = Field(default="", max_length=40)
    """Identifies the page: a panel in a window of its own belongs to the page that has opened it."""


class Ping(PageMessage):
    """A question whether the workbench is there, at any time; the answer is a `pong`."""

    type: Literal["ping"] = "ping"


class Request(PageMessage):
    """Any other message of a page: a command or question with a number, which the reply repeats."""

    id: int = Field(ge=0, lt=2**53)
    command: AnyCommand


def _kind_of(message: Any) -> str:
    kind = cast("dict[Any, Any]", message).get("type") if isinstance(message, dict) else None
    return kind if kind in ("attach", "ping") else "request"


Message: TypeAlias = Annotated[
    Annotated[Attach, Tag("attach")] | Annotated[Ping, Tag("ping")] | Annotated[Request, Tag("request")], Discriminator(_kind_of)
]
MESSAGE: TypeAdapter[Attach | Ping | Request] = TypeAdapter(Message)
"""Validates a message of a page: it is an `Attach` or a `Ping` if its own `type` says so."""


def problem_of(error: Mapping[str, Any]) -> str:
    """Returns a text that says where a message is invalid and why; it never quotes the message, which JSON may not be able to hold.

    Args:
        error: An error from pydantic's `ValidationError.errors`.
    """
    place = ".".join(str(part)[:100] for part in error["loc"])
    words = str(error["msg"]).removeprefix("Value error, ")  # of an error that this package raises itself
    if error["type"] == "union_tag_invalid":  # pydantic's own text for this error quotes the message
        words = f"{error['ctx']['discriminator']} must be one of {error['ctx']['expected_tags']}"
    return f"{place}: {words}" if place else words
