"""Runs all checks of a model, once for each class, when an agent begins.

A check only warns (`ModelWarning`, at the modeller's own file and line); it never changes what the model does, and
reads nothing whose reading could.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Generator
from contextlib import contextmanager
from contextvars import ContextVar
from weakref import WeakSet

from actr3d.actr.kernel.class_members import is_modellers
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import subtree, top_of
from actr3d.actr.lint.classes import check_names_in_modules, check_names_of_methods, check_parameters
from actr3d.actr.lint.contradictions import check_contradictions
from actr3d.actr.lint.method_calls import check_actions, check_modeller_method
from actr3d.actr.lint.patterns import check_patterns, check_slots, check_variables
from actr3d.actr.procedural.production_system import ProductionSystem, procedural_state_of

_CHECKED: WeakSet[type] = WeakSet()
_CHECKED_CLASSES: WeakSet[type] = WeakSet()
_WANTED: ContextVar[bool] = ContextVar("_WANTED", default=True)


@contextmanager
def unchecked() -> Generator[None]:
    """Disables the checks of agents that start inside the block, for runs whose warnings nobody reads."""
    before = _WANTED.set(False)
    try:
        yield
    finally:
        _WANTED.reset(before)


def check_agent(system: ProductionSystem) -> Callable[[], None] | None:
    """Checks an agent's class before its first cycle, once per class.

    Returns:
        The check of names and values in patterns, for when the methods without parameters have run; None if the class has been
        checked before, or within `unchecked`.
    """
    if type(system) in _CHECKED or not _WANTED.get():
        return None
    _CHECKED.add(type(system))
    state = procedural_state_of(system)
    for production in state.productions:
        check_contradictions(production)
        check_variables(production)
        check_patterns(production)
    for production in (*state.initializers, *state.productions):
        check_actions(production, state.productions)
    check_classes(top_of(system))
    check_parameters(system)
    check_names_in_modules(system, state.context)

    def check_names() -> None:
        for production in state.productions:
            check_slots(production)

    return check_names


def check_classes(top: Model) -> None:
    """Checks the methods that modellers have written in the classes of a tree's parts, once per class; not within `unchecked`."""
    if not _WANTED.get():
        return
    for part in subtree(top):
        for klass in type(part).__mro__:
            if not is_modellers(klass) or klass in _CHECKED_CLASSES:
                continue
            _CHECKED_CLASSES.add(klass)
            functions = [member for member in vars(klass).values() if inspect.isfunction(member)]
            if functions:
                check_names_of_methods(klass, functions[0])
                for func in functions:
                    check_modeller_method(func, part)
