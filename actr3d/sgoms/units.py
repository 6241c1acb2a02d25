"""Planning units as data: ordered ones are chains in declarative memory, situated ones are led by the situation."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from actr3d.actr import Memory
from actr3d.actr.chunks.pattern import conditions
from actr3d.errors import PatternException, PlanError

BEFORE, START, END = "none", "start", "finished"
"""In the place of a unit task: what comes before the start, the start itself, and the end."""
_WORD = re.compile(r"[\w.-]+")


@dataclass(frozen=True, init=False)
class Ordered:
    """A planning unit whose unit tasks follow one another in a fixed order; the attribute it is set as is its name.

    The order is kept as chunks in declarative memory, `planning_unit:… cuelag:… cue:… unit_task:…`: the unit task before
    the last, the last, and the next. So the next one is remembered, in its time, and can be forgotten.

    Args:
        unit_tasks: Their names, in order.
        added: What the memory's activation modules are told of each chunk: `baselevel`, `fixed`, `time`, as in `Memory.add`.

    Raises:
        PlanError: If there is no unit task, a name is not one word or has a meaning of its own, or the cues cannot
            tell what comes next, because two unit tasks that follow one another do so again with another one after them.
    """

    unit_tasks: tuple[str, ...]
    added: Mapping[str, Any]
    kind = "ordered"

    def __init__(self, *unit_tasks: str, **added: Any) -> None:
        if not unit_tasks:
            raise PlanError("Ordered(): a planning unit needs unit tasks: Ordered('boil', 'pour')")
        _check_words("Ordered", unit_tasks)
        object.__setattr__(self, "unit_tasks", unit_tasks)
        object.__setattr__(self, "added", added)
        known: dict[tuple[str, str], str] = {}
        for lag, cue, task in self.links():
            if known.setdefault((lag, cue), task) != task:
                raise PlanError(
                    f"Ordered{unit_tasks}: after '{lag}', '{cue}' comes '{known[lag, cue]}' once and '{task}' once, which memory "
                    "cannot tell apart; give one of the unit tasks another name"
                )
        if len(known) <= len(unit_tasks):
            raise PlanError(f"Ordered{unit_tasks}: it has no end, for the same cues come again; give one of the unit tasks another name")

    def links(self) -> list[tuple[str, str, str]]:
        """Returns the chain: (unit task before the last, last one, next one)."""
        line = (BEFORE, START, *self.unit_tasks, END)
        return list(zip(line, line[1:], line[2:], strict=False))

    def remember(self, name: str, memory: Memory) -> None:
        """Puts the chain into declarative memory."""
        for lag, cue, task in self.links():
            memory.add({"planning_unit": name, "cuelag": lag, "cue": cue, "unit_task": task}, **self.added)


@dataclass(frozen=True, init=False)
class Situated:
    """A planning unit whose next unit task is the one that the situation asks for; the attribute it is set as is its name.

    Args:
        until: The situation in which it has ended: a pattern for the buffer `b_context`. It comes before any unit task.
        situations: By unit task, the situation that asks for it: a pattern for `b_context`, or a list of patterns. Of
            several, the one with the highest utility is chosen, or one at random.

    Raises:
        PlanError: If it has no unit task or no end, or a name has a meaning of its own.
        PatternException: If a pattern cannot be read.
    """

    until: Any
    situations: Mapping[str, Any]
    kind = "situated"

    def __init__(self, until: Any = None, **situations: Any) -> None:
        if not situations:
            raise PlanError("Situated(): a planning unit needs unit tasks: Situated(until='dishes:clean', wash='dishes:dirty')")
        if until is None:
            raise PlanError(f"Situated({', '.join(situations)}): it has no end; say in which situation it ends: until='dishes:clean'")
        _check_words("Situated", situations)
        for name, pattern in {**situations, "until": until}.items():
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
        """Leaves memory as it is: what comes next is seen, not remembered."""


PlanningUnit = Ordered | Situated


def _check_words(kind: str, names: Any) -> None:
    for name in names:
        if not isinstance(name, str) or not _WORD.fullmatch(name):
            raise PlanError(f"{kind}: the name of a unit task is one word of letters, digits, '_', '.' and '-' (got {name!r})")
        if name in (BEFORE, START, END):
            raise PlanError(f"{kind}: a unit task cannot be called '{name}', which marks the start or the end; use another name")
