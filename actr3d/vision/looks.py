"""What a mind has seen at its last looks, so that it knows what has changed."""

from __future__ import annotations

from typing import Any

from actr3d.camera import View
from actr3d.clock import seconds
from actr3d.vision.feature import Feature
from actr3d.vision.query import Query

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
        known = {feature.key: feature for feature in reversed(before.features(query))}
        elapsed = seconds(self._now.time - before.time)
        return tuple(feature if (old := known.get(feature.key)) is None else feature.since(old, elapsed) for feature in found)
