"""Defines the conditions at which a run stops: a time, a production that fires, a buffer that matches, a contact."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.declarative.chunk_index import ChunkStore
from actr3d.actr.declarative.chunk_query import search_for
from actr3d.clock import seconds
from actr3d.trace import TraceEvent
from workbench.time_text import time_text

Contact = tuple[str, str, str]
"""A body, its part, and the other object."""
Touches = frozenset[Contact]


@dataclass
class StopConditions:
    """Holds the conditions at which the run stops next, apart from users' commands."""

    goal: int | None = None
    """Stops at this time [us]."""
    goal_reason: str = ""
    cycles: int = 0
    """Stops after this number of further firings; 0 for no such condition."""
    system: str | None = None
    """The production system whose firings are counted; None for any."""
    production: str | None = None
    buffer: str | None = None
    called: str = ""
    """The user's name of the buffer."""
    pattern: str = ""
    contact: str | None = None
    """Stops when this body touches something; an empty text means any body."""
    breakpoints: frozenset[str] = frozenset()
    met: str | None = None
    """The production of `breakpoints` because of which the run stops."""
    touching: Touches = field(default_factory=Touches)
    """The contacts that existed at the last check, which do not count as new."""

    def renewed(self, **wanted: Any) -> StopConditions:
        """Returns new stop conditions with the same breakpoints."""
        return StopConditions(breakpoints=self.breakpoints, **wanted)

    @property
    def of_events(self) -> bool:
        """Whether events must be checked."""
        return self.cycles > 0 or bool(self.breakpoints) or self.production is not None or self.buffer is not None

    @property
    def fine(self) -> bool:
        """Whether every single tick must be checked."""
        return self.of_events or self.contact is not None

    @property
    def pending(self) -> str:
        """A text that names the condition at which the run will stop."""
        parts = [] if self.goal is None else [time_text(seconds(self.goal))]
        if self.production is not None:
            parts.append(f"{self.production} fires")
        if self.buffer is not None:
            parts.append(f"{self.called} matches '{self.pattern}'" if self.pattern.strip() else f"{self.called} changes")
        if self.contact is not None:
            parts.append(f"{self.contact or 'a body'} touches something")
        return f"until {' or '.join(parts)}"

    @property
    def missed(self) -> str:
        """A text that says which conditions have not been met, for a run that is over; empty if there is nothing to say."""
        missed = [f"{self.production} did not fire"] if self.production is not None else []
        if self.buffer is not None:
            came = f"come to match '{self.pattern}'" if self.pattern.strip() else "change"
            missed.append(f"{self.called} did not {came}")
        if self.contact is not None:
            missed.append(f"{self.contact or 'no body'} touched {'nothing' if self.contact else 'anything'} more")
        return "; ".join(missed)

    def found(self, events: Iterable[TraceEvent]) -> str | None:
        """Returns why the run stops because of events; None if it does not."""
        for event in events:
            if event.kind == "fire":
                name = event.data["production"]
                if name in self.breakpoints:
                    self.met = name
                    return f"breakpoint: {name} fired"
                cycle = self.cycles > 0 and self.system in (None, event.source)
                self.cycles -= cycle
                if name == self.production or (cycle and self.cycles == 0):
                    return f"{name} fired"
            elif event.kind == "buffer" and event.source == self.buffer and self._matches(event):
                return f"{self.called} matches '{self.pattern}'" if self.pattern.strip() else f"{self.called} has changed"
        return None

    def touched(self, touches: Touches) -> str | None:
        """Returns why the run stops because of a new contact; None if there is none."""
        new, self.touching = touches - self.touching, touches
        found = sorted(touch for touch in new if self.contact in ("", touch[0]))
        return f"{found[0][1]} of {found[0][0]} touches {found[0][2]}" if found else None

    def _matches(self, event: TraceEvent) -> bool:
        slots = event.data["chunk"]
        if not slots:
            return not self.pattern.strip()
        chunk = Chunk({int(key) if key.isdecimal() else key: value for key, value in slots.items()})
        return bool(search_for(self.pattern, {}, None).among(ChunkStore([chunk])))
