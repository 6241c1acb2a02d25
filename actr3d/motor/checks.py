"""Checks when a motor module knows its body: names of joints, and productions that match attributes that the module does not have."""

from __future__ import annotations

from collections.abc import Iterable
from weakref import WeakKeyDictionary

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.chunks.pattern import Pattern, by_variable
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import subtree, top_of
from actr3d.actr.procedural.production_system import ProductionSystem, procedural_state_of
from actr3d.errors import PatternException, WorldError, did_you_mean
from actr3d.motor.schema import OTHER_SLOTS
from actr3d.warnings import warn_at, warn_modeller

_CHECKED: WeakKeyDictionary[type, set[frozenset[str]]] = WeakKeyDictionary()
"""By class of production systems, the attributes of the motor modules that it was checked with."""


def check_joints(body: str, joints: Iterable[str]) -> None:
    """Warns of joints that patterns cannot name.

    Args:
        body: The name of the body.
        joints: The names of its joints.

    Raises:
        WorldError: If a joint has the name of another slot of postures.
    """
    unnamed: list[str] = []
    for joint in joints:
        if joint in OTHER_SLOTS:
            raise WorldError(f"{body}: the joint '{joint}' has the name of another slot of postures; rename it in the file of the body")
        try:
            matches = Pattern(f"{joint}:0").match(Chunk({joint: "0"})) is not None
        except PatternException:
            matches = False
        if not matches:
            unnamed.append(f"'{joint}'")
    if unnamed:
        warn_modeller(
            f"{body}: patterns cannot name the joints {', '.join(unnamed)}; to match them, rename them in the file of the body, "
            "with letters, digits and '_' only"
        )


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
