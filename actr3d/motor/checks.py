"""Warns about productions that match attributes that a motor module does not have. Runs when the module knows its body."""

from __future__ import annotations

from weakref import WeakKeyDictionary

from actr3d.actr.chunks.pattern import by_variable
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import subtree, top_of
from actr3d.actr.procedural.production_system import ProductionSystem, procedural_state_of
from actr3d.errors import did_you_mean
from actr3d.warnings import warn_at

_CHECKED: WeakKeyDictionary[type, set[frozenset[str]]] = WeakKeyDictionary()
"""By class of production systems, the attributes of the motor modules that it was checked with."""


def check_patterns(motor: Model) -> None:
    """Warns, once for each class of agent and kind of body, of patterns that name a muscle group, joint or state that does not exist."""
    known = [name for name in vars(motor) if name[0] != "_"]
    for system in subtree(top_of(motor)):
        if not isinstance(system, ProductionSystem) or frozenset(known) in _CHECKED.get(type(system), ()):
            continue
        productions = procedural_state_of(system).productions
        of_motor = [production for production in productions if any(target is motor for target in production.context.values())]
        if of_motor:
            _CHECKED.setdefault(type(system), set()).add(frozenset(known))
        for production in of_motor:
            for condition in production.conditions:
                key = condition.key
                if not isinstance(key, str) or by_variable(key) or condition.op in ("empty", "call"):
                    continue
                if production.context[condition.name or "self"] is motor and key.partition(".")[0] not in known:
                    what = f"'{condition.name}' has no attribute '{key}'{did_you_mean(key, known)}"
                    warn_at(f"production '{production.name}' can never match: {what}", production.original_func)
