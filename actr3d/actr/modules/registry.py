"""The registry of the ACT-R modules besides memory and the production systems."""

from __future__ import annotations

from typing import TypeVar

from actr3d.actr.kernel.model import Model
from actr3d.registry import Registry

M = TypeVar("M", bound="type[Model]")

MODULES: Registry[type[Model]] = Registry("module")
"""The modules by the name of their class; `actr3d.actr` exports them."""


def module(kind: M) -> M:
    """Registers a module under the name of its class.

    Raises:
        ValueError: If there is a module of this name already.
    """
    MODULES.add(kind.__name__, kind)
    return kind
