"""What a run is to stop for: a time, a production that fires, a buffer that matches, a touch."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.declarative.chunk_index import ChunkStore
from actr3d.actr.declarative.chunk_query import search_for
from actr3d.clock import seconds
from actr3d.trace import TraceEvent

Touches = frozenset[tuple[str, str, str]]
"""Which touch: body, part, and with what."""


@dataclass
class Watch:
    """What ends the present stretch of a run, beside the user."""

    goal: int | None = None
    """A time [us]."""
    goal_reason: str = ""
    cycles: int = 0
    """The how manieth production that fires from now on ends it; 0 for none."""
    system: str | None = None
    """Of which system these are to be; None for any."""
    production: str | None = None
    buffer: str | None = None
    called: str = ""
    """How the user calls the buffer."""
    pattern: str = ""
    contact: str | None = None
    """The body whose touch ends it; an empty text for any body."""
    breakpoints: frozenset[str] = frozenset()
    touching: Touches = field(default_factory=frozenset[tuple[str, str, str]])
    """What touched already when this began, or does still."""

    def begin(self, **wanted: object) -> None:
        """Forgets all but the breakpoints, and watches for what is given."""
        fresh = Watch(breakpoints=self.breakpoints)
        self.__dict__.update({**fresh.__dict__, **wanted})

    @property
    def of_events(self) -> bool:
        """Whether events have to be looked at."""
        return self.cycles > 0 or bool(self.breakpoints) or self.production is not None or self.buffer is not None

    @property
    def fine(self) -> bool:
        """Whether each single tick has to be looked at."""
        return self.of_events or self.contact is not None

    @property
    def pending(self) -> str:
        """What the run goes on for, where a user has said so."""
        parts = [] if self.goal is None else [f"{seconds(self.goal):g} s"]
        if self.production is not None:
            parts.append(f"{self.production} fires")
        if self.buffer is not None:
            parts.append(f"{self.called} matches '{self.pattern}'" if self.pattern.strip() else f"{self.called} changes")
        if self.contact is not None:
            parts.append(f"{self.contact or 'a body'} touches something")
        return f"until {' or '.join(parts)}"

    @property
    def missed(self) -> str:
        """What has not come of what is watched for, for a run that is over; an empty text where there is nothing to say."""
        missed = [f"{self.production} did not fire"] if self.production is not None else []
        if self.buffer is not None:
            came = f"come to match '{self.pattern}'" if self.pattern.strip() else "change"
            missed.append(f"{self.called} did not {came}")
        if self.contact is not None:
            missed.append(f"{self.contact or 'no body'} touched {'nothing' if self.contact else 'anything'} more")
        return "; ".join(missed)

    def found(self, events: Iterable[TraceEvent]) -> str | None:
        """Returns why the run is to stop because of events; None where it is not."""
        for event in events:
            if event.kind == "fire":
                name = event.data["production"]
                if name in self.breakpoints:
                    return f"breakpoint: {name} fired"
                cycle = self.cycles > 0 and self.system in (None, event.source)
                self.cycles -= cycle
                if name == self.production or (cycle and self.cycles == 0):
                    return f"{name} fired"
            elif event.kind == "buffer" and event.source == self.buffer and self._matches(event):
                return f"{self.called} matches '{self.pattern}'" if self.pattern.strip() else f"{self.called} has changed"
        return None

    def touched(self, touches: Touches) -> str | None:
        """Returns why the run is to stop because of touches; None where there is no new one."""
        new, self.touching = touches - self.touching, touches
        found = sorted(touch for touch in new if self.contact in ("", touch[0]))
        return f"{found[0][1]} of {found[0][0]} touches {found[0][2]}" if found else None

    def _matches(self, event: TraceEvent) -> bool:
        slots = event.data["chunk"]
        if not slots:
            return not self.pattern.strip()
        chunk = Chunk({int(key) if key.isdecimal() else key: value for key, value in slots.items()})
        return bool(search_for(self.pattern, {}, None).among(ChunkStore([chunk])))
