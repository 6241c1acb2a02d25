"""python_actr's `display`, which opened a window: here a model runs without one."""

from __future__ import annotations

from typing import Any

from actr3d.warnings import warn_modeller


def display(root: Any, engine: str | None = None, **args: Any) -> None:  # noqa: ARG001 - as models call it
    """Warns that no window is opened; the workbench shows worlds."""
    warn_modeller("display() opens no window here; the model runs on without it")


__all__ = ["display"]
