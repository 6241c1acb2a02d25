"""What the scheduler deals with: events, and the triggers that wake them."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from inspect import CO_GENERATOR
from types import GeneratorType
from typing import Any, Final, cast

from actr3d.actr.kernel.profile import PYTHON_ACTR, Profile

AGAIN: Final = object()
"""What the library's own generators yield to go on at the same moment, with the priority their event has."""

NOTHING_LEFT: Final[Mapping[float, float]] = {}
"""Of no delay."""


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
        """Takes in an event that also waits elsewhere, and now and then lets those go that were woken from there."""
        if len(self.waiting) >= self._most:
            self.waiting = [other for other in self.waiting if not other.cancelled]
            self._most = max(8, 2 * len(self.waiting))
        self.waiting.append(event)

    def __deepcopy__(self, memo: dict[int, Any]) -> Trigger:
        return Trigger(self.name)


class Call:
    """A plain call of the library's own at some time: it returns None, and nobody waits for it."""

    __slots__ = ("args", "call", "left")

    def __init__(self, call: Callable[..., Any], args: Sequence[Any] = ()) -> None:
        self.call = call
        self.args = args
        self.left: Mapping[float, float] = NOTHING_LEFT
        """What rounding has left over of the delays that led to it; see `Scheduler.left`."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.describe()}>"

    def __lt__(self, other: Call) -> bool:
        return False  # events of one time and priority are equals; the queue alone puts them in order

    @property
    def profile(self) -> Profile:
        """The numbers that the model goes by whose method this is."""
        owner = getattr(self.call, "__self__", self.call)
        return getattr(owner, "_profile", None) or PYTHON_ACTR

    def describe(self) -> str:
        """Names the call."""
        return str(getattr(self.call, "__qualname__", None) or getattr(self.call, "__name__", repr(self.call)))


class Event(Call):
    """A call that will be made, or a generator that goes on, at a time or when a trigger says so; it can be waited for."""

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
        """All that wait for one of several things in an event's place, itself among them; empty where it waits for one."""
        self.origin = self
        """The event as its caller knows it; another one where this waits in its place for one of several things."""
        self.cancelled = False
        """Whether another of the group has come first."""
        self.done = False
        self.parents: list[Event] = []
        self.generator = generator

    def cancel_others(self) -> list[Event]:
        """Cancels what else this has waited for, as one of several things, and returns that."""
        others = [other for other in self.group if other is not self]
        for other in others:
            other.cancelled = True
        self.group = ()
        return others

    def describe(self) -> str:
        """Names the call, and for a generator the line it stands at."""
        if self.generator is None:
            return super().describe()
        generator = self.innermost
        assert generator is not None
        code = generator.gi_code
        frame = generator.gi_frame
        return f"{code.co_qualname} ({code.co_filename}:{frame.f_lineno if frame else code.co_firstlineno})"

    @property
    def innermost(self) -> GeneratorType[Any, Any, Any] | None:
        """The modeller's own generator: the one that `yield from` leads to."""
        generator = cast("GeneratorType[Any, Any, Any] | None", self.generator)
        while generator is not None and isinstance(inner := generator.gi_yieldfrom, GeneratorType):
            generator = cast("GeneratorType[Any, Any, Any]", inner)
        return generator


def makes_generator(func: Callable[..., Any]) -> bool:
    """Tells whether a call gives a generator, also of a callable object."""
    code = getattr(func, "__code__", None) or getattr(getattr(type(func), "__call__", None), "__code__", None)  # noqa: B004 - its code is wanted, not whether there is any
    return code is not None and bool(code.co_flags & CO_GENERATOR)
