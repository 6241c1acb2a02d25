"""Standard output of the command: keeps the model's lines and the events of its run apart from all other output."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Generator
from contextlib import contextmanager, suppress
from typing import Any, TextIO

from actr3d.printing import ModelOutput


class StandardOutput(io.TextIOWrapper):
    """Standard output as a separate file, which stores its first error and accepts no more output after it.

    Args:
        number: The file descriptor.
        like: The stream whose encoding and buffering is used.
    """

    def __init__(self, number: int, like: TextIO) -> None:
        self._raw = _Raw(number, "wb", closefd=False)
        at_once = bool(getattr(like, "write_through", False))
        buffer = io.BufferedWriter(self._raw, io.DEFAULT_BUFFER_SIZE)
        super().__init__(buffer, like.encoding, "backslashreplace", None, bool(like.line_buffering) or at_once, at_once)

    @property
    def trouble(self) -> OSError | None:
        """The error of this output, if any."""
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
    """Reserves standard output for one writer inside the block.

    Args:
        apart: Whether to redirect all other output: what this process, or one that it starts, writes to file descriptor 1 then
            goes to standard error, so that it cannot split a line.

    Yields:
        The stream to write to: a `StandardOutput`; or the unchanged `sys.stdout` if that is not a file, or another file.
    """
    out = sys.stdout
    try:
        reserved = out.fileno() == 1
        out.flush()
    except (OSError, ValueError):
        reserved = False
    if not reserved:
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
    """Redirects file descriptor 1 to standard error inside the block, and yields another descriptor for standard output."""
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
            out.flush()  # what a model wrote without its own `sys.stdout`
        os.dup2(kept, 1)
        os.close(kept)


def all_written(out: TextIO, printed: ModelOutput | None) -> OSError | None:
    """Writes the remaining output; returns its error, if any."""
    with suppress(OSError, ValueError):  # it is full, or the model has closed it
        if printed is not None:
            printed.finish()
        out.flush()
    return out.trouble if isinstance(out, StandardOutput) else None
