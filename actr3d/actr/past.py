"""A past state of an agent, put together from the trace."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from actr3d.actr.buffer import Buffer
from actr3d.actr.chunk import Slot, as_text
from actr3d.actr.model import Model
from actr3d.actr.pattern import MISSING, Bindings, Condition, Missing
from actr3d.actr.plain import UNKNOWN
from actr3d.clock import seconds
from actr3d.trace import TraceEvent
from actr3d.values import Opaque

if TYPE_CHECKING:
    from actr3d.actr.procedural import ProductionSystem
    from actr3d.actr.production import Production


class Past:
    """What everything was at a time, after all that happened at that time.

    Args:
        events: Its run's trace.
        time: The time [us].
    """

    def __init__(self, events: Sequence[TraceEvent], time: int) -> None:
        self.time = seconds(time)
        self._attributes: dict[str, dict[str, Any]] = {}
        self._seen: dict[str, dict[str, Any]] = {}
        self._matched: dict[str, dict[str, Any]] = {}
        self._parts: dict[tuple[str, str], dict[str, float | None]] = {}
        self._chosen: dict[str, str | None] = {}
        self._drawn: dict[str, list[str]] = {}
        self._unborn: set[tuple[str, str]] = set()
        for event in events:
            if event.time_us <= time:
                self._take(event)
            elif event.kind == "compile":
                self._unborn.add((event.source, event.data["production"]))

    def _take(self, event: TraceEvent) -> None:
        source, data = event.source, event.data
        if event.kind in ("state", "buffer"):
            self._attributes.setdefault(source, {}).update(data)
        elif event.kind == "productions":
            self._matched[source] = dict.fromkeys(data["matched"])
            self._drawn[source] = data["drawn"]
            self._chosen[source] = data["chosen"]
        elif event.kind == "observe":
            self._seen.setdefault(source, {}).update(data)
        elif event.kind == "conflict":
            self._matched[source] = data["utilities"]
            self._drawn[source] = data.get("drawn", [])
            for name, parts in data.get("parts", {}).items():
                self._parts.setdefault((source, name), {}).update(parts)
        elif event.kind == "utility":
            self._parts.setdefault((source, data["production"]), {})[data["part"]] = data["value"]
        elif event.kind == "select":
            self._chosen[source] = data["production"]
        elif event.kind in ("fire", "changed"):
            self._chosen[source] = None
            # Noise was drawn for one choice, and is not that of the next.
            for (system, _), parts in self._parts.items():
                if system == source:
                    parts.update(dict.fromkeys(self._drawn.get(source, ()), None))

    def slot(self, system: ProductionSystem, name: str, key: Slot) -> str | Missing:
        target = system._context[name]
        seen = self._seen.get(system._path, {})
        if f"{name}.{key}" in seen:
            return MISSING if seen[f"{name}.{key}"] is None else seen[f"{name}.{key}"]
        values = self._values(target)
        value = values.get(str(key), MISSING)
        if value is not MISSING:
            return UNKNOWN if isinstance(value, Opaque) else as_text(value)
        return MISSING

    def _values(self, target: Any) -> Mapping[str, Any]:
        """Returns the slots of a buffer's chunk, or the attributes of another model, as they were."""
        if not isinstance(target, Model):
            return {}
        attributes = self._attributes.get(target._path, {})
        if isinstance(target, Buffer):
            return attributes.get("chunk") or {}
        return attributes

    def empty(self, system: ProductionSystem, name: str) -> bool:
        return not self._values(system._context[name])

    def slots(self, system: ProductionSystem, name: str) -> list[str]:
        target = system._context[name]
        if isinstance(target, Model):
            return list(self._values(target))
        return [key for key in getattr(target, "__dict__", ()) if key[0] != "_"]

    def call(self, production: Production, condition: Condition, bindings: Bindings) -> bool:
        # The function is not asked again: things have changed. Where all else holds, it decided whether the production
        # was among those that matched.
        return production.name in self._matched.get(production.system._path, {})

    def parts(self, production: Production) -> dict[str, float | None]:
        known = self._parts.get((production.system._path, production.name), {})
        return {name: known.get(name) for name in production.system._adaptor_names()}

    def selected(self, system: ProductionSystem) -> str | None:
        return self._chosen.get(system._path)

    def exists(self, production: Production) -> bool:
        return (production.system._path, production.name) not in self._unborn
