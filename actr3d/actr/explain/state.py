"""The interface through which explanations read the state of an agent, current or past: facts, and how they are known.

The tests of conditions are the same for both (`condition_tests`). The facts have two sources. The present is read from the model and
from the objects that it sees, because a run need not be traced to be explained. The past is read from the trace.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from actr3d.actr.chunks.chunk import Slot
from actr3d.actr.chunks.pattern import Bindings, Missing
from actr3d.actr.kernel.buffer import UNKNOWN
from actr3d.actr.kernel.model import Model
from actr3d.actr.procedural.conflict_set import ConflictSet
from actr3d.actr.procedural.production import Production
from actr3d.actr.reasons import RetrievalReason, SearchReason


class Fact(NamedTuple):
    """A slot's value, or whether an object is empty."""

    value: Any
    """Text, MISSING for no such slot, True or False for emptiness; UNKNOWN if it is not known."""
    source: str | None = None
    """How it is known, such as «as seen since 0.050 s», or why it is not; None if it is certain at that time."""


class FunctionResult(NamedTuple):
    """The result of a modeller's function among the patterns."""

    given: Bindings
    """The variables before the call."""
    agrees: bool
    bound: Bindings
    """The variables after the call."""
    source: str


NOT_KNOWN = Fact(UNKNOWN, "no production has read it")
OPAQUE = Fact(UNKNOWN, "an object that only its own code can convert to text")


class AgentState(Protocol):
    """A current or past state."""

    time: float

    def path(self, part: Model) -> str:
        """Returns a part's place in the tree."""
        ...

    def exists(self, part: Model) -> bool:
        """Returns whether a part was in the tree."""
        ...

    def learned(self, production: Production) -> bool:
        """Returns whether a production existed; a compiled one does from when it is learned."""
        ...

    def slot(self, production: Production, name: str, key: Slot) -> Fact:
        """Returns the value of a slot, as text, in what a production sees under a name."""
        ...

    def empty(self, production: Production, name: str) -> Fact:
        """Returns whether what a production sees under a name is empty."""
        ...

    def slots(self, production: Production, name: str) -> list[str]:
        """Returns the slots of what a production sees under a name, for messages."""
        ...

    def function_result(self, production: Production, number: int) -> FunctionResult | None:
        """Returns the last result of the function in a condition; it is not called again."""
        ...

    def matched(self, production: Production) -> bool:
        """Returns whether a production was among those that matched at the latest match."""
        ...

    def parts(self, production: Production) -> dict[str, float | None]:
        """Returns the parts of a production's utility."""
        ...

    def choice(self, production: Production) -> ConflictSet | None:
        """Returns the latest conflict set of its system, until the chosen production fires or another choice is made."""
        ...

    def retrieval(self, memory: Any) -> RetrievalReason | None:
        """Returns the reason of a memory's latest request."""
        ...

    def searches(self, module: Any) -> list[SearchReason]:
        """Returns the reasons of the latest searches of a vision module."""
        ...


def is_unknown(value: object) -> bool:
    """Returns whether a fact's value is not known."""
    return isinstance(value, Missing) and value is UNKNOWN
