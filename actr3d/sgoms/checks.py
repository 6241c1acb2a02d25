"""Checks that planning units and productions refer to each other correctly, before an agent starts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from actr3d.actr import ProductionSystem
from actr3d.actr.kernel.tree import subtree
from actr3d.actr.procedural.production import Production
from actr3d.actr.procedural.production_system import procedural_state_of
from actr3d.errors import PlanError, did_you_mean
from actr3d.sgoms.units import PlanningUnit
from actr3d.warnings import warn_at


def check_plans(agent: Any, units: Mapping[str, PlanningUnit]) -> None:
    """Checks that every unit task has a production, and warns of productions for unknown unit tasks and planning units.

    Raises:
        PlanError: If no production matches a unit task.
    """
    productions = _own_productions(agent)
    tasks = {task: name for name, unit in units.items() for task in unit.unit_tasks}
    taken = {name for production in productions for name in _named(production, "unit_task")}
    if not any(_matches_any_unit_task(production) for production in productions):
        for task, unit in tasks.items():
            if task not in taken:
                raise PlanError(
                    f"planning unit '{unit}' of {type(agent).__name__}: no production matches its unit task '{task}': none has "
                    f"b_unit_task='unit_task:{task} …'{did_you_mean(task, taken - tasks.keys())}"
                )
    for production in productions:
        for key, known in (("unit_task", tasks), ("planning_unit", units)):
            for name in _named(production, key):
                if name not in known and name not in ("none", "start", "finished"):
                    what = f"no planning unit has a unit task '{name}'" if key == "unit_task" else f"there is no planning unit '{name}'"
                    warn_at(f"production '{production.name}' can never match: {what}{did_you_mean(name, known)}", production.original_func)


def matches_state(agent: Any, state: str) -> bool:
    """Returns whether one of the modeller's productions tests for this state by name, in a planning unit or a unit task."""
    return any(state in _named(production, "state") for production in _own_productions(agent))


def _own_productions(agent: Any) -> list[Production]:
    """Returns an agent's productions without those that every SGOMS agent has."""
    productions = [p for part in subtree(agent) if isinstance(part, ProductionSystem) for p in procedural_state_of(part).productions]
    return [p for p in productions if not p.name.startswith("sgoms_")]


def _named(production: Production, key: str) -> Iterator[str]:
    """Yields the names that a production matches in a slot of the buffers of planning units and unit tasks."""
    for condition in production.conditions:
        if condition.name in ("b_unit_task", "b_plan_unit") and condition.key == key and condition.op == "is":
            yield condition.value


def _matches_any_unit_task(production: Production) -> bool:
    """Returns whether a production may match any unit task."""
    found = [condition for condition in production.conditions if condition.name == "b_unit_task" and condition.op != "empty"]
    return bool(found) and not any(condition.key == "unit_task" and condition.op == "is" for condition in found)
