"""One request to vision, and its result."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

from actr3d.actr.modules.port import CallSite, Reading
from actr3d.camera import View
from actr3d.vision.feature import Feature
from actr3d.vision.request_parser import Query, Test, refusal
from actr3d.vision.salience import Function, Rule, share, survivors, weigh


class Search(Reading):
    """A request in progress; `yield` it to wait until it is over."""

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
        "site",
        "view",
        "weights",
        "why",
    )
    noticed: Sequence[Feature]
    """The features that pass all tests."""
    weights: Sequence[float]
    """The salience of each."""
    refused: list[tuple[Feature, Test]]
    """The other features, with the test that each fails."""
    chosen: int | None
    """The index of the chosen feature in `noticed`."""
    why: str | None
    """Why no feature is chosen: nothing was noticed by error, none was drawn (rule `sos`), or the chosen one was lost; None otherwise."""
    outcome: str
    """The result, in a word."""
    again: bool
    """Whether it waits for a second view, to check whether the chosen feature is still there."""
    noise: int | None
    """The seed of the noise in its views; None before the first."""
    view: View | None
    """The exact view; for observers only, not for agents."""
    perceived: View | None
    """The view with noise, in which the features were found."""

    def __init__(self, query: Query, *, bottom_up: bool, site: CallSite | None = None) -> None:
        super().__init__("view")
        self.query = query
        self.bottom_up = bottom_up
        self.site = site
        """Where the modeller makes the request."""
        self.begun = 0
        """Time of its start [us]."""
        self.due = 0
        """Time of its end [us], unless the view comes later."""
        self.seen = 0
        """Time of its view [us]."""
        self.clear()
        self._value = None

    def clear(self) -> None:
        """Resets its results, before it begins again."""
        self.noticed, self.weights, self.refused, self.chosen, self.why, self.outcome = (), (), [], None, None, "pending"
        self.again, self.noise, self.view, self.perceived = False, None, None, None

    def divide(self, features: Sequence[Feature], salience: Function) -> None:
        """Divides features into those that pass all tests, with their salience, and the others.

        Raises:
            VisionError: If a salience is not a number >= 0.
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

    def choose(self, rule: Rule, random: Random) -> None:
        """Draws one of those noticed, by a rule."""
        if not self.noticed:
            return
        if rule == "share":
            self.chosen = share(self.weights, random)
            return
        left = survivors(self.weights, random)
        if left:
            self.chosen = random.choice(left)
        else:
            self.why = "no feature was drawn"

    def update_chosen(self, features: Sequence[Feature]) -> None:
        """Updates the chosen feature from a second view; drops it if it is gone or fails a test now."""
        chosen = self.feature
        if chosen is None or self.chosen is None:
            return
        same = [one for one in features if one.key == chosen.key and self.query.failing(one) is None]
        if same:
            now = min(same, key=lambda one: abs(one.direction - chosen.direction))
            self.noticed = [*self.noticed[: self.chosen], now, *self.noticed[self.chosen + 1 :]]
        else:
            self.chosen, self.why = None, "the chosen feature was no longer visible, or failed a test"

    @property
    def feature(self) -> Feature | None:
        """The chosen feature; None if there is none."""
        return None if self.chosen is None else self.noticed[self.chosen]

    def describe(self) -> str:
        """Returns a description of the request."""
        return f"search for '{self.query.asked}'"

    def to_data(self) -> dict[str, Any]:
        """Returns the search as plain values, for the trace."""
        return {
            "asked": self.query.asked,
            "bottom_up": self.bottom_up,
            "noticed": [[feature.slots(), weight] for feature, weight in zip(self.noticed, self.weights, strict=True)],
            "refused": [[feature.slots(), refusal(test, feature)] for feature, test in self.refused],
            "chosen": self.chosen,
            **({} if self.why is None else {"why": self.why}),
        }
