"""Planning units as data: ordered ones are chains in declarative memory, situated ones choose by the situation."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from actr3d.actr import Memory
from actr3d.actr.chunks.pattern import conditions, not_patterns
from actr3d.errors import PatternException, PlanError, alternatives

BEFORE, START, END = "none", "start", "finished"
"""Names in a chain instead of unit tasks: before the start, the start, and the end."""
_WORD = re.compile(r"[\w.-]+")


@dataclass(frozen=True, init=False)
class Ordered:
    """A planning unit whose unit tasks follow one another in a fixed order; its name is that of the agent's attribute.

    The order is stored as chunks in declarative memory, `planning_unit:… cuelag:… cue:… unit_task:…`: the unit task before
    the previous one, the previous one, and the next one. So the next one is retrieved, which takes time and can fail.

    Args:
        unit_tasks: Their names, in order.
        activation: Arguments of each chunk for the memory's activation modules: `baselevel`, `fixed`, `time`, as in `Memory.add`.

    Raises:
        PlanError: If there is no unit task, a name is not one word or is reserved, or the cues are ambiguous, because the same two
            successive unit tasks occur twice with different ones after them.
    """

    unit_tasks: tuple[str, ...]
    activation: Mapping[str, Any]
    kind = "ordered"

    def __init__(self, *unit_tasks: str, **activation: Any) -> None:
        if not unit_tasks:
            raise PlanError("Ordered(): a planning unit needs unit tasks: Ordered('boil', 'pour')")
        _check_words("Ordered", unit_tasks)
        object.__setattr__(self, "unit_tasks", unit_tasks)
        object.__setattr__(self, "activation", activation)
        known: dict[tuple[str, str], str] = {}
        for lag, cue, task in self.links():
            if known.setdefault((lag, cue), task) != task:
                raise PlanError(
                    f"Ordered{unit_tasks}: after '{lag}', '{cue}' comes '{known[lag, cue]}' once and '{task}' once, which memory "
                    "cannot distinguish; give one of the unit tasks another name"
                )
        if len(known) <= len(unit_tasks):
            raise PlanError(
                f"Ordered{unit_tasks}: it has no end, because the same cues occur again; give one of the unit tasks another name"
            )

    def links(self) -> list[tuple[str, str, str]]:
        """Returns the chain: (unit task before the previous one, previous one, next one)."""
        line = (BEFORE, START, *self.unit_tasks, END)
        return list(zip(line, line[1:], line[2:], strict=False))

    def remember(self, name: str, memory: Memory) -> None:
        """Adds the chain to declarative memory."""
        for lag, cue, task in self.links():
            memory.add({"planning_unit": name, "cuelag": lag, "cue": cue, "unit_task": task}, **self.activation)


@dataclass(frozen=True, init=False)
class Situated:
    """A planning unit whose next unit task depends on the situation; its name is that of the agent's attribute.

    Args:
        until: The situation in which it ends: a pattern for the buffer `b_context`, with priority over all unit tasks.
        situations: By unit task, its situation: a pattern for `b_context`, or a list of patterns. If several
            match, the one with the highest utility is chosen, or one at random.

    Raises:
        PlanError: If it has no unit task or no end, a name is reserved, or a situation is not a pattern.
        PatternException: If a pattern cannot be read.
    """

    until: Any
    situations: Mapping[str, Any]
    kind = "situated"

    def __init__(self, until: Any = None, **situations: Any) -> None:
        if not situations:
            raise PlanError("Situated(): a planning unit needs unit tasks: Situated(until='dishes:clean', wash='dishes:dirty')")
        if until is None:
            raise PlanError(f"Situated({', '.join(situations)}): it has no end; give the situation in which it ends: until='dishes:clean'")
        _check_words("Situated", situations)
        for name, pattern in {**situations, "until": until}.items():
            for part in not_patterns(pattern):
                raise PlanError(f"Situated({name}={pattern!r}): {part!r} is not a pattern for b_context; write text, such as '{part}'")
            try:
                conditions({"b_context": pattern})
            except PatternException as error:
                raise PatternException(f"Situated({name}={pattern!r}): {error}") from None
        object.__setattr__(self, "until", until)
        object.__setattr__(self, "situations", situations)

    @property
    def unit_tasks(self) -> tuple[str, ...]:
        """The names of its unit tasks."""
        return tuple(self.situations)

    def remember(self, name: str, memory: Memory) -> None:
        """Does nothing: the next unit task depends on the situation, not on memory."""


PlanningUnit = Ordered | Situated


class Plans:
    """The planning units of one agent by name.

    Args:
        agent: The name of the agent's class, for messages.
        units: The planning units.
    """

    def __init__(self, agent: str, units: Mapping[str, PlanningUnit]) -> None:
        self.units = units
        self._agent = agent

    def unit(self, name: str, where: str) -> PlanningUnit:
        """Returns a planning unit by name.

        Args:
            name: Its name.
            where: The buffer that names it, for the message.

        Raises:
            PlanError: If there is none.
        """
        if name not in self.units:
            raise PlanError(f"{where}: {self._agent} has no planning unit '{name}'{alternatives(name, self.units, 'it has:')}")
        return self.units[name]

    def check_unit_task(self, name: str) -> None:
        """Checks that a planning unit has a unit task.

        Raises:
            PlanError: If none has it.
        """
        known = dict.fromkeys(task for unit in self.units.values() for task in unit.unit_tasks)
        if name not in known:
            raise PlanError(f"b_unit_task: no planning unit of {self._agent} has a unit task '{name}'{alternatives(name, known)}")


def plans_of(agent: Any) -> Plans:
    """Returns the planning units of an agent."""
    return agent.__dict__["_plans"]  # private, because the public attributes of an agent belong to the modeller


def _check_words(kind: str, names: Any) -> None:
    for name in names:
        if not isinstance(name, str) or not _WORD.fullmatch(name):
            raise PlanError(f"{kind}: the name of a unit task is one word of letters, digits, '_', '.' and '-' (got {name!r})")
        if name in (BEFORE, START, END):
            raise PlanError(f"{kind}: a unit task cannot be called '{name}', which is reserved for the start or the end; use another name")
