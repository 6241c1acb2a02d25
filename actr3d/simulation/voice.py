"""What the minds of a simulation print."""

from __future__ import annotations

import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager
from threading import get_ident
from types import TracebackType
from typing import Any, Self

from actr3d.printing import ToldOutput


class Voice(ToldOutput):
    """The `sys.stdout` of the minds while they think: each line is told, and what is new is written where it went before.

    Minds that live through their past again print the same things in the same order; so counting tells which are new. What
    another thread prints meanwhile goes its own way.

    Args:
        take: Called with each line, also with those that were printed before.
    """

    def __init__(self, take: Callable[[str], None]) -> None:
        super().__init__(take)
        self._thread = get_ident()
        self._count = 0
        self._known = 0
        self._theirs: Any = None
        """What a mind has put in its place; what goes there is no output of the program."""
        self.speaking = False
        """Whether what is written to any `sys.stdout` now is a mind's, and not yet told."""

    def begin(self) -> None:
        """Takes note that the minds are at their start, or there again."""
        self._count, self._theirs = 0, None
        self.forget()

    def cut(self) -> None:
        """Takes note that the minds go another way from here: what they print is new."""
        self._known = self._count

    def take(self, write: Callable[[Any], int], data: Any, encoded: bytes) -> int:
        """Writes something if it is new, and tells of its lines."""
        if get_ident() != self._thread:
            return write(data)
        self._count += 1
        if self._count > self._known:
            self._known = self._count
            self.speaking = False
            try:
                write(data)
            finally:
                self.speaking = True
        self._lines.write(encoded)
        return len(data)

    def __enter__(self) -> Self:
        out = sys.stdout
        if out is not self._theirs:
            self._put_in_place(out, self)
            self._out, self._theirs = out, None
        self.speaking = True
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        self.speaking = False
        self._theirs = None if sys.stdout is self else sys.stdout
        self._put_in_place(self, self._out)

    @contextmanager
    def aside(self) -> Generator[None]:
        """Lets `sys.stdout` be everybody else's inside the block, also where that stands inside one in which minds think."""
        if not self.speaking:
            yield
            return
        self.__exit__(None, None, None)
        try:
            yield
        finally:
            self.__enter__()

    @staticmethod
    def _put_in_place(before: Any, after: Any) -> None:
        if sys.stdout is before:
            sys.stdout = after
        if sys.__stdout__ is before:
            sys.__dict__["__stdout__"] = after
