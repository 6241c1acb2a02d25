"""What a mind has seen at its last looks, so that it knows what has changed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from actr3d.camera import View
from actr3d.clock import seconds
from actr3d.vision.feature import Feature
from actr3d.vision.request_parser import Query

RECENT = 1_000_000
"""What was seen longer ago than this tells nothing of motion any more [us]. Ours, of the order of iconic and short-term memory."""

Found = tuple[Feature, ...]


class Look:
    """One view, and what detectors have found in it.

    Args:
        view: The view, with its noise.
        time: When [us].
    """

    def __init__(self, view: View, time: int) -> None:
        self.view = view
        self.time = time
        self._found: dict[Any, Found] = {}

    def features(self, query: Query) -> Found:
        """Returns all that the detector of a request finds."""
        key = query.detector.name, query.parameters
        if key not in self._found:
            self._found[key] = query.detector(self.view, **dict(query.parameters))
        return self._found[key]


class Looks:
    """The present look and the one before."""

    def __init__(self) -> None:
        self._now: Look | None = None
        self._before: Look | None = None

    def take(self, view: View, time: int) -> None:
        """Takes a new view in, seen at a time [us]; a second one of the same time takes the first one's place."""
        if self._now is None or self._now.time < time:
            self._before = self._now
        self._now = Look(view, time)

    def features(self, query: Query) -> Found:
        """Returns what a request's detector finds now, with how it has changed since the look before."""
        assert self._now is not None
        found, before = self._now.features(query), self._before
        if before is None or self._now.time - before.time > RECENT:
            return found
        known: dict[Any, list[Feature]] = {}
        for feature in before.features(query):
            known.setdefault(feature.key, []).append(feature)
        elapsed = seconds(self._now.time - before.time)
        return tuple(_since(feature, known.get(feature.key, ()), elapsed) for feature in found)


def _since(feature: Feature, before: Sequence[Feature], elapsed: float) -> Feature:
    """Returns a feature with what is known from the look before; of several that may be it (windows in one wall), the nearest."""
    if not before:
        return feature
    return feature.since(min(before, key=lambda old: abs(old.direction - feature.direction)), elapsed)
