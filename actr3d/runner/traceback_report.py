"""Reports an error that a model raises: with the modeller's own lines, and none of the library's."""

from __future__ import annotations

import re
import sysconfig
import traceback
from dataclasses import dataclass
from pathlib import Path

from actr3d.actr.kernel.parameters import elsewhere
from actr3d.actr.loading.python2 import PYTHON_2_NAMES
from actr3d.errors import Actr3dError, ModelFileError, hint_for
from actr3d.warnings import is_generated, is_library

PYTHON = tuple({sysconfig.get_path(kind) for kind in ("stdlib", "platstdlib", "purelib", "platlib")})
"""The folders of Python's own modules and of installed packages."""


@dataclass(frozen=True, kw_only=True)
class TracebackReport:
    """The report of an error to the model's author."""

    message: str
    """The error message with its notes, such as the production in which it occurred; without the place."""
    text: str
    """The whole report, with the modeller's lines that led there; ends with a line break."""
    file: str | None
    """The file of the line that caused the error, or else of the innermost of these lines that is not Python's own or a package's, or
    else of the innermost line; None if none."""
    line: int | None
    """Its number in that file, from 1."""


def traceback_report(error: BaseException, hidden: str | None = None) -> TracebackReport:
    """Returns the report of an error and its causes; a file that cannot be loaded names its own line.

    Args:
        error: The error.
        hidden: The folder of the program that runs the model, whose lines are omitted too.
    """
    report = traceback.TracebackException.from_exception(error)
    _keep_own_lines(report, hidden)
    if isinstance(error, ModelFileError) or (isinstance(error, Actr3dError) and all(f.filename.startswith(PYTHON) for f in report.stack)):
        report.stack.clear()
    text = "".join(report.format())
    if isinstance(error, Actr3dError):
        if not report.stack:
            text = text.removeprefix("Traceback (most recent call last):\n")
        text = text.replace(_name_of(error), "error: ")
    name = getattr(error, "name", None)
    if name in PYTHON_2_NAMES and isinstance(error, (NameError, ImportError, AttributeError)):
        text += f"'{name}' is a name of Python 2: this file is written for Python 2; convert it to Python 3\n"
    file, line = _place(error, report, hidden)
    # The file name of a text in tracebacks may be a subclass of `str`.
    file = None if file is None else str(file)
    message = "".join(report.format_exception_only()).strip()
    if isinstance(error, Actr3dError):
        message = message.removeprefix(_name_of(error))
    if hint := _hint(error, message):
        message, text = (words.replace(str(error), f"{error}{hint}") for words in (message, text))
    return TracebackReport(message=message, text=text, file=file, line=line)


def _hint(error: BaseException, message: str) -> str:
    """Returns a hint such as `"; did you mean 'x'?"` for a name that nothing defines; an empty string if Python has one itself, or none."""
    if "id you mean" in message:
        return ""
    if isinstance(error, AttributeError):
        return elsewhere(error.obj)
    if not isinstance(error, NameError) or not str(error) or error.__traceback__ is None:
        return ""
    *_, (frame, _) = traceback.walk_tb(error.__traceback__)
    return hint_for(error, {**frame.f_builtins, **frame.f_globals, **frame.f_locals})


def failure(error: BaseException) -> str:
    """Returns the description of an error that ends a run, as recorded; a replay compares it."""
    try:
        words = str(error)
    except Exception:  # noqa: BLE001 - the words are the model's own, too
        words = "<exception str() failed>"
    return f"{type(error).__name__}: {words}".encode("utf-8", "replace").decode()


def _name_of(error: BaseException) -> str:
    return f"{type(error).__module__}.{type(error).__qualname__}: "


def _place(error: BaseException, report: traceback.TracebackException, hidden: str | None) -> tuple[str | None, int | None]:
    named = re.match(r"(.+?):(\d+): ", str(error)) if isinstance(error, ModelFileError) else None
    if named is not None:
        return named[1], int(named[2])
    if isinstance(error, SyntaxError) and error.filename is not None:
        return error.filename, error.lineno
    if isinstance(error, Actr3dError) and error.location is not None and not _is_ours(error.location[0], hidden):
        return error.location
    if report.stack:
        own = [frame for frame in report.stack if not frame.filename.startswith(PYTHON)] or report.stack
        return own[-1].filename, own[-1].lineno
    return None, None


def _keep_own_lines(report: traceback.TracebackException | None, hidden: str | None) -> None:
    """Removes the lines of the library and the loader from a report and from the reports of its causes."""
    if report is not None:
        own = [one for one in report.stack if not _is_ours(one.filename, hidden) and not is_generated(one.filename, one.name)]
        report.stack = traceback.StackSummary.from_list(own)
        _keep_own_lines(report.__cause__, hidden)
        _keep_own_lines(report.__context__, hidden)


def _is_ours(file: str, hidden: str | None) -> bool:
    loader = file.startswith("<frozen") or Path(file).name == "actr3d"
    return loader or is_library(file) or (hidden is not None and file.startswith(hidden))
