"""The old windows, which are no more: a model that asks for one runs on without."""

from __future__ import annotations

import warnings
from typing import Any

from actr3d.errors import ModelWarning


def display(root: Any, engine: str | None = None, **args: Any) -> None:  # noqa: ARG001 - as models call it
    """Says that there is no window; the workbench shows worlds."""
    warnings.warn("display() opens no window here; the model runs on without it", ModelWarning, stacklevel=2)


__all__ = ["display"]
