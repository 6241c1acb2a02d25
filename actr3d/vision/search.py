"""One request to vision, and what came of it."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

from actr3d.actr.modules.port import Reading
from actr3d.camera import View
from actr3d.vision.feature import Feature
from actr3d.vision.request_parser import Query, Test, refusal
from actr3d.vision.salience import Function, share, survivors, weigh


class Search(Reading):
    """A request that is under way; `yield` it to wait until it is over."""

    __slots__ = (
        "again",
        "begun",
        "bottom_up",
        "chosen",
        "due",
        "noise",
        "noticed",
        "outcome",
        "perceived",
        "query",
        "refused",
        "seen",
        "view",
        "weights",
        "why",
    )
    noticed: Sequence[Feature]
    """What is as was asked for."""
    weights: Sequence[float]
    """How salient each of these is."""
    refused: list[tuple[Feature, Test]]
    """What is not, and what it fails."""
    chosen: int | None
    """Which of those noticed is brought."""
    why: str | None
    """Why none is brought, though some are noticed."""
    outcome: str
    """What came of it, in a word."""
    again: bool
    """Whether it has looked, and waits for a second view, to see whether what it has chosen is still there."""
    noise: int | None
    """What the noise of its views comes from, once it has one."""
    view: View | None
    """What was seen when it looked; for who looks on, no mind gets it."""
    perceived: View | None
    """The same as it was misjudged, in which the features were found."""

    def __init__(self, query: Query, *, bottom_up: bool, begun: int, due: int) -> None:
        super().__init__("view")
        self.query = query
        self.bottom_up = bottom_up
        self.begun = begun
        """When it was begun [us]."""
        self.due = due
        """When it ends [us], unless the view comes later."""
        self.seen = begun
        """When its view was taken in [us]."""
        self.clear()
        self._value = None

    def clear(self) -> None:
        """Forgets what it has found; it begins anew."""
        self.noticed, self.weights, self.refused, self.chosen, self.why, self.outcome = (), (), [], None, None, "pending"
        self.again, self.noise, self.view, self.perceived = False, None, None, None

    def sift(self, features: Sequence[Feature], salience: Function) -> None:
        """Notes what of the features is as was asked for and how salient it is, and what is not.

        Raises:
            VisionError: If a salience is no number from 0 on.
        """
        noticed: list[Feature] = []
        for feature in features:
            test = self.query.failing(feature)
            if test is None:
                noticed.append(feature)
            else:
                self.refused.append((feature, test))
        self.noticed = noticed
        self.weights = weigh(noticed, salience, f"the salience of '{self.query.detector.name}'")

    def choose(self, rule: str, random: Random) -> None:
        """Draws one of those noticed, by a rule of `RULES`."""
        if not self.noticed:
            return
        if rule == "share":
            self.chosen = share(self.weights, random)
            return
        left = survivors(self.weights, random)
        if left:
            self.chosen = random.choice(left)
        else:
            self.why = "none survived"

    def check(self, features: Sequence[Feature]) -> None:
        """Takes what was chosen as it is now; nothing, if it is no longer among the features, or no longer as was asked for."""
        chosen = self.feature
        if chosen is None or self.chosen is None:
            return
        same = [one for one in features if one.key == chosen.key and self.query.failing(one) is None]
        if same:
            now = min(same, key=lambda one: abs(one.direction - chosen.direction))
            self.noticed = [*self.noticed[: self.chosen], now, *self.noticed[self.chosen + 1 :]]
        else:
            self.chosen, self.why = None, "what was chosen had gone"

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
