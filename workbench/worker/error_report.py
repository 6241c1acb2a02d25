"""Formats errors in a worker for the user."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec

from actr3d.errors import RecordingError
from actr3d.runner.traceback_report import traceback_report
from workbench.worker.memory import relieve
from workbench.worker.messages import Notice, notice, shortened

_HERE = str(Path(__file__).parents[1])

UNFORESEEN = (Exception, SystemExit, KeyboardInterrupt)
"""All exceptions that a model may raise and that are reported to its author, but not those that end a run from outside."""


def describe_error(error: BaseException) -> str:
    """Returns a short description of an error."""
    if isinstance(error, MemoryError):
        return "the model used more memory than it may"
    if isinstance(error, SystemExit):
        return f"the model ended its process (SystemExit: {error.code})"
    try:
        report = traceback_report(error, _HERE)
        # A production of the same file is found by its name.
        text = re.sub(rf" \({re.escape(report.file)}:\d+\)", "", report.message) if report.file else report.message
        return shortened(text) or type(error).__name__
    except MemoryError:
        return f"{type(error).__name__}, and not enough memory is left to say more"


def notice_of(error: BaseException) -> Notice:
    """Returns the notice for the user about an error, with the line of the model where it occurred, unless the model did not cause it."""
    if isinstance(error, RecordingError):
        return msgspec.structs.replace(notice("error", describe_error(error)), unwritten=True)
    if isinstance(error, MemoryError):
        relieve()
    try:
        report = traceback_report(error, _HERE)
        text = describe_error(error).removeprefix(f"{report.file}:{report.line}: ")  # the notice has the position in separate fields
        return notice("error", text, report.file, report.line, report.text)
    except MemoryError:
        return notice("error", describe_error(error))
