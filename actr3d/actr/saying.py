"""Warns at the modeller's own place: where a model stands that is run, or where something is written in its file."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

from actr3d.errors import ModelWarning

LIBRARY = str(Path(__file__).parents[1]) + os.sep
MODELS = f"{LIBRARY}models{os.sep}"
"""Where an installed library has its models, which are files like any modeller's."""


def is_library(filename: str) -> bool:
    """Tells whether a file, as a frame names it, is the library's own."""
    return filename.startswith(LIBRARY) and not filename.startswith(MODELS)


def warn_modeller(message: str) -> None:
    """Warns (`ModelWarning`) at the innermost running line that is not the library's: the modeller's."""
    frame = sys._getframe(1)
    while frame.f_back is not None and is_library(frame.f_code.co_filename):
        frame = frame.f_back
    warn_at_frame(message, frame)


def warn_at_frame(message: str, frame: FrameType) -> None:
    """Warns (`ModelWarning`) at the line at which a frame stands."""
    registry = frame.f_globals.setdefault("__warningregistry__", {})
    warnings.warn_explicit(message, ModelWarning, frame.f_code.co_filename, frame.f_lineno, registry=registry)


def warn_at(message: str, func: Callable[..., Any], line: int | None = None) -> None:
    """Warns (`ModelWarning`) at a line of a modeller's function; at its first line unless one is given."""
    code = func.__code__
    warnings.warn_explicit(message, ModelWarning, code.co_filename, line or code.co_firstlineno, registry={})
