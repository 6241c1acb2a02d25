"""Standard output of the command: the model's own lines and the events of its run, whatever else writes there."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from typing import Any, TextIO


class _Lines(io.BufferedIOBase):
    """Takes bytes of UTF-8, and hands on whole lines of text; closing it does nothing."""

    def __init__(self, take: Callable[[str], None]) -> None:
        self._take = take
        self._rest = b""

    name = "<stdout>"

    def writable(self) -> bool:
        return True

    def write(self, data: Any, /) -> int:
        *lines, self._rest = (self._rest + bytes(data)).split(b"\n")
        for line in lines:
            self._take(_text(line))
        return len(data)

    def fileno(self) -> int:
        return 1

    def close(self) -> None:
        """Leaves it open: a wrapper that a model puts round it, and lets go, closes what it wraps."""

    def finish(self) -> None:
        """Hands on what was printed without an end of line."""
        rest, self._rest = self._rest, b""
        if rest:
            self._take(_text(rest))


class ModelOutput(io.TextIOWrapper):
    """A `sys.stdout` that hands on what a model prints line by line, also what it writes through `.buffer`.

    Args:
        take: Called with each line.
    """

    def __init__(self, take: Callable[[str], None]) -> None:
        self.lines = _Lines(take)
        super().__init__(self.lines, encoding="utf-8", errors="surrogatepass", newline="\n", write_through=True)

    def reconfigure(self, **options: Any) -> None:
        """Takes what a model says of its output's form; lines of JSON have one form only."""

    def finish(self) -> None:
        """Hands on what was printed without an end of line."""
        self.lines.finish()


def _text(line: bytes) -> str:
    try:
        return line.decode("utf-8", "surrogatepass")
    except UnicodeDecodeError:
        return line.decode("utf-8", "backslashreplace")


@contextmanager
def kept_apart(out: TextIO) -> Generator[TextIO]:
    """Keeps standard output for one writer inside the block.

    What else is written to file descriptor 1, by this process or by those that it starts, goes to standard error: it can
    neither stand in the middle of a line nor be lost.

    Args:
        out: The present standard output; one that is no file, or another, is left as it is.

    Yields:
        What to write to instead.
    """
    if not _is_standard_output(out):
        yield out
        return
    out.flush()
    with _moved(out) as own:
        yield own


def _is_standard_output(out: TextIO) -> bool:
    try:
        return out.fileno() == 1
    except (OSError, ValueError):
        return False


@contextmanager
def _moved(out: TextIO) -> Generator[TextIO]:
    kept = os.dup(1)
    try:
        os.dup2(2, 1)
    except OSError:  # standard error is closed
        _to_nowhere(1)
    own = open(kept, "w", buffering=1 if os.isatty(kept) else -1, encoding="utf-8", errors="backslashreplace", newline="\n")  # noqa: PTH123, SIM115
    try:
        yield own
    finally:
        with suppress(OSError, ValueError):
            out.flush()  # what a model has written past its own `sys.stdout`
        os.dup2(kept, 1)
        own.close()


def finished(out: TextIO) -> OSError | None:
    """Writes what is still to be written; returns what is wrong with the output, which then takes no more."""
    try:
        out.flush()
    except OSError as error:
        with suppress(OSError, ValueError):
            _to_nowhere(out.fileno())
        return error
    except ValueError:  # the model has closed it
        return None
    return None


def _to_nowhere(number: int) -> None:
    """Lets a file descriptor swallow what is written to it."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, number)
    os.close(nowhere)
