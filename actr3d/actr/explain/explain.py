"""Explains an agent: which productions match and why the others do not, and which chunk won a retrieval and why.

An explanation of the present reads the model; the run need not be traced. An explanation of a past time reads only the trace.
"""

from __future__ import annotations

from typing import TypeVar

from actr3d.actr.declarative.memory import Memory
from actr3d.actr.explain.condition_tests import why
from actr3d.actr.explain.past_state import Past
from actr3d.actr.explain.present_state import Present
from actr3d.actr.kernel.model import Model, ensure_converted
from actr3d.actr.kernel.tree import path_of, places_in, subtree, top_of
from actr3d.actr.modules.port import Searching
from actr3d.actr.procedural.production_system import ProductionSystem, prepare_context, procedural_state_of
from actr3d.actr.reasons import Explanation
from actr3d.clock import microseconds, seconds
from actr3d.errors import ParameterError, SchedulerError
from actr3d.trace import run_of

Kind = TypeVar("Kind", bound=Model)


def explain(agent: ProductionSystem, at: float | None = None) -> Explanation:
    """Explains an agent, the parallel systems inside it, and the memories it has or sees; see `ProductionSystem.explain`."""
    ensure_converted(agent)
    systems = [part for part in subtree(agent) if isinstance(part, ProductionSystem)]
    for system in systems:
        prepare_context(system)
    memories, eyes = _modules_in_sight(Memory, agent, systems), _modules_in_sight(Searching, agent, systems)
    state = Present(agent) if at is None else _past(agent, at, systems, [*memories, *eyes])
    productions = [
        why(p, state) for system in systems if state.exists(system) for p in procedural_state_of(system).productions if state.learned(p)
    ]
    retrievals = [state.retrieval(memory) for memory in memories if state.exists(memory)]
    searches = [reason for eye in eyes if state.exists(eye) for reason in state.searches(eye)]
    return Explanation(
        time=state.time,
        agent=state.path(agent),
        begun=procedural_state_of(agent).matcher is not None,
        productions=tuple(productions),
        retrievals=tuple(reason for reason in retrievals if reason is not None),
        searches=tuple(searches),
    )


def _past(agent: ProductionSystem, at: float, systems: list[ProductionSystem], modules: list[Model]) -> Past:
    """Returns the state at a past time.

    Raises:
        ParameterError: If it is not known, or the agent did not exist then.
    """
    try:
        time = microseconds(at, "explain(at)")
    except SchedulerError as error:
        raise ParameterError(str(error)) from None
    traces = agent.sch.traces
    trace = next((one for one in traces if one.level == "all" and one.keep), None)
    if trace is None:
        raise ParameterError(
            "explain(at): only a run traced at the level 'all' from before that time contains its past; call traced() before the run"
        )
    if time > agent.sch.now_us:
        raise ParameterError(f"explain(at): {at:g} s lies ahead; it is {agent.now():g} s now")
    top = top_of(agent)
    run = run_of(path_of(top)) if trace is traces[0] else next((n for n, run in enumerate(trace.runs, 1) if run.model is top), 1)
    begin = next((event.time for event in trace if event.run == run), agent.now())
    if time < microseconds(begin):
        raise ParameterError(f"explain(at): the trace begins at {begin:g} s; what was before the trace is not known (got {at:g} s)")
    visible = [target for system in systems for target in procedural_state_of(system).context.values() if isinstance(target, Model)]
    state = Past(
        trace, None if trace is traces[0] else run, time, list({id(part): part for part in (agent, *systems, *modules, *visible)}.values())
    )
    if not state.exists(agent):
        came = next(place.time for place in places_in(agent, trace) if place.path is not None)
        raise ParameterError(f"explain(at): '{path_of(agent)}' did not exist at {at:g} s; it was added at {seconds(came):g} s")
    return state


def _modules_in_sight(kind: type[Kind], agent: Model, systems: list[ProductionSystem]) -> list[Kind]:
    """Returns an agent's modules of a kind, and those of its ancestors that its productions see by name."""
    found = [part for part in subtree(agent) if isinstance(part, kind)]
    for system in systems:
        for target in procedural_state_of(system).context.values():
            if isinstance(target, kind) and not any(target is known for known in found):
                found.append(target)
    return found
