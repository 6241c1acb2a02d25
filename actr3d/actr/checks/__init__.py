"""Says what is most likely not meant in a model: it runs once for each class, when an agent begins.

A check only warns (`ModelWarning`, at the modeller's own file and line); it never changes what the model does, and
looks at nothing whose reading could.
"""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING
from weakref import WeakSet

from actr3d.actr.checks.bodies import check_actions, check_modeller_method
from actr3d.actr.checks.classes import check_names_of_methods, check_parameters, is_modellers
from actr3d.actr.checks.contradictions import check_contradictions
from actr3d.actr.checks.patterns import check_patterns, check_slots, check_variables

if TYPE_CHECKING:
    from actr3d.actr.model import Model
    from actr3d.actr.procedural import ProductionSystem

_CHECKED: WeakSet[type] = WeakSet()
_CHECKED_CLASSES: WeakSet[type] = WeakSet()


def check_rules(system: ProductionSystem) -> bool:
    """Checks an agent's class before it acts, unless that has been done; tells whether it has not."""
    if type(system) in _CHECKED:
        return False
    _CHECKED.add(type(system))
    for production in system._productions:
        check_contradictions(production)
        check_variables(production)
        check_patterns(production)
    for production in (*system._initializers, *system._productions):
        check_actions(production)
    *_, top = system._line()
    check_classes(top)
    check_parameters(system)
    return True


def check_names(system: ProductionSystem) -> None:
    """Checks the names and values that patterns ask for, once the methods without parameters have set things up."""
    for production in system._productions:
        check_slots(production)


def check_classes(top: Model) -> None:
    """Checks the methods that modellers have written in the classes of a tree's parts."""
    for part in top._tree():
        for klass in type(part).__mro__:
            if not is_modellers(klass) or klass in _CHECKED_CLASSES:
                continue
            _CHECKED_CLASSES.add(klass)
            functions = [member for member in vars(klass).values() if inspect.isfunction(member)]
            if functions:
                check_names_of_methods(klass, functions[0])
                for func in functions:
                    check_modeller_method(func, part)
