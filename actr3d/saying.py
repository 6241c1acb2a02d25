"""Warns at the modeller's own place while a model runs."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from types import CodeType

from actr3d.errors import ModelWarning

_LIBRARY = str(Path(__file__).parent)


def warn_modeller(message: str) -> None:
    """Warns (`ModelWarning`) at the innermost running line that is not the library's: the modeller's."""
    frame = sys._getframe(1)
    while frame.f_back is not None and _of_the_library(frame.f_code):
        frame = frame.f_back
    registry = frame.f_globals.setdefault("__warningregistry__", {})
    warnings.warn_explicit(message, ModelWarning, frame.f_code.co_filename, frame.f_lineno, registry=registry)


def _of_the_library(code: CodeType) -> bool:
    # A dataclass's own `__init__`, between a configuration's checks and who makes it, has no file.
    return code.co_filename.startswith(_LIBRARY) or (code.co_filename == "<string>" and code.co_name == "__init__")
