"""Standard output of the command: the model's own lines and the events of its run, whatever else writes there."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Generator
from contextlib import contextmanager, suppress
from typing import Any, TextIO

from actr3d.printing import ModelOutput


class StandardOutput(io.TextIOWrapper):
    """Standard output as a file of our own, which says once what is wrong with it and takes no more from then on.

    Args:
        number: The file descriptor.
        like: Whose encoding and buffering it has.
    """

    def __init__(self, number: int, like: TextIO) -> None:
        self._raw = _Raw(number, "wb", closefd=False)
        at_once = bool(getattr(like, "write_through", False))
        buffer = io.BufferedWriter(self._raw, io.DEFAULT_BUFFER_SIZE)
        super().__init__(buffer, like.encoding, "backslashreplace", None, bool(like.line_buffering) or at_once, at_once)

    @property
    def trouble(self) -> OSError | None:
        """What is wrong with it, if anything."""
        return self._raw.trouble


class _Raw(io.FileIO):
    trouble: OSError | None = None

    def write(self, data: Any, /) -> int:
        if self.trouble is None:
            try:
                return super().write(data)
            except OSError as error:
                self.trouble = error
                raise
        return memoryview(data).nbytes


@contextmanager
def standard_output(apart: bool) -> Generator[TextIO]:
    """Gives standard output to one writer inside the block.

    Args:
        apart: Whether to keep everybody else away from it: what this process, or one that it starts, writes to file
            descriptor 1 goes to standard error then, so that it cannot stand in the middle of a line.

    Yields:
        What to write to: a `StandardOutput`; or `sys.stdout` as it is, where that is no file, or another.
    """
    out = sys.stdout
    try:
        ours = out.fileno() == 1
        out.flush()
    except (OSError, ValueError):
        ours = False
    if not ours:
        yield out
    elif apart:
        with _moved(out) as number:
            own = StandardOutput(number, out)
            own.reconfigure(encoding="utf-8", errors="backslashreplace")
            yield own
    else:
        yield StandardOutput(1, out)


@contextmanager
def _moved(out: TextIO) -> Generator[int]:
    """Lets file descriptor 1 be standard error inside the block, and yields another that is standard output."""
    try:
        os.fstat(2)
    except OSError:  # standard error is closed
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 2)
        if nowhere != 2:
            os.close(nowhere)
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        yield kept
    finally:
        with suppress(OSError, ValueError):
            out.flush()  # what a model has written past its own `sys.stdout`
        os.dup2(kept, 1)
        os.close(kept)


def all_written(out: TextIO, printed: ModelOutput | None) -> OSError | None:
    """Writes what is still to be written; returns what is wrong with the output, if anything."""
    with suppress(OSError, ValueError):  # it is full, or the model has closed it
        if printed is not None:
            printed.finish()
        out.flush()
    return out.trouble if isinstance(out, StandardOutput) else None
