"""The current state of the model. Reading it runs none of the modeller's code, and draws no random number."""

from __future__ import annotations

from typing import Any

from actr3d.actr.chunks.chunk import Slot, plain_text
from actr3d.actr.chunks.pattern import MISSING
from actr3d.actr.explain.module_reasons import live_retrieval, live_searches
from actr3d.actr.explain.state import NOT_KNOWN, OPAQUE, Fact, FunctionResult, is_unknown
from actr3d.actr.kernel.buffer import UNKNOWN, Buffer, plain_empty, plain_value, reads_chunk
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import path_of
from actr3d.actr.modules.port import Searching
from actr3d.actr.procedural.conflict_set import ConflictSet
from actr3d.actr.procedural.matcher import Observed
from actr3d.actr.procedural.production import Production
from actr3d.actr.procedural.production_system import ProductionSystem, current_choice, procedural_state_of, system_of, utility_parts
from actr3d.actr.reasons import RetrievalReason, SearchReason
from actr3d.clock import seconds

LAST_SEEN = "as last seen"


class Present:
    """The current state; see `AgentState` for the methods.

    Args:
        agent: The agent to explain.
    """

    def __init__(self, agent: ProductionSystem) -> None:
        self.time = agent.now()

    def path(self, part: Model) -> str:
        return path_of(part)

    def exists(self, part: Model) -> bool:
        return True

    def learned(self, production: Production) -> bool:
        return True

    def slot(self, production: Production, name: str, key: Slot) -> Fact:
        target = production.context[name]
        value = plain_value(target, key)
        if value is MISSING:
            return Fact(MISSING)
        text = None if value is UNKNOWN else plain_text(value)
        if text is not None:
            return Fact(text)
        looked = _observed(production).looked
        label = f"{name}.{key}"
        if label not in looked:
            return OPAQUE if reads_chunk(target, key) else NOT_KNOWN
        return Fact(MISSING if looked[label] is None else looked[label], LAST_SEEN)

    def empty(self, production: Production, name: str) -> Fact:
        empty = plain_empty(production.context[name])
        return NOT_KNOWN if is_unknown(empty) else Fact(empty)

    def slots(self, production: Production, name: str) -> list[str]:
        target = production.context[name]
        if isinstance(target, Buffer):
            return [str(key) for key in target.chunk or ()]
        return [key for key in getattr(target, "__dict__", ()) if key[0] != "_"]

    def function_result(self, production: Production, number: int) -> FunctionResult | None:
        asked = _observed(production).asked.get((production.name, number))
        if asked is None:
            return None
        given, agrees, bound = asked.plain()
        return FunctionResult(given, agrees, bound, f"as asked at {seconds(asked.time):.3f} s")

    def matched(self, production: Production) -> bool:
        matcher = procedural_state_of(system_of(production)).matcher
        return matcher is not None and production in matcher.last

    def parts(self, production: Production) -> dict[str, float | None]:
        return utility_parts(system_of(production), production)

    def choice(self, production: Production) -> ConflictSet | None:
        return current_choice(system_of(production))

    def retrieval(self, memory: Any) -> RetrievalReason | None:
        return live_retrieval(memory)

    def searches(self, module: Searching) -> list[SearchReason]:
        return live_searches(module)


def _observed(production: Production) -> Observed:
    matcher = procedural_state_of(system_of(production)).matcher
    return matcher.observed if matcher is not None else Observed()
