"""The conflict set: the productions that matched, their utilities, and why each was chosen or not."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class ConflictSet:
    """The productions that matched at one time, and the one that was chosen."""

    utilities: Mapping[str, float]
    """The utility of each production that matched, by its name."""
    parts: Mapping[str, Mapping[str, float]]
    """What each utility module added to it, by the module's name."""
    threshold: float | None
    """The minimum utility for firing; None for no minimum."""
    weighed: bool
    """Whether utilities decided; a plain production system chooses at random."""
    chosen: str | None
    """The production that is about to fire; None if all are below the threshold, or none is left."""
    forbidden: Collection[str] = ()
    """The productions that matched, and were left out because a user had forbidden them once."""
    wanted: str | None = None
    """The production that was chosen because a user made it fire next."""

    @property
    def held_back(self) -> bool:
        """Whether even the best production is below the threshold."""
        return self.threshold is not None and bool(self.utilities) and max(self.utilities.values()) < self.threshold

    @property
    def is_current(self) -> bool:
        """Whether it is still current: a production is about to fire, or every production was below the threshold or forbidden."""
        return self.chosen is not None or self.held_back or bool(self.forbidden)

    def verdict(self, name: str) -> str | None:
        """Returns why a production was chosen or not; None if there was nothing to choose."""
        if name in self.forbidden:
            return "left out: the user had forbidden it once"
        if self.wanted is not None and self.wanted == self.chosen:
            return "selected: the user made it fire next" if name == self.wanted else f"not selected: the user made {self.wanted} fire next"
        utility = self.utilities.get(name)
        if self.held_back:
            if utility is None:
                return "did not match when utilities were last compared"
            return f"not selected: its utility {utility:.4g} is below the production threshold {self.threshold:.4g}"
        if self.chosen is None:
            return None
        if self.chosen not in self.utilities:  # a trace that begins later does not contain them
            return "selected" if name == self.chosen else None
        if name == self.chosen:
            return self._why_chosen()
        if utility is None:
            return f"did not match when {self.chosen} was selected"
        best = self.utilities[self.chosen]
        if not self.weighed:
            return f"not selected: {self.chosen} was, at random"
        if utility == best:
            return f"tie with {self.chosen}, which was chosen at random: both have utility {best:.4g}"
        return f"lost to {self.chosen}: utility {utility:.6g} against {best:.6g}"

    def _why_chosen(self) -> str:
        if len(self.utilities) < 2:
            return "selected: nothing else matched"
        best = self.utilities[self.chosen or ""]
        equal = sum(utility == best for utility in self.utilities.values()) if self.weighed else len(self.utilities)
        if equal > 1:
            return f"selected at random among {equal}" + (f" of utility {best:.4g}" if self.weighed else "")
        return f"selected: the highest utility, {best:.6g}"
