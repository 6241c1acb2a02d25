"""The old windows, which are no more: a model that asks for one runs on without."""

from __future__ import annotations

from typing import Any

from actr3d.saying import warn_modeller


def display(root: Any, engine: str | None = None, **args: Any) -> None:  # noqa: ARG001 - as models call it
    """Says that there is no window; the workbench shows worlds."""
    warn_modeller("display() opens no window here; the model runs on without it")


__all__ = ["display"]
