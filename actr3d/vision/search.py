"""One request to vision, and what came of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from actr3d.actr.modules.port import Reading
from actr3d.vision.feature import Feature
from actr3d.vision.query import Query, Test, refusal


class Search(Reading):
    """A request that is under way; `yield` it to wait until it is over."""

    __slots__ = ("begun", "bottom_up", "chosen", "due", "noticed", "query", "refused", "weights", "why")

    def __init__(self, query: Query, *, bottom_up: bool, begun: int, due: int) -> None:
        super().__init__("view")
        self.query = query
        self.bottom_up = bottom_up
        self.begun = begun
        """When it was begun [us]."""
        self.due = due
        """When it ends [us], unless the view comes later."""
        self.noticed: Sequence[Feature] = ()
        """What is as was asked for."""
        self.weights: Sequence[float] = ()
        """How salient each of these is."""
        self.refused: list[tuple[Feature, Test]] = []
        """What is not, and what it fails."""
        self.chosen: int | None = None
        """Which of those noticed is brought."""
        self.why: str | None = None
        """Why none is brought, though some are noticed."""
        self._value = None

    @property
    def feature(self) -> Feature | None:
        """What is brought; None where nothing was found."""
        return None if self.chosen is None else self.noticed[self.chosen]

    def describe(self) -> str:
        """Names what was asked."""
        return f"search for '{self.query.asked}'"

    def to_data(self) -> dict[str, Any]:
        """Returns all of it as plain values, for the trace."""
        return {
            "asked": self.query.asked,
            "bottom_up": self.bottom_up,
            "noticed": [[feature.slots(), weight] for feature, weight in zip(self.noticed, self.weights, strict=True)],
            "refused": [[feature.slots(), refusal(test, feature)] for feature, test in self.refused],
            "chosen": self.chosen,
            **({} if self.why is None else {"why": self.why}),
        }
