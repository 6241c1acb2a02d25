"""Fingers of instantiation: what was retrieved or attended to lately."""

from __future__ import annotations

from typing import Any

from actr3d.actr.model import Model


class Finst:
    """Marks a few things for a while.

    Args:
        parent: The module whose clock counts.
        size: How many marks there are.
        time: How long a mark stays [s].
    """

    def __init__(self, parent: Model, size: int = 4, time: float = 3.0) -> None:
        self.parent = parent
        self.size = size
        self.time = time
        self.obj: list[Any] = []

    def contains(self, obj: Any) -> bool:
        """Tells whether a thing is marked."""
        return obj in self.obj

    def add(self, obj: Any) -> None:
        """Marks a thing; the oldest mark goes where there are too many."""
        if self.size == 0:
            return
        self.obj.append(obj)
        if len(self.obj) > self.size:
            self.remove(self.obj[0])
        self.parent.sch.add(self.remove, delay=self.time, args=[obj])

    def remove(self, obj: Any) -> None:
        """Takes the oldest mark of a thing away."""
        if obj in self.obj:
            self.obj.remove(obj)
