"""A model that records events, for the tests of the scheduler."""

from __future__ import annotations

from typing import Any

from actr3d.actr import Model


class Part(Model):
    """A model that records events and their times."""

    def __init__(self) -> None:
        self._seen: list[tuple[Any, float]] = []

    def note(self, what: Any) -> None:
        self._seen.append((what, self.now()))


def seen(part: Any) -> list[Any]:
    return part._seen
