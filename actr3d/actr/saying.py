"""Warns at the modeller's own place while a model runs."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

from actr3d.errors import ModelWarning

_LIBRARY = str(Path(__file__).parents[1])


def warn_modeller(message: str) -> None:
    """Warns (`ModelWarning`) at the innermost running line that is not the library's: the modeller's."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_LIBRARY):
        frame = frame.f_back
    registry = frame.f_globals.setdefault("__warningregistry__", {})
    warnings.warn_explicit(message, ModelWarning, frame.f_code.co_filename, frame.f_lineno, registry=registry)
