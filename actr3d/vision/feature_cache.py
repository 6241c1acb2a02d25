"""The features of the last two views, for motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from actr3d.camera import View
from actr3d.clock import seconds
from actr3d.vision.feature import Feature
from actr3d.vision.request_parser import Query

RECENT = 1_000_000
"""Age above which a view is not used for motion [us]. Source: chosen, of the order of iconic and short-term memory."""

Found = tuple[Feature, ...]


class CachedView:
    """One view, and the features that detectors have found in it.

    Args:
        view: The view, with its noise.
        time: Time of the view [us].
    """

    def __init__(self, view: View, time: int) -> None:
        self.view = view
        self.time = time
        self._found: dict[Any, Found] = {}

    def features(self, query: Query) -> Found:
        """Returns all features that the detector of a request finds."""
        key = query.detector.name, query.parameters
        if key not in self._found:
            self._found[key] = query.detector(self.view, **dict(query.parameters))
        return self._found[key]


class FeatureCache:
    """The present view and the one before."""

    def __init__(self) -> None:
        self._now: CachedView | None = None
        self._before: CachedView | None = None

    def add(self, view: View, time: int) -> None:
        """Adds a view of a time [us]; it replaces one of the same time."""
        if self._now is None or self._now.time < time:
            self._before = self._now
        self._now = CachedView(view, time)

    def features(self, query: Query) -> Found:
        """Returns the features that a request's detector finds now, with their changes since the view before.

        Each view has its own noise; the changes therefore contain noise, too.
        """
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
    """Returns a feature with its change since the view before; among several candidates (windows in one wall), from the nearest."""
    if not before:
        return feature
    return feature.since(min(before, key=lambda old: abs(old.direction - feature.direction)), elapsed)
