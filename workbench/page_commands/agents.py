"""Questions about the agents of a run: explanations, contents of memories, past events."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from actr3d.clock import MICROSECONDS, seconds
from actr3d.errors import ParameterError
from workbench.page_commands.command import Name, Question, Seconds, page_command, unknown
from workbench.time_text import time_text

if TYPE_CHECKING:
    from actr3d.actr.kernel.model import Model
    from actr3d.actr.procedural.production_system import ProductionSystem
    from actr3d.actr.reasons import Explanation
    from workbench.worker.controlled_run import ControlledRun


@page_command
class Explain(Question):
    """Explains productions and retrievals of all agents or of one, now or at a past time; all times are those of the run."""

    type: Literal["explain"] = "explain"
    at: Seconds | None = None
    agent: Name | None = None
    production: Name | None = None

    def answer(self, run: ControlledRun) -> list[dict[str, Any]]:
        from actr3d.actr.kernel.tree import path_of
        from actr3d.actr.modules.answers import plain_answer

        agents = {top.name(path_of(agent)): (top, agent) for top in run.tops() for agent in _agents(top.model)}
        if self.agent is not None and self.agent not in agents:
            raise unknown("agent", self.agent, agents)
        asked = list(agents.values()) if self.agent is None else [agents[self.agent]]
        explained: list[dict[str, Any]] = []
        names: list[str] = []
        for top, agent in asked:
            explanation = self._explanation(run, top.name(path_of(agent)), agent)
            if explanation is None:
                continue
            reasons = [reason for reason in explanation.productions if self.production in (None, reason.name)]
            plain = plain_answer(explanation)
            plain["productions"] = [{**plain_answer(reason), "source": reason.source, "text": str(reason)} for reason in reasons]
            plain["retrievals"] = [{**plain_answer(reason), "text": str(reason)} for reason in explanation.retrievals]
            explained.append(top.named(plain))
            names += [reason.name for reason in explanation.productions]
        if self.production is not None and not any(one["productions"] for one in explained):
            raise unknown("production", self.production, names)
        return explained

    def _explanation(self, run: ControlledRun, name: str, agent: ProductionSystem) -> Explanation | None:
        """Returns the explanation of an agent; None if it did not exist at that time, and all agents are asked for.

        Raises:
            ParameterError: If the time lies ahead, or the agent did not exist then.
        """
        time = run.clock if self.at is None else round(self.at * MICROSECONDS)
        if time > run.clock:
            raise ParameterError(f"explain(at): {time_text(self.at or 0)} lies ahead; it is {time_text(seconds(run.clock))} now")
        own = run.own_time(name, time)
        if own is None:
            if self.agent is None:
                return None
            raise ParameterError(f"explain(at): '{name}' did not exist at {time_text(seconds(time))}")
        found = agent.explain(None if self.at is None else seconds(own))

        def of_run(own: float) -> float:
            return seconds(run.whole_time(name, round(own * MICROSECONDS)))

        retrievals = tuple(replace(reason, time=of_run(reason.time)) for reason in found.retrievals)
        searches = tuple(replace(reason, time=of_run(reason.time)) for reason in found.searches)
        return replace(found, time=seconds(time), retrievals=retrievals, searches=searches)


def _agents(model: Model) -> Iterator[ProductionSystem]:
    """Yields the production systems that are not part of another production system."""
    from actr3d.actr.kernel.tree import children_of
    from actr3d.actr.procedural.production_system import ProductionSystem

    if isinstance(model, ProductionSystem):
        yield model
    else:
        for child in children_of(model):
            yield from _agents(child)


@page_command
class MemoryRows(Question):
    """Returns the chunks of a memory with their current activations, and which curves over time each of them has."""

    type: Literal["memory"] = "memory"
    memory: Name
    words: Annotated[str, Field(max_length=200)] = ""
    most: int = Field(default=200, ge=1, le=5000)

    def answer(self, run: ControlledRun) -> dict[str, Any]:
        from actr3d.actr.declarative.memory import Memory
        from actr3d.actr.explain.memory_table import memory_rows
        from actr3d.actr.modules.answers import plain_answer
        from workbench.chunk_curves import offered

        memories = {name: part for top in run.tops() for name, part in top.parts() if isinstance(part, Memory)}
        if self.memory not in memories:
            raise unknown("memory", self.memory, memories)
        memory = memories[self.memory]
        rows = [plain_answer(row) for row in memory_rows(memory, self.words, self.most)]
        return {"memory": self.memory, "size": len(memory.dm), "threshold": memory.threshold, "rows": rows, "plots": offered(memory)}


@page_command
class Events(Question):
    """Returns events of the run from a number on."""

    type: Literal["events"] = "events"
    first: int = Field(default=0, ge=0)
    most: int = Field(default=5000, ge=1, le=20_000)
    kinds: tuple[Name, ...] | None = Field(default=None, max_length=50)
    ahead: bool = False
    """Whether also events that the run has not reached yet, but that the opened recording has, are returned."""

    def answer(self, run: ControlledRun) -> dict[str, Any]:
        end = self.first + self.most
        events = [(event.time_us, event.source, event.kind, event.data) for event in run.events(self.first, end)]
        if self.ahead and len(events) < self.most:
            events += run.events_ahead(self.first + len(events), end)
        wanted = [(number, event) for number, event in enumerate(events, self.first) if self.kinds is None or event[2] in self.kinds]
        return {
            "first": self.first,
            "next": self.first + len(events),
            "total": len(run.trace),
            "numbers": [number for number, _ in wanted],
            "events": [event for _, event in wanted],
        }
