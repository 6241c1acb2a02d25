"""Captures the standard output of a simulation's agents."""

from __future__ import annotations

import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager
from threading import get_ident
from types import TracebackType
from typing import Any, Self

from actr3d.output import TeeOutput


class StdoutCapture(TeeOutput):
    """The `sys.stdout` of the agents while they run: traces each line, and writes new output to the former `sys.stdout`.

    Agents that repeat their past print the same output in the same order; counting shows which output is new. Output of other
    threads is passed through.

    Args:
        take: Called with each line, also with repeated ones.
    """

    def __init__(self, take: Callable[[str], None]) -> None:
        super().__init__(take)
        self._thread = get_ident()
        self._count = 0
        self._known = 0
        self._theirs: Any = None
        """The `sys.stdout` that an agent has set itself; output to it is not output of the program."""
        self.speaking = False
        """Whether output to any `sys.stdout` now is an agent's and not traced yet."""

    def begin(self) -> None:
        """Resets the count: the agents are at their start, or at it again."""
        self._count, self._theirs = 0, None
        self.forget()

    def cut(self) -> None:
        """Marks all further output as new: the run gets another future."""
        self._known = self._count

    def take(self, write: Callable[[Any], int], data: Any, encoded: bytes) -> int:
        """Writes output if it is new, and traces its lines."""
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
        """Restores the former `sys.stdout` inside the block, also within a block in which agents run."""
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
