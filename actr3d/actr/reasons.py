"""What an explanation says: why productions match or not, why chunks are retrieved, why searches find something.

Plain data and its text; `actr3d.actr.explain` makes it. It is not in that package because the core returns it (`ProductionSystem.explain`)
and must not import what stands above it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from actr3d.errors import did_you_mean

MAX_SHOWN = 12
"""The number of candidates or features that are printed; the data contain all."""


@dataclass(frozen=True, kw_only=True)
class ConditionReason:
    """Whether one condition of a production holds."""

    condition: str
    holds: bool | None
    """None if it is not known, for example because it depends on a variable that no condition has bound."""
    expected: str
    found: str
    source: str | None
    """How what was found is known; None if it is certain at that time."""


@dataclass(frozen=True, kw_only=True)
class ProductionReason:
    """Why one production matches or does not, and why it was chosen or not."""

    name: str
    system: str
    """The production system it belongs to, as a dotted path."""
    parents: tuple[str, ...] = ()
    """The two productions that a compiled one was made from."""
    matches: bool | None
    """None if it is not known: see `condition` and `found`."""
    condition: str | None = None
    """The first of `conditions` that fails, for the text of the reason; None if all hold."""
    expected: str | None = None
    found: str | None = None
    source: str | None = field(default=None, compare=False)
    """How what was found is known, such as «as seen since 0.050 s»; None if it is certain at that time."""
    bindings: Mapping[str, str]
    """The variables bound by the conditions before the failing one."""
    conditions: tuple[ConditionReason, ...] = field(default=(), compare=False)
    """All conditions in the order in which they are tested; also those after the failing one, as far as they are known."""
    utility: float | None
    """The sum of the parts; None if a part is not known."""
    parts: Mapping[str, float | None]
    """The production's own utility as «base», and what each utility module adds, by its name; None if it is not known: noise is
    drawn only when a choice is made. If the agent has its own `get_activation`, only its result."""
    selected: bool
    """Whether it has been chosen and is about to fire, if it still matches then."""
    verdict: str | None
    """Why it was chosen or lost at the latest choice, with the utilities of that moment; None if there is no current choice."""

    def __str__(self) -> str:
        bound = "".join(f"  ?{name}={value}" for name, value in self.bindings.items())
        source = "" if self.source is None else f" ({self.source})"
        origin = f"  (compiled from {' and '.join(self.parents)})" if self.parents else ""
        if self.matches:
            lines = [f"  + {self.name}: matches{bound}{source}{origin}"]
        else:
            sign = "?" if self.matches is None else "-"
            lines = [
                f"  {sign} {self.name}: {self.condition}{origin}",
                f"      expected {self.expected}, found {self.found}{source}{bound}",
            ]
        if self.selected:
            lines[0] += f"  <- {self.verdict or 'selected'}{'' if self.matches else ', but it no longer matches'}"
        elif self.matches and self.verdict is not None:
            lines.append(f"      {self.verdict}")
        utility = "unknown" if self.utility is None else f"{self.utility:.4g}"
        if list(self.parts) == ["base"]:
            return "\n".join([*lines, f"      utility {utility}"])
        parts = "  ".join(f"{name} {'not drawn' if value is None else format(value, '.4g')}" for name, value in self.parts.items())
        return "\n".join([*lines, f"      utility {utility}  ({parts})"])


@dataclass(frozen=True, kw_only=True)
class CandidateReason:
    """The activation of one candidate of a request."""

    chunk: str
    activation: float
    parts: Mapping[str, float]
    """What each activation module added, by its class (numbered if there are several), and «partial», the mismatch penalty."""
    verdict: str
    """Why it won or lost."""

    def __str__(self) -> str:
        parts = "  ".join(f"{name} {value:.4g}" for name, value in self.parts.items())
        return f"      {self.chunk}: activation {self.activation:.4g}{f'  ({parts})' if parts else ''}, {self.verdict}"


@dataclass(frozen=True, kw_only=True)
class RetrievalReason:
    """The last request to a memory, and its outcome."""

    memory: str
    time: float
    """The time of the request [s]."""
    request: str
    """The pattern as it was written."""
    asked: str
    """The pattern with the values of its variables."""
    threshold: float | None
    require_new: bool
    finsts: tuple[str, ...]
    """The chunks that counted as retrieved recently."""
    excluded: tuple[str, ...]
    """Matching chunks that were excluded for that reason."""
    candidates: tuple[CandidateReason, ...]
    """The matching chunks, most active first."""
    outcome: str
    """«retrieved», «failed», or «pending»: the answer is still on its way."""
    latency: float | None
    """The time until the answer [s]; None if it is not known yet."""

    def __str__(self) -> str:
        limit = "no threshold" if self.threshold is None else f"threshold {self.threshold:g}"
        takes = "" if self.latency is None else f" ({self.latency:.6g} s)"
        asked = f"request '{self.request}' at {self.time:.3f} s, asked for '{self.asked}'"
        lines = [f"  {self.memory}: {asked}, {limit}: {self.outcome}{takes}"]
        if self.finsts:
            lines.append(f"      retrieved recently: {'; '.join(self.finsts)}")
        shown = self.candidates if len(self.candidates) <= MAX_SHOWN + 1 else self.candidates[:MAX_SHOWN]
        lines += [f"      {chunk}: left out, because it was retrieved recently" for chunk in self.excluded]
        if not self.candidates:
            lines.append("      no chunk matches" + (" that is new" if self.excluded else ""))
        lines += map(str, shown)
        if len(shown) < len(self.candidates):
            lines.append(f"      and {len(self.candidates) - len(shown):,} more, none of them more active")
        return "\n".join(lines)


@dataclass(frozen=True, kw_only=True)
class FeatureReason:
    """The result of a search for one feature."""

    feature: str
    salience: float | None
    """None if the feature does not match the request."""
    verdict: str
    """Why it was chosen or not."""

    def __str__(self) -> str:
        weight = "" if self.salience is None else f"salience {self.salience:.4g}, "
        return f"      {self.feature}: {weight}{self.verdict}"


@dataclass(frozen=True, kw_only=True)
class SearchReason:
    """The last search of a module in a view, top-down or bottom-up, and its outcome."""

    module: str
    time: float
    """The time of its view [s]."""
    asked: str
    """The request with the values of its variables."""
    bottom_up: bool
    features: tuple[FeatureReason, ...]
    """The noticed features, then the refused ones."""
    outcome: str
    """«found», «found, but the buffer was kept», «failed», or «pending»: the answer is still on its way."""
    why: str | None
    """Why nothing was found although something was noticed, or could have been."""

    def __str__(self) -> str:
        way = "bottom-up search" if self.bottom_up else "search"
        why = "" if self.why is None else f": {self.why}"
        lines = [f"  {self.module}: {way} at {self.time:.3f} s for '{self.asked}': {self.outcome}{why}"]
        if not self.features and self.why is None:
            lines.append("      nothing of that kind was seen")
        lines += map(str, self.features[:MAX_SHOWN])
        if len(self.features) > MAX_SHOWN:
            lines.append(f"      and {len(self.features) - MAX_SHOWN} more")
        return "\n".join(lines)


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """The explanation of an agent's behaviour at one time."""

    time: float
    """[s]"""
    agent: str
    begun: bool
    """Whether the agent had begun to run; before that, its methods without parameters have not run."""
    productions: tuple[ProductionReason, ...]
    retrievals: tuple[RetrievalReason, ...]
    searches: tuple[SearchReason, ...] = ()
    """The last top-down and the last bottom-up search of each vision module."""

    def production(self, name: str) -> ProductionReason:
        """Returns the reason of one production.

        Raises:
            KeyError: If there is none of that name.
        """
        for reason in self.productions:
            if reason.name == name:
                return reason
        raise KeyError(f"no production '{name}'{did_you_mean(name, [reason.name for reason in self.productions])}")

    def __str__(self) -> str:
        lines = [f"{self.agent} at {self.time:.3f} s{'' if self.begun else ', before its first run'}"]
        system = self.agent
        for reason in self.productions:
            if reason.system != system:
                system = reason.system
                lines.append(f"  in {system}:")
            lines.append(str(reason))
        return "\n".join([*lines, *map(str, self.retrievals), *map(str, self.searches)])
