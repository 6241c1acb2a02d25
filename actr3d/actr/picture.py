"""What all parts of a model are like at present, for who looks on; no code of the modeller's is run."""

from __future__ import annotations

from itertools import islice
from typing import Any

from actr3d.actr.buffer import Buffer
from actr3d.actr.memory import Memory
from actr3d.actr.model import Model
from actr3d.actr.production_system import ProductionSystem
from actr3d.actr.traced import traceable

MOST_PARTS = 400
"""So many parts are told of; a grid world has one for each of its cells."""


def picture_of(top: Model) -> dict[str, dict[str, Any]]:
    """Returns by path, in the order of the tree: what a part `is`, its `class`, and what it is like.

    A buffer has its `chunk` (None for none), a production system its `productions` and the one that is `chosen`, every other
    part its `state`: its plain attributes.
    """
    return {part._path: _part(part) for part in islice(top._tree(), MOST_PARTS)}


def _part(part: Any) -> dict[str, Any]:
    told: dict[str, Any] = {"is": _kind(part), "class": type(part).__name__}
    if isinstance(part, Buffer):
        return {**told, "chunk": traceable(part.chunk)}
    told["state"] = part._state()
    if isinstance(part, ProductionSystem):
        chosen = part._chosen
        told["productions"] = [production.name for production in part.__dict__.get("_productions", ())]
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
