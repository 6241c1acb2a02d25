"""Events and triggers: what the scheduler runs, and what wakes it."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from inspect import CO_GENERATOR
from types import GeneratorType
from typing import Any, Final, cast

AGAIN: Final = object()
"""The library's own generators yield this to continue at the same moment, with the priority of their event."""

NO_REMAINDERS: Final[Mapping[float, float]] = {}
"""No rounding errors are carried over."""


class Trigger:
    """Something that generators can wait for (`yield trigger`)."""

    __slots__ = ("_most", "name", "waiting")

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.waiting: list[Event] = []
        self._most = 8

    def __repr__(self) -> str:
        return f"<Trigger '{self.name}'>"

    def add_one_of_several(self, event: Event) -> None:
        """Adds an event that also waits elsewhere; from time to time removes those that were woken from there."""
        if len(self.waiting) >= self._most:
            self.waiting = [other for other in self.waiting if not other.cancelled]
            self._most = max(8, 2 * len(self.waiting))
        self.waiting.append(event)

    def __deepcopy__(self, memo: dict[int, Any]) -> Trigger:
        return Trigger(self.name)


class Call:
    """A scheduled call of a function of the library: it returns None, and nothing waits for it."""

    __slots__ = ("args", "call", "remainders")

    def __init__(self, call: Callable[..., Any], args: Sequence[Any] = ()) -> None:
        self.call = call
        self.args = args
        self.remainders: Mapping[float, float] = NO_REMAINDERS
        """The rounding errors of the delays that led to it; see `Scheduler.remainders`."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.describe()}>"

    def __lt__(self, other: Call) -> bool:
        return False  # the queue alone orders events of equal time and priority

    def describe(self) -> str:
        """Returns the name of the call."""
        return str(getattr(self.call, "__qualname__", None) or getattr(self.call, "__name__", repr(self.call)))


class Event(Call):
    """A call, or the next step of a generator, at a given time or when a trigger fires; generators can wait for it."""

    __slots__ = ("cancelled", "done", "generator", "group", "keys", "origin", "parents", "priority")

    def __init__(
        self,
        call: Callable[..., Any],
        args: Sequence[Any] = (),
        keys: Mapping[str, Any] | None = None,
        priority: float = 0,
        generator: Generator[Any, Any, Any] | None = None,
    ) -> None:
        super().__init__(call, args)
        self.keys: Mapping[str, Any] = keys or {}
        self.priority = priority
        self.group: Sequence[Event] = ()
        """The alternatives if a generator waits for the first of several things, this event included; empty if for one."""
        self.origin = self
        """The event that the caller received; another one if this is an alternative."""
        self.cancelled = False
        """Whether another event of the group came first."""
        self.done = False
        self.parents: list[Event] = []
        self.generator = generator

    def cancel_others(self) -> list[Event]:
        """Cancels the other events of the group, and returns them."""
        others = [other for other in self.group if other is not self]
        for other in others:
            other.cancelled = True
        self.group = ()
        return others

    def describe(self) -> str:
        """Returns the name of the call, and of a generator also its current line."""
        if self.generator is None:
            return super().describe()
        generator = self.innermost
        assert generator is not None
        code = generator.gi_code
        frame = generator.gi_frame
        return f"{code.co_qualname} ({code.co_filename}:{frame.f_lineno if frame else code.co_firstlineno})"

    @property
    def innermost(self) -> GeneratorType[Any, Any, Any] | None:
        """The innermost generator, reached through `yield from`: the modeller's own."""
        generator = cast("GeneratorType[Any, Any, Any] | None", self.generator)
        while generator is not None and isinstance(inner := generator.gi_yieldfrom, GeneratorType):
            generator = cast("GeneratorType[Any, Any, Any]", inner)
        return generator


def makes_generator(func: Callable[..., Any]) -> bool:
    """Returns whether a function or callable object returns a generator."""
    code = getattr(func, "__code__", None) or getattr(getattr(type(func), "__call__", None), "__code__", None)  # noqa: B004 - its code is wanted, not whether there is any
    return code is not None and bool(code.co_flags & CO_GENERATOR)
