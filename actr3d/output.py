"""Output: captures what a model prints, line by line, and keeps its lines and events apart from all other output of the command."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Generator, Iterable
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TextIO, cast

from actr3d.errors import reason_of


class _Lines(io.BufferedIOBase):
    """Receives UTF-8 bytes, and passes on whole lines of text; closing it has no effect."""

    def __init__(self, take: Callable[[str], None], number: int = 1) -> None:
        self._take = take
        self._number = number
        self._rest = b""
        self.name = "<stdout>" if number == 1 else "<stderr>"

    def writable(self) -> bool:
        return True

    def write(self, data: Any, /) -> int:
        *lines, self._rest = (self._rest + bytes(data)).split(b"\n")
        for line in lines:
            self._take(_text(line))
        return len(data)

    def fileno(self) -> int:
        return self._number

    def close(self) -> None:
        """Does nothing: a wrapper that a model creates and drops would otherwise close this stream."""

    def forget(self) -> None:
        """Discards an unfinished line."""
        self._rest = b""

    def finish(self) -> None:
        """Passes on an unfinished line."""
        rest, self._rest = self._rest, b""
        if rest:
            self._take(_text(rest))


class ModelOutput(io.TextIOWrapper):
    """A `sys.stdout` or `sys.stderr` that passes on what a model writes line by line, including output through `.buffer`.

    Args:
        take: Called with each line.
        number: The file descriptor that it replaces.
    """

    def __init__(self, take: Callable[[str], None], number: int = 1) -> None:
        self.lines = _Lines(take, number)
        super().__init__(self.lines, encoding="utf-8", errors="surrogatepass", newline="\n", write_through=True)

    def reconfigure(self, **options: Any) -> None:
        """Ignores the options: lines of JSON have a fixed encoding."""

    def finish(self) -> None:
        """Passes on an unfinished line."""
        self.lines.finish()


class _BothBytes(io.BufferedIOBase):
    """The byte stream of a `TeeOutput`."""

    def __init__(self, tee: TeeOutput, out: Any) -> None:
        self._tee = tee
        self._out = out

    def writable(self) -> bool:
        return True

    def write(self, data: Any, /) -> int:
        return self._tee.take(self._out.write, data, bytes(data))

    def flush(self) -> None:
        self._out.flush()

    def close(self) -> None:
        """Does nothing, as in `_Lines`."""


class TeeOutput:
    """A `sys.stdout` for a `with` block, which writes to the previous output, and also passes on each line.

    Args:
        take: Called with each line.
    """

    def __init__(self, take: Callable[[str], None]) -> None:
        self._lines = _Lines(take)
        self._out: Any = sys.stdout
        self._stack = ExitStack()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._out, name)

    @property
    def buffer(self) -> Any:
        """The byte stream of this output."""
        return _BothBytes(self, self._out.buffer)

    def write(self, text: str, /) -> int:
        """Writes a text."""
        return self.take(self._out.write, text, text.encode("utf-8", "surrogatepass"))

    def writelines(self, texts: Iterable[str], /) -> None:
        """Writes several texts."""
        for text in texts:
            self.write(text)

    def take(self, write: Callable[[Any], int], data: Any, encoded: bytes) -> int:
        """Writes data, and passes on its lines.

        Args:
            write: The function that writes it.
            data: The data.
            encoded: The same data as UTF-8 bytes.
        """
        count = write(data)
        self._lines.write(encoded)
        return count

    def finish(self) -> None:
        """Passes on an unfinished line."""
        self._lines.finish()

    def forget(self) -> None:
        """Discards an unfinished line."""
        self._lines.forget()

    def __enter__(self) -> Self:
        self._stack.enter_context(printing_to(cast("TextIO", self)))
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        self._stack.close()


def printing_nothing() -> AbstractContextManager[None]:
    """Discards what a model prints inside the block."""
    return printing_to(ModelOutput(lambda _: None))


@contextmanager
def printing_to(out: TextIO) -> Generator[None]:
    """Redirects what a model prints to `out` inside the block."""
    before = sys.stdout, sys.__stdout__
    names = sys.__dict__  # type checkers take `sys.__stdout__` for a constant
    sys.stdout = names["__stdout__"] = out
    try:
        yield
    finally:
        sys.stdout, names["__stdout__"] = before


def _text(line: bytes) -> str:
    try:
        return line.decode("utf-8", "surrogatepass")
    except UnicodeDecodeError:
        return line.decode("utf-8", "backslashreplace")


# -- the command's standard output


class StandardOutput(io.TextIOWrapper):
    """Standard output as a separate file, which stores its first error and accepts no more output after it.

    Args:
        number: The file descriptor.
        like: The stream whose encoding and buffering, and whose `raises` if it has one, is used.
    """

    def __init__(self, number: int, like: TextIO) -> None:
        self._raw = _Raw(number, "wb", closefd=False)
        self.raises = getattr(like, "raises", True)
        at_once = bool(getattr(like, "write_through", False))
        buffer = io.BufferedWriter(self._raw, io.DEFAULT_BUFFER_SIZE)
        super().__init__(buffer, like.encoding, "backslashreplace", None, bool(like.line_buffering) or at_once, at_once)

    @property
    def trouble(self) -> OSError | None:
        """The error of this output, if any."""
        return self._raw.trouble

    @property
    def raises(self) -> bool:
        """Whether the error is raised where it occurs, too."""
        return self._raw.raises

    @raises.setter
    def raises(self, raises: bool) -> None:
        self._raw.raises = raises


class _Raw(io.FileIO):
    trouble: OSError | None = None
    raises = True

    def write(self, data: Any, /) -> int:
        if self.trouble is None:
            try:
                return super().write(data)
            except OSError as error:
                self.trouble = error
                if self.raises:
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
    if sys.stdout is None:  # it was closed before the command started
        sys.stdout = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 - it stays open until the end
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


def report_unwritten(error: OSError) -> int:
    """Prints why the output cannot be written, unless its reader has only closed it; returns the exit code."""
    if not isinstance(error, BrokenPipeError):
        print(f"error: cannot write the output: {reason_of(error)}", file=sys.stderr)
    return 1
