"""The place at which a planning unit was interrupted, as one chunk."""

from __future__ import annotations

from typing import Any

from actr3d.actr import Chunk
from actr3d.sgoms.levels import LEVELS
from actr3d.sgoms.units import END, START

PREFIXES = dict(zip(("plan", "task", "method", "operator"), LEVELS, strict=True))
"""Prefixes of the slots of each level's chunk in a place, whose names would clash otherwise."""


def place_of(agent: Any, plan: Chunk, number: str, *, whole: bool) -> dict[Any, Any]:
    """Returns the chunk of an agent's present place.

    Its slots: `saved` (the planning unit) and `place` (its number), which identify it, and those of the chunks
    in the agent's buffers, as `plan_cue` or `task_state`.

    Args:
        agent: The agent.
        plan: Its present planning unit.
        number: The number of the interruption.
        whole: Whether an interrupted unit task continues where it was; otherwise it starts again.
    """
    chunks: dict[str, dict[Any, Any]] = {"plan": dict(plan)}
    task = agent.b_unit_task.chunk
    if plan["state"] == "retrieving":
        chunks["plan"]["state"] = "begin"  # the request is repeated on resumption
    if task is not None and task["state"] == END:
        chunks["task"] = dict(task)
    elif task is not None and whole:
        for prefix, buffer in list(PREFIXES.items())[1:]:
            chunk = getattr(agent, buffer).chunk
            if chunk is not None:
                chunks[prefix] = dict(chunk)
        chunks["task"]["resumed"] = "yes"
    elif task is not None and plan["type"] == "situated":
        chunks["plan"]["state"] = "choosing"
    elif task is not None:
        chunks["task"] = {**task, "state": START, "resumed": "yes"}
    saved = {f"{prefix}_{slot}": value for prefix, slots in chunks.items() for slot, value in slots.items()}
    return {"saved": plan["planning_unit"], "place": number, **saved}


def put_back(agent: Any, place: Chunk) -> None:
    """Restores an agent's buffers from a place."""
    for prefix, buffer in PREFIXES.items():
        start = f"{prefix}_"
        slots = {slot.removeprefix(start): value for slot, value in place.items() if isinstance(slot, str) and slot.startswith(start)}
        if slots:
            again = prefix == "task" and slots["state"] == START
            getattr(agent, buffer).put_back(slots, "begun" if again else "resumed")
