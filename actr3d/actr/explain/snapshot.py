"""The current state of all parts of a model, for observers; none of the modeller's code is run."""

from __future__ import annotations

from itertools import islice
from typing import Any

from actr3d.actr.declarative.memory import Memory
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.model import Model, state_of
from actr3d.actr.kernel.tracing import traceable
from actr3d.actr.kernel.tree import path_of, subtree
from actr3d.actr.procedural.production_system import ProductionSystem, procedural_state_of

MAX_PARTS = 400
"""The maximum number of parts in a snapshot."""


def snapshot_of(top: Model) -> dict[str, dict[str, Any]]:
    """Returns the state of all parts by path, in the order of the tree: the kind (`is`), the `class`, and the state of each.

    A buffer has its `chunk` or None, a production system its `productions` and the `chosen` one, and every part but a buffer its
    `state`: its plain attributes.
    """
    return {path_of(part): _part(part) for part in islice(subtree(top), MAX_PARTS)}


def _part(part: Any) -> dict[str, Any]:
    known: dict[str, Any] = {"is": _kind(part), "class": type(part).__name__}
    if isinstance(part, Buffer):
        return {**known, "chunk": traceable(part.chunk)}
    known["state"] = state_of(part)
    if isinstance(part, ProductionSystem):
        state = procedural_state_of(part)
        chosen = state.chosen
        known["productions"] = [production.name for production in state.productions]
        known["chosen"] = None if chosen is None else chosen.name
        if state.forbidden:
            known["forbidden"] = sorted(state.forbidden)
    return known


def _kind(part: Any) -> str:
    if isinstance(part, ProductionSystem):
        return "system"
    if isinstance(part, Memory):
        return "memory"
    if isinstance(part, Buffer):
        return "buffer"
    return "module" if "busy" in part.__dict__ else "part"
