"""The registry of analyses: what the report shows beyond what it shows of every experiment."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Any, TypeVar

import actr3d.experiment
from actr3d.experiment.report.parts import Section
from actr3d.registry import Registry, import_modules, lasting_name

Sections = Callable[[Any, Sequence[Any]], Sequence[Section]]
"""Returns sections, from the `Results` of the experiment and the means of people and of other experiments."""
F = TypeVar("F", bound=Sections)

ANALYSES: Registry[Sections] = Registry("analysis")
"""All analyses by name."""


def analysis(*columns: str, people: Collection[str] = ()) -> Callable[[F], F]:
    """Registers a function that returns more sections of a report.

    It is called for every experiment whose trials have certain columns, whatever its design and its model are called. Its arguments are
    a `Results`, and a list of `ReferenceMeans`: of people, or of another experiment. A file with a design can define such a function, too.

    Args:
        columns: The names of the columns: measures, factors or other parameters.
        people: Further columns that it reads in trials of people; they hold numbers.

    Raises:
        ValueError: If there is another analysis of this name.
    """

    def register(function: F) -> F:
        function.__dict__["needed_columns"] = frozenset(columns)
        function.__dict__["columns_of_people"] = tuple(people)
        ANALYSES.add(f"{lasting_name(function.__module__)}.{function.__qualname__}", function)
        return function

    return register


def find_analyses(columns: Collection[str]) -> list[Sections]:
    """Imports the module `analysis` of each package of `actr3d.experiment`, and returns those of trials with these columns."""
    import_modules(actr3d.experiment.__name__, actr3d.experiment.__path__, inner=True, named="analysis")
    return [function for function in ANALYSES.values() if function.__dict__["needed_columns"] <= set(columns)]


def columns_of_people(columns: Collection[str]) -> list[str]:
    """Returns the further columns of trials of people that some analysis of an experiment with these columns reads."""
    return list(dict.fromkeys(name for function in find_analyses(columns) for name in function.__dict__["columns_of_people"]))
