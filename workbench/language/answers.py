"""The answers to questions about a text, as the page gets them; positions are numbers of characters from its start."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.errors import Actr3dError


class LanguageError(Actr3dError):
    """A question about a text cannot be answered.

    Args:
        message: Why.
        line: The line of the text that is the reason, counted from 1; None for none.
    """

    def __init__(self, message: str, *, line: int | None = None) -> None:
        super().__init__(message)
        self.line = line


@dataclass(frozen=True, kw_only=True)
class Item:
    """One completion."""

    label: str
    type: str
    """Its kind, for its sign: one of CodeMirror's types of completions."""
    detail: str = ""
    """A few words beside it."""
    boost: int = 0
    """Its rank among others: higher is further up."""
    text: str = ""
    """Its documentation; empty if that is a question of its own."""
    apply: str = ""
    """What is inserted; empty for the label."""
    needs: str = ""
    """The import that it needs, if the text does not have it yet."""


@dataclass(frozen=True, kw_only=True)
class Completion:
    """What may come at a position."""

    start: int
    """Where the word begins that is completed."""
    items: list[Item]


@dataclass(frozen=True, kw_only=True)
class Documentation:
    """What is known of a name."""

    title: str
    text: str


@dataclass(frozen=True, kw_only=True)
class Hover(Documentation):
    """The documentation of the name between two positions."""

    start: int
    end: int


@dataclass(frozen=True, kw_only=True)
class Signature:
    """How a function may be called."""

    name: str
    parameters: list[str]
    active: int | None
    """The number of the parameter at the position; None if there is none."""
    text: str
    """The documentation of that parameter, or of the function."""


@dataclass(frozen=True, kw_only=True)
class Definition:
    """Where a name is defined."""

    path: str | None
    """The model file; None for a file elsewhere, such as one of the library."""
    name: str
    at: int | None = None
    """The position, if it is in the same text."""
    line: int | None = None
    module: str = ""


@dataclass(frozen=True, kw_only=True)
class Renaming:
    """The places of a name, each of which is replaced."""

    name: str
    what: str
    """What it is, such as `slot`."""
    starts: list[int]
