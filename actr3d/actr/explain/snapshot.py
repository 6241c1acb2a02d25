"""What all parts of a model are like at present, for who looks on; no code of the modeller's is run."""

from __future__ import annotations

from itertools import islice
from typing import Any

from actr3d.actr.declarative.memory import Memory
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.model import Model, state_of
from actr3d.actr.kernel.tracing import traceable
from actr3d.actr.kernel.tree import path_of, subtree
from actr3d.actr.procedural.production_system import ProductionSystem, rules_of

MOST_PARTS = 400
"""So many parts are told of; a grid world has one for each of its cells."""


def picture_of(top: Model) -> dict[str, dict[str, Any]]:
    """Returns by path, in the order of the tree: what a part `is`, its `class`, and what it is like.

    A buffer has its `chunk` (None for none), a production system its `productions` and the one that is `chosen`, every other
    part its `state`: its plain attributes.
    """
    return {path_of(part): _part(part) for part in islice(subtree(top), MOST_PARTS)}


def _part(part: Any) -> dict[str, Any]:
    told: dict[str, Any] = {"is": _kind(part), "class": type(part).__name__}
    if isinstance(part, Buffer):
        return {**told, "chunk": traceable(part.chunk)}
    told["state"] = state_of(part)
    if isinstance(part, ProductionSystem):
        rules = rules_of(part)
        chosen = rules.chosen
        told["productions"] = [production.name for production in rules.productions]
        told["chosen"] = None if chosen is None else chosen.name
    return told


def _kind(part: Any) -> str:
    if isinstance(part, ProductionSystem):
        return "system"
    if isinstance(part, Memory):
        return "memory"
    if isinstance(part, Buffer):
        return "buffer"
    return "module" if "busy" in part.__dict__ else "part"
