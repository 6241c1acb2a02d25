"""What a run is asked: why, what a memory holds, what an eye sees, how a body stands. Nothing changes by asking."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from actr3d.actr.answers import plain_answer
from actr3d.actr.memory import Memory
from actr3d.actr.memory_table import memory_rows
from actr3d.actr.model import Model
from actr3d.actr.production_system import ProductionSystem
from actr3d.errors import Actr3dError, did_you_mean
from actr3d.trace import Trace
from workbench import protocol as say

if TYPE_CHECKING:
    from actr3d.world import World


def answer(question: Any, trace: Trace | None, models: Sequence[Model], world: World | None) -> Any:
    """Returns what is asked, as plain values.

    Args:
        question: One of `protocol.Question`.
        trace: The trace up to now.
        models: The top models, or the minds.
        world: The world, if there is one.

    Raises:
        Actr3dError: If there is nothing of that name, or it cannot be told.
    """
    match question:
        case say.Explain():
            return _explain(question, models)
        case say.Rows():
            return _rows(question, models)
        case say.Look():
            return _look(_body(question.body, world))
        case say.Body():
            return _stand(_body(question.body, world))
        case say.Events():
            return _events(question, trace)
        case _:
            raise Actr3dError(f"'{question.type}' is no question")


def _explain(question: say.Explain, models: Sequence[Model]) -> list[dict[str, Any]]:
    agents = {agent._path: agent for model in models for agent in _agents(model)}
    if question.agent is not None and question.agent not in agents:
        raise _unknown("agent", question.agent, agents)
    asked = list(agents.values()) if question.agent is None else [agents[question.agent]]
    told: list[dict[str, Any]] = []
    for agent in asked:
        explanation = agent.explain(question.at)
        reasons = [reason for reason in explanation.productions if question.production in (None, reason.name)]
        plain = plain_answer(explanation)
        plain["productions"] = [{**plain_answer(reason), "seen": reason.seen, "text": str(reason)} for reason in reasons]
        plain["retrievals"] = [{**plain_answer(reason), "text": str(reason)} for reason in explanation.retrievals]
        told.append(plain)
    if question.production is not None and not any(one["productions"] for one in told):
        known = [production.name for agent in asked for production in agent._productions]
        raise _unknown("production", question.production, known)
    return told


def _agents(model: Model) -> Iterator[ProductionSystem]:
    """Yields the production systems that stand in no other one."""
    if isinstance(model, ProductionSystem):
        yield model
    else:
        for child in model._members():
            yield from _agents(child)


def _rows(question: say.Rows, models: Sequence[Model]) -> dict[str, Any]:
    memories = {part._path: part for model in models for part in model._tree() if isinstance(part, Memory)}
    if question.memory not in memories:
        raise _unknown("memory", question.memory, memories)
    memory = memories[question.memory]
    rows = memory_rows(memory, question.words, question.most)
    return {"memory": question.memory, "size": len(memory.dm), "threshold": memory.threshold, "rows": [plain_answer(row) for row in rows]}


def _body(name: str | None, world: World | None) -> Any:
    bodies = {} if world is None else world.bodies
    if not bodies:
        raise Actr3dError("the run has no body")
    if name is None:
        return next(iter(bodies.values()))
    if name not in bodies:
        raise _unknown("body", name, bodies)
    return bodies[name]


def _look(body: Any) -> dict[str, Any]:
    from actr3d.camera import glance

    view = glance(body)
    extents = view.as_array()
    return {"body": body.name, "rows": view.rows, "fields": list(extents.dtype.names or ()), "extents": extents.tolist()}


def _stand(body: Any) -> dict[str, Any]:
    from actr3d.world.sensors import SENSORS
    from actr3d.world.sensors.touch import present

    limits = {joint.name: joint.limits for joint in body.joints.values()}
    joints = plain_answer(SENSORS["joints"](body))
    box = body.bounding_box("body")
    return {
        "body": body.name,
        "pose": plain_answer(SENSORS["pose"](body)),
        "joints": {name: {"now": reading, "limits": limits.get(name)} for name, reading in joints.items()},
        "contacts": [plain_answer(touch) for touch in present(body)],
        "box": {"lower": box.lower, "upper": box.upper, "size": box.size},
    }


def _events(question: say.Events, trace: Trace | None) -> dict[str, Any]:
    events = [] if trace is None else trace.since(question.first)[: question.most]
    wanted = [event for event in events if question.kinds is None or event.kind in question.kinds]
    told = [[event.time_us, event.source, event.kind, event.data] for event in wanted]
    return {"first": question.first, "next": question.first + len(events), "total": 0 if trace is None else len(trace), "events": told}


def _unknown(what: str, name: str, known: Any) -> Actr3dError:
    return Actr3dError(f"no {what} '{name}'{did_you_mean(name, known)}; there are: {', '.join(known) or 'none'}")
