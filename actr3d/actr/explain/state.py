"""What can be told of a state of an agent, present or past: each fact, and how it is known."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from actr3d.actr.chunks.chunk import Slot
from actr3d.actr.chunks.pattern import Bindings, Missing
from actr3d.actr.kernel.model import Model
from actr3d.actr.procedural.conflict_set import ConflictSet
from actr3d.actr.procedural.production import Production
from actr3d.actr.procedural.production_system import ProductionSystem
from actr3d.actr.procedural.safe_reading import UNKNOWN
from actr3d.actr.reasons import RetrievalReason, SearchReason


class Fact(NamedTuple):
    """A slot's value, or whether there is nothing in an object."""

    value: Any
    """Text, MISSING for no such slot, True or False for emptiness; UNKNOWN where it cannot be told."""
    seen: str | None = None
    """How it is known, such as «as seen since 0.050 s», or why it is not; None where it is certain at that time."""


class Answer(NamedTuple):
    """What a modeller's function among the patterns said."""

    given: Bindings
    """The variables as it got them."""
    agrees: bool
    bound: Bindings
    """The variables after it."""
    seen: str


NOT_KNOWN = Fact(UNKNOWN, "no production has looked at it")
OPAQUE = Fact(UNKNOWN, "an object whose text only its own code can tell")


class State(Protocol):
    """What is asked of the present, or of a past, to tell why."""

    time: float

    def path(self, part: Model) -> str:
        """Returns a part's place in the tree."""
        ...

    def exists(self, part: Model) -> bool:
        """Returns whether a part had come into the tree."""
        ...

    def learned(self, system: ProductionSystem, production: Production) -> bool:
        """Returns whether a compiled production had been learned."""
        ...

    def slot(self, system: ProductionSystem, name: str, key: Slot) -> Fact:
        """Returns a slot's value as text."""
        ...

    def empty(self, system: ProductionSystem, name: str) -> Fact:
        """Returns whether a buffer or object holds nothing."""
        ...

    def slots(self, system: ProductionSystem, name: str) -> list[str]:
        """Returns the slots there are, for the sake of a better message."""
        ...

    def answer(self, system: ProductionSystem, production: Production, number: int) -> Answer | None:
        """Returns what the function in a condition said when it was last asked; it is not asked again."""
        ...

    def matched(self, system: ProductionSystem, production: Production) -> bool:
        """Returns whether a production was among those that matched when they were last tried."""
        ...

    def parts(self, system: ProductionSystem, production: Production) -> dict[str, float | None]:
        """Returns the parts of a production's utility."""
        ...

    def choice(self, system: ProductionSystem) -> ConflictSet | None:
        """Returns the latest choice, as long as it stands: until the production fires, or another choice is made."""
        ...

    def retrieval(self, memory: Any) -> RetrievalReason | None:
        """Returns the reason of a memory's latest request."""
        ...

    def searches(self, module: Any) -> list[SearchReason]:
        """Returns the reasons of the latest searches of a module that sees."""
        ...


def is_unknown(value: object) -> bool:
    """Returns whether a fact's value cannot be told."""
    return isinstance(value, Missing) and value is UNKNOWN
