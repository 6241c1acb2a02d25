"""Answers questions about a run: explanations, contents of memories, past events. Asking changes nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from actr3d.actr.declarative.memory import Memory
from actr3d.actr.explain.memory_table import memory_rows
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import children_of, path_of
from actr3d.actr.modules.answers import plain_answer
from actr3d.actr.procedural.production_system import ProductionSystem
from actr3d.errors import Actr3dError, did_you_mean
from actr3d.trace import Trace
from workbench import protocol as say
from workbench.worker.tops import Top


def answer(question: Any, trace: Trace | None, tops: Sequence[Top]) -> Any:
    """Returns the answer to a question as plain values.

    Args:
        question: One of `protocol.Question`.
        trace: The trace so far.
        tops: The top models, or the agents of a simulation.

    Raises:
        Actr3dError: If there is nothing of that name, or the question cannot be answered.
    """
    match question:
        case say.Explain():
            return _explain(question, tops)
        case say.Rows():
            return _rows(question, tops)
        case say.Look() | say.Body():
            raise Actr3dError("the run has no body")
        case say.Events():
            return _events(question, trace)
        case _:
            raise Actr3dError(f"'{question.type}' is no question")


def _explain(question: say.Explain, tops: Sequence[Top]) -> list[dict[str, Any]]:
    agents = {top.name(path_of(agent)): (top, agent) for top in tops for agent in _agents(top.model)}
    if question.agent is not None and question.agent not in agents:
        raise _unknown("agent", question.agent, agents)
    asked = list(agents.values()) if question.agent is None else [agents[question.agent]]
    explained: list[dict[str, Any]] = []
    for top, agent in asked:
        explanation = agent.explain(question.at)
        reasons = [reason for reason in explanation.productions if question.production in (None, reason.name)]
        plain = plain_answer(explanation)
        plain["productions"] = [{**plain_answer(reason), "seen": reason.seen, "text": str(reason)} for reason in reasons]
        plain["retrievals"] = [{**plain_answer(reason), "text": str(reason)} for reason in explanation.retrievals]
        explained.append(top.named(plain))
    if question.production is not None and not any(one["productions"] for one in explained):
        known = [production.name for _, agent in asked for production in agent._productions]
        raise _unknown("production", question.production, known)
    return explained


def _agents(model: Model) -> Iterator[ProductionSystem]:
    """Yields the production systems that are not part of another production system."""
    if isinstance(model, ProductionSystem):
        yield model
    else:
        for child in children_of(model):
            yield from _agents(child)


def _rows(question: say.Rows, tops: Sequence[Top]) -> dict[str, Any]:
    memories = {name: part for top in tops for name, part in top.parts() if isinstance(part, Memory)}
    if question.memory not in memories:
        raise _unknown("memory", question.memory, memories)
    memory = memories[question.memory]
    rows = memory_rows(memory, question.words, question.most)
    return {"memory": question.memory, "size": len(memory.dm), "threshold": memory.threshold, "rows": [plain_answer(row) for row in rows]}


def _events(question: say.Events, trace: Trace | None) -> dict[str, Any]:
    events = [] if trace is None else trace.since(question.first)[: question.most]
    wanted = [
        (number, event) for number, event in enumerate(events, question.first) if question.kinds is None or event.kind in question.kinds
    ]
    return {
        "first": question.first,
        "next": question.first + len(events),
        "total": 0 if trace is None else len(trace),
        "numbers": [number for number, _ in wanted],
        "events": [[event.time_us, event.source, event.kind, event.data] for _, event in wanted],
    }


def _unknown(what: str, name: str, known: Any) -> Actr3dError:
    return Actr3dError(f"no {what} '{name}'{did_you_mean(name, known)}; there are: {', '.join(known) or 'none'}")
