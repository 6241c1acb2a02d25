"""Words: what a body can be told or asked, each with the function that does it."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, Any

from actr3d.errors import WorldError, did_you_mean

if TYPE_CHECKING:
    from actr3d.world.body import Body


class Word:
    """One actuator or sensor of a body.

    Args:
        name: The word.
        does: What it does, with the body as its first argument.
        fits: Which bodies have it.
    """

    def __init__(self, name: str, does: Callable[..., Any], fits: Callable[[Body], bool]) -> None:
        self.name = name
        self.fits = fits
        self._does = does
        self._signature = inspect.signature(does)
        self._bare = all(of.default is not of.empty for of in [*self._signature.parameters.values()][1:])
        """Whether it takes no values, or none that may not be left out."""

    def __call__(self, body: Body, *values: Any, **named: Any) -> Any:
        """Does it.

        Raises:
            WorldError: If it does not take these values; says what it takes.
        """
        if values or named or not self._bare:
            try:
                self._signature.bind(body, *values, **named)
            except TypeError as error:
                raise WorldError(f"{body.name}: {self.name} takes ({self.takes}): {error}") from error
        return self._does(body, *values, **named)

    @property
    def takes(self) -> str:
        """What it takes, as Python writes it."""
        parameters = list(self._signature.parameters.values())[1:]
        return ", ".join(str(parameter.replace(annotation=inspect.Parameter.empty)) for parameter in parameters)

    @property
    def meaning(self) -> str:
        """What it does, in one sentence."""
        return re.split(r"(?<=\.)\s", inspect.getdoc(self._does) or "")[0]


def adder(words: dict[str, Word], fits: Callable[[Body], bool] = lambda _: True) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Returns a decorator that adds a function to words, under its own name, for the bodies that have it."""

    def add(does: Callable[..., Any]) -> Callable[..., Any]:
        words[does.__name__] = Word(does.__name__, does, fits)
        return does

    return add


def known(word: Any, words: Collection[str], whose: str, kind: str) -> str:
    """Returns a word that is one of those that there are; it may come from a mind, so it may be anything.

    Args:
        word: What was given.
        words: Those that there are.
        whose: Who has them, for the message.
        kind: What they are called, for the message.

    Raises:
        WorldError: If it is not one of them; says which there are.
    """
    if isinstance(word, str) and word in words:
        return word
    has = f"it has {', '.join(words)}" if words else f"it has no {kind}s"
    near = did_you_mean(word, words) if isinstance(word, str) else ""
    raise WorldError(f"{whose} has no {kind} {_quoted(word)}{near}; {has}")


def _quoted(word: Any) -> str:
    return f"'{word}'" if isinstance(word, str) else repr(word)


def number(value: Any, what: str, least: float = -math.inf, most: float = math.inf) -> float:
    """Returns a finite number within bounds; text that says a number is one: what a pattern binds is text.

    Raises:
        WorldError: If it is not one.
    """
    if isinstance(value, bool):
        raise WorldError(f"{what}: must be a number (got {value!r})")
    try:
        given = float(value)
    except OverflowError:  # a whole number beyond what floats hold
        given = math.inf
    except (TypeError, ValueError) as error:
        raise WorldError(f"{what}: must be a number (got {value!r})") from error
    if not math.isfinite(given):
        raise WorldError(f"{what}: must be a finite number (got {value!r})")
    if not least <= given <= most:
        bounds = f"{least:g} to {most:g}" if most < math.inf else f"at least {least:g}"
        raise WorldError(f"{what}: must be {bounds} (got {value!r})")
    return given


def whole(value: Any, what: str, least: int, most: int) -> int:
    """Returns a whole number within bounds; text that says one is one.

    Raises:
        WorldError: If it is not one.
    """
    given = number(value, what, least, most)
    if not given.is_integer():
        raise WorldError(f"{what}: must be a whole number (got {value!r})")
    return int(given)
