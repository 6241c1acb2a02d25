"""A past state of an agent, reconstructed from the trace."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, NamedTuple, cast

from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES, Slot, as_text
from actr3d.actr.chunks.pattern import MISSING
from actr3d.actr.explain.module_reasons import outcome_of, past_retrieval, past_search
from actr3d.actr.explain.state import NOT_KNOWN, OPAQUE, Fact, FunctionResult, is_unknown
from actr3d.actr.kernel.buffer import Buffer, plain_empty, reads_chunk
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import path_of, places_in
from actr3d.actr.procedural.conflict_set import ConflictSet
from actr3d.actr.procedural.matcher import records_changes, result_label
from actr3d.actr.procedural.production import Production, ProductionOwner
from actr3d.actr.procedural.production_system import ProductionSystem, procedural_state_of, system_of, utility_parts
from actr3d.actr.reasons import RetrievalReason, SearchReason
from actr3d.clock import seconds
from actr3d.trace import Trace, TraceEvent, renumbered


class RecordedValue(NamedTuple):
    """A value recorded by an event."""

    value: Any
    event: int
    """The number of the event in the trace."""
    time: int
    """The time of the event [us]."""


class _Part:
    """What a trace contains about one part of the tree up to a time."""

    def __init__(self) -> None:
        self.attributes: dict[str, RecordedValue] = {}
        self.observations: dict[str, RecordedValue] = {}
        self.parts: dict[str, dict[str, float | None]] = {}
        self.conflict: dict[str, Any] | None = None
        self.chosen: str | None = None
        self.matched: Collection[str] = ()
        self.latest_match = -1
        """The number of the event of the latest match; changes of observed values are recorded before it."""
        self.unborn: set[str] = set()
        self.request: TraceEvent | None = None
        self.outcome = "pending"
        self.searches: dict[bool, tuple[TraceEvent, str]] = {}
        """The latest search and its outcome, by whether it was bottom-up."""

    def take(self, number: int, event: TraceEvent) -> None:
        """Processes an event of this part."""
        kind, data = event.kind, event.data
        if kind in ("state", "buffer"):
            self._note(self.attributes, number, event)
        elif kind == "observe":
            self._note(self.observations, number, event)
        elif kind == "conflict":
            self.conflict, self.chosen = data, None
            self.matched, self.latest_match = data["utilities"], number
        elif kind == "productions":
            self.matched, self.chosen = data["matched"], data["chosen"]
            self.conflict = data if "utilities" in data else None
        elif kind == "utility":
            self.parts.setdefault(data["production"], {})[data["part"]] = data["value"]
        elif kind == "select":
            self.chosen = data["production"]
        elif kind in ("fire", "changed", "withdrawn"):
            self.conflict = self.chosen = None
        elif kind == "request" and "candidates" in data:
            self.request, self.outcome = event, data.get("outcome", "pending")
        elif kind == "retrieval":
            self.outcome = "failed" if data["failed"] else "retrieved"
        elif kind == "search":
            self.searches[data["bottom_up"]] = (event, "pending")
        elif kind == "sight":
            event, _ = self.searches[data["bottom_up"]]
            self.searches[data["bottom_up"]] = (event, outcome_of(data))

    def _note(self, records: dict[str, RecordedValue], number: int, event: TraceEvent) -> None:
        records.update({key: RecordedValue(value, number, event.time_us) for key, value in event.data.items()})


class Past:
    """The state of everything at a time, after all events of that time; see `AgentState` for the methods.

    Args:
        trace: A trace of the run.
        number: The number of the run in this trace, if the paths of the parts come from another trace; None if they come from this one.
        time: The time [us].
        parts: The parts to reconstruct.
    """

    def __init__(self, trace: Trace, number: int | None, time: int, parts: Collection[Model]) -> None:
        self.time = seconds(time)
        self._parts: dict[int, _Part] = {}
        self._paths: dict[int, str | None] = {}
        self._named: dict[int, list[tuple[Model, str]]] = {}
        places: dict[str, list[tuple[int, int, _Part]]] = {}
        for part in parts:
            known = self._parts[id(part)] = _Part()
            for place in places_in(part, trace):
                if place.time <= time:
                    self._paths[id(part)] = place.path
                if place.path is not None:
                    source = place.path if number is None else renumbered(place.path, number)
                    places.setdefault(source, []).append((place.begin, place.end, known))
        for part in parts:
            for name, target in (procedural_state_of(part).context if isinstance(part, ProductionSystem) else {}).items():
                self._named.setdefault(id(target), []).append((part, name))
        for number, event in enumerate(trace):
            for begin, end, known in places.get(event.source, ()):
                if not begin <= number < end:
                    continue
                if event.time_us <= time:
                    known.take(number, event)
                elif event.kind == "compile":
                    known.unborn.add(event.data["production"])

    def path(self, part: Model) -> str:
        return self._paths.get(id(part)) or path_of(part)

    def exists(self, part: Model) -> bool:
        return self._paths.get(id(part)) is not None

    def learned(self, production: Production) -> bool:
        return production.name not in self._of(production.system).unborn

    def _of(self, part: Model | ProductionOwner) -> _Part:
        return self._parts[id(part)]

    def slot(self, production: Production, name: str, key: Slot) -> Fact:
        target = production.context[name]
        if reads_chunk(target, key):
            return self._slot_of_chunk(target, key)
        found = self._observations(target, key)
        recorded = self._of(target).attributes.get(str(key)) if isinstance(target, Model) and records_changes(target, key) else None
        certain = recorded is not None and type(recorded.value) in IMMUTABLE_TYPES
        latest = max((record.event if certain else held for record, held in found), default=-1)
        if found and (recorded is None or recorded.event < latest):
            record, _ = max(found, key=lambda pair: pair[0].event)
            return Fact(MISSING if record.value is None else record.value, _since(record))
        return Fact(as_text(recorded.value)) if recorded is not None and certain else NOT_KNOWN

    def _observations(self, target: Any, key: Slot | None) -> list[tuple[RecordedValue, int]]:
        """Returns what production systems read of an object, under any name, and the event until which it was valid for each."""
        found: list[tuple[RecordedValue, int]] = []
        for system, name in self._named.get(id(target), ()):
            known = self._of(system)
            record = known.observations.get(f"{name}.{key}")
            if record is not None:
                found.append((record, max(record.event, known.latest_match)))
        return found

    def _slot_of_chunk(self, buffer: Buffer, key: Slot) -> Fact:
        recorded = self._of(buffer).attributes.get("chunk")
        if recorded is None:
            return NOT_KNOWN
        chunk: dict[str, Any] = recorded.value or {}
        value = chunk.get(str(key), MISSING)
        if value is MISSING or type(value) in IMMUTABLE_TYPES:
            return Fact(value if value is MISSING else as_text(value))
        texts = self._of(buffer).attributes.get("texts")
        if texts is None or texts.event != recorded.event or str(key) not in texts.value:
            return OPAQUE
        return Fact(texts.value[str(key)], _since(recorded))

    def empty(self, production: Production, name: str) -> Fact:
        target = production.context[name]
        if isinstance(target, Buffer):
            recorded = self._of(target).attributes.get("chunk")
            return NOT_KNOWN if recorded is None else Fact(not recorded.value)
        found = self._observations(target, None)
        if found:
            record, _ = max(found, key=lambda pair: pair[0].event)
            return Fact(record.value, _since(record))
        empty = plain_empty(target)
        return NOT_KNOWN if is_unknown(empty) or hasattr(cast("Any", type(target)), "__len__") else Fact(empty)

    def slots(self, production: Production, name: str) -> list[str]:
        target = production.context[name]
        if isinstance(target, Buffer):
            recorded = self._of(target).attributes.get("chunk")
            return list(recorded.value or ()) if recorded is not None else []
        return [key for key in getattr(target, "__dict__", ()) if key[0] != "_"]

    def function_result(self, production: Production, number: int) -> FunctionResult | None:
        observation = self._of(production.system).observations.get(result_label(production.name, number))
        if observation is None:
            return None
        given, agrees, bound = observation.value
        return FunctionResult(given, agrees, bound, _since(observation))

    def matched(self, production: Production) -> bool:
        return production.name in self._of(production.system).matched

    def parts(self, production: Production) -> dict[str, float | None]:
        known = self._of(production.system).parts.get(production.name, {})
        return {name: known.get(name) for name in utility_parts(system_of(production), production)}

    def choice(self, production: Production) -> ConflictSet | None:
        known = self._of(production.system)
        data = known.conflict or {}
        choice = ConflictSet(
            utilities=data.get("utilities", {}),
            parts=data.get("parts", {}),
            threshold=data.get("threshold"),
            weighed=procedural_state_of(system_of(production)).by_utility,
            chosen=known.chosen,
            forbidden=data.get("forbidden", ()),
            wanted=data.get("wanted"),
        )
        return choice if choice.is_current else None

    def retrieval(self, memory: Model) -> RetrievalReason | None:
        known = self._of(memory)
        return None if known.request is None else past_retrieval(self.path(memory), known.request, known.outcome)

    def searches(self, module: Model) -> list[SearchReason]:
        known = sorted(self._of(module).searches.items())
        return [past_search(self.path(module), event, outcome) for _, (event, outcome) in known]


def _since(record: RecordedValue) -> str:
    return f"as seen since {seconds(record.time):.3f} s"
