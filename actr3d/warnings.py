"""Warns at the modeller's own line: the running line of the model, or the line in its file that causes the warning."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from traceback import walk_tb
from types import CodeType, FrameType
from typing import Any

from actr3d.errors import Actr3dError, ModelWarning

LIBRARY = str(Path(__file__).parent) + os.sep
MODELS = f"{LIBRARY}models{os.sep}"
"""The folder of the models in an installed library; they count as a modeller's files."""


def is_library(filename: str) -> bool:
    """Checks whether a file name, as given in a frame, belongs to the library."""
    return filename.startswith(LIBRARY) and not filename.startswith(MODELS)


def of_library(code: CodeType) -> bool:
    """Checks whether code belongs to the library."""
    return is_library(code.co_filename) or is_generated(code.co_filename, code.co_name)


def is_generated(filename: str, function: str) -> bool:
    """Checks for the `__init__` that a dataclass generates: it has no file, and runs between a configuration's checks and its caller."""
    return filename == "<string>" and function == "__init__"


def locate(error: Exception, file: str, line: int) -> None:
    """Sets the location of an error of the library, unless it has one or a line of the modeller's led to it."""
    if not isinstance(error, Actr3dError) or error.location is not None or is_library(file):
        return
    if all(of_library(frame.f_code) for frame, _ in walk_tb(error.__traceback__)):
        error.at(file, line)


def warn_modeller(message: str) -> None:
    """Warns (`ModelWarning`) at the innermost running line that is not the library's: the modeller's."""
    frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage] # Python documents it
    while frame.f_back is not None and of_library(frame.f_code):
        frame = frame.f_back
    warn_at_frame(message, frame)


def warn_at_frame(message: str, frame: FrameType) -> None:
    """Warns (`ModelWarning`) at the current line of a frame."""
    registry = frame.f_globals.setdefault("__warningregistry__", {})
    warnings.warn_explicit(message, ModelWarning, frame.f_code.co_filename, frame.f_lineno, registry=registry)


def warn_at(message: str, func: Callable[..., Any], line: int | None = None) -> None:
    """Warns (`ModelWarning`) at a line of a modeller's function; by default at its first line."""
    code = func.__code__
    warnings.warn_explicit(message, ModelWarning, code.co_filename, line or code.co_firstlineno, registry={})
