"""The model as it is now. Asking changes nothing: no code of the modeller's is run, and no random number is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from actr3d.actr.attempts import has_slots
from actr3d.actr.buffer import Buffer
from actr3d.actr.chunk import Slot
from actr3d.actr.known import NOT_KNOWN, OPAQUE, Answer, Fact, is_unknown
from actr3d.actr.observed import Observed
from actr3d.actr.pattern import MISSING
from actr3d.actr.plain import UNKNOWN, plain_empty, plain_value
from actr3d.actr.retrievals import RetrievalReason, live_retrieval
from actr3d.actr.searches import Searching, SearchReason, live_searches
from actr3d.actr.texts import plain_text
from actr3d.clock import seconds

if TYPE_CHECKING:
    from actr3d.actr.choice import Choice
    from actr3d.actr.model import Model
    from actr3d.actr.procedural import ProductionSystem
    from actr3d.actr.production import Production

LAST_SEEN = "as last seen"


class Present:
    """See `State` for what each method tells.

    Args:
        agent: The agent that is asked about.
    """

    def __init__(self, agent: ProductionSystem) -> None:
        self.time = agent.now()

    def path(self, part: Model) -> str:
        return part._path

    def exists(self, part: Model) -> bool:
        return True

    def learned(self, production: Production) -> bool:
        return True

    def slot(self, system: ProductionSystem, name: str, key: Slot) -> Fact:
        target = system._context[name]
        value = plain_value(target, key)
        if value is MISSING:
            return Fact(MISSING)
        text = None if value is UNKNOWN else plain_text(value)
        if text is not None:
            return Fact(text)
        looked = _observed(system).looked
        label = f"{name}.{key}"
        if label not in looked:
            return OPAQUE if has_slots(target, key) else NOT_KNOWN
        return Fact(MISSING if looked[label] is None else looked[label], LAST_SEEN)

    def empty(self, system: ProductionSystem, name: str) -> Fact:
        empty = plain_empty(system._context[name])
        return NOT_KNOWN if is_unknown(empty) else Fact(empty)

    def slots(self, system: ProductionSystem, name: str) -> list[str]:
        target = system._context[name]
        if isinstance(target, Buffer):
            return [str(key) for key in target.chunk or ()]
        return [key for key in getattr(target, "__dict__", ()) if key[0] != "_"]

    def answer(self, production: Production, number: int) -> Answer | None:
        asked = _observed(production.system).asked.get((production.name, number))
        if asked is None:
            return None
        given, agrees, bound = asked.plain()
        return Answer(given, agrees, bound, f"as asked at {seconds(asked.time):.3f} s")

    def matched(self, production: Production) -> bool:
        matcher = production.system._matcher
        return matcher is not None and production in matcher.last

    def parts(self, production: Production) -> dict[str, float | None]:
        return production.system._utility_parts(production)

    def choice(self, system: ProductionSystem) -> Choice | None:
        return system._standing_choice()

    def retrieval(self, memory: Any) -> RetrievalReason | None:
        return live_retrieval(memory)

    def searches(self, module: Searching) -> list[SearchReason]:
        return live_searches(module)


def _observed(system: ProductionSystem) -> Observed:
    return system._matcher.observed if system._matcher is not None else Observed()
