"""What is told of an error that a model raises: the modeller's own lines, and none of the library's."""

from __future__ import annotations

import re
import traceback
from dataclasses import dataclass
from pathlib import Path

from actr3d.actr.python2 import PYTHON_2_NAMES
from actr3d.errors import Actr3dError, ModelFileError
from actr3d.saying import is_library


@dataclass(frozen=True, kw_only=True)
class Complaint:
    """An error as its model's author is told of it."""

    message: str
    """What went wrong, without where."""
    text: str
    """All of it, with the modeller's lines that led there; ends with a line break."""
    file: str | None
    """The file of the innermost of these lines; None where there is none."""
    line: int | None
    """Its number in that file, from 1."""


def complaint(error: BaseException) -> Complaint:
    """Returns what is told of an error, and of what caused it; a file that cannot be loaded names its own line."""
    report = traceback.TracebackException.from_exception(error)
    _keep_own_lines(report)
    if isinstance(error, ModelFileError):
        report.stack.clear()
    text = "".join(report.format())
    if isinstance(error, Actr3dError):
        if not report.stack:
            text = text.removeprefix("Traceback (most recent call last):\n")
        text = text.replace(f"{type(error).__module__}.{type(error).__qualname__}: ", "error: ")
    name = getattr(error, "name", None)
    if name in PYTHON_2_NAMES and isinstance(error, (NameError, ImportError, AttributeError)):
        text += f"'{name}' is a name of Python 2: this file is written for Python 2; convert it to Python 3\n"
    file, line = _place(error, report)
    message = str(error) if isinstance(error, Actr3dError) else "".join(report.format_exception_only()).strip()
    return Complaint(message=message, text=text, file=file, line=line)


def _place(error: BaseException, report: traceback.TracebackException) -> tuple[str | None, int | None]:
    named = re.match(r"(.+?):(\d+): ", str(error)) if isinstance(error, ModelFileError) else None
    if named is not None:
        return named[1], int(named[2])
    if isinstance(error, SyntaxError) and error.filename is not None:
        return error.filename, error.lineno
    if report.stack:
        return report.stack[-1].filename, report.stack[-1].lineno
    return None, None


def _keep_own_lines(report: traceback.TracebackException | None) -> None:
    """Leaves the library's own lines, and the loader's, out of a report and out of those of its causes."""
    if report is not None:
        own = [frame for frame in report.stack if not (is_library(frame.filename) or frame.filename.startswith("<frozen"))]
        report.stack = traceback.StackSummary.from_list([frame for frame in own if Path(frame.filename).name != "actr3d"])
        _keep_own_lines(report.__cause__)
        _keep_own_lines(report.__context__)
