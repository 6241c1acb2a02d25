"""The names of the measures of a trial, as far as they are known before an experiment runs, and checks of the names that a user gives."""

from __future__ import annotations

import ast
import symtable
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields

from actr3d.actr.compat.old_names import is_old_name
from actr3d.actr.kernel.source_code import names_defined_in, syntax_tree
from actr3d.actr.lint.checks import unchecked
from actr3d.actr.loading.global_seed import shared_random
from actr3d.errors import DesignError
from actr3d.experiment.specification import Experiment, naming_the_line
from actr3d.experiment.trial import NO_MEASURE, WRONG_MEASURE, Row, check_name, limits_of, parameters_for
from actr3d.experiment.trial_process import TrialProcess
from actr3d.output import printing_nothing
from actr3d.weak_cache import weak_cache

PATIENCE = 60.0
"""The maximum time for which a first trial runs whose measures are not known before [s]."""
NOTHING_LEFT = (
    "ended because no agent had anything left to do (`done`). A moving body alone does not continue a trial. If the agent should do more, "
    "add a production that waits for the body, and end with `self.stop()`."
)
"""What a trial with a body may have ended too early for."""


@weak_cache
def known_measures(experiment: Experiment) -> tuple[str, ...] | None:
    """Returns the names of the measures that a trial can have: the fields of the result that the simulation of the first trial has before
    it runs, or the variables that the text of a program sets. None if only a run shows them: with a function `results`, for a simulation
    that cannot be built or has no result yet, and for a program whose code may set other variables."""
    design, model = experiment.design, experiment.specification.model
    if design.results is not None:
        return None
    if experiment.blueprint is None:
        helpers = [text for _, text in model.helpers.values()]
        return None if any("__main__" in text for text in helpers) else variables_set_in(model.text)
    try:
        trial = design.trial(0)
        limits = limits_of(experiment, trial)
        with printing_nothing(), unchecked(), limits, shared_random(limits.program_seed):
            result = experiment.blueprint.build(parameters_for(experiment, trial))[0].result()
    except Exception:  # noqa: BLE001 - the trial fails, with this error in its row
        return None
    return None if result is None else tuple(field.name for field in fields(result))


def check_measures(experiment: Experiment) -> bool:
    """Checks the names of the design's measures before anything runs; returns whether the measures of its trials are known.

    Raises:
        DesignError: If a trial can have no measure of that name; names the file and the line.
    """
    specification, known = experiment.specification, known_measures(experiment)
    if known is None:
        return False
    with naming_the_line(specification.design, specification.name):
        for measure in experiment.design.kept:
            check_name(measure.name, known)
    return True


def try_measures(experiment: Experiment) -> Row | None:
    """Runs the first trial, for measures that only a run shows, and returns its row; None if it fails or takes too long.

    Raises:
        DesignError: If a measure is missing, or cannot be one; names the file and the line.
        ExperimentError: If the experiment cannot be loaded.
    """
    process, design = TrialProcess(), experiment.design
    try:
        row = process.run(experiment.specification.to_json(), 0, min(design.limit, PATIENCE))
    finally:
        process.close()
    check_row(row)
    return row if row["error"] is None else None


def check_row(row: Row, *, checked: bool = False) -> None:
    """Checks that a trial has all measures of its design.

    Args:
        row: The row of the trial.
        checked: Whether the names of the measures were checked before: then a missing measure is a failure of this trial only.

    Raises:
        DesignError: If one is missing, or cannot be a measure.
    """
    if row["end"] == WRONG_MEASURE or (row["end"] == NO_MEASURE and not checked):
        raise DesignError(row["error"].removeprefix("error: "), "measures")


def ended_early(ends: Iterable[str]) -> bool:
    """Returns whether all trials ended because no agent had anything left to do, which may be too early for what is measured."""
    return set(ends) == {"done"}


def variables_set_in(text: str) -> tuple[str, ...] | None:
    """Returns the variables that the text of a program sets at its top level, or in a function as `global`, without those that are
    nothing but functions, classes and modules; None if its code may set others.

    Raises:
        SyntaxError: If it is not Python.
    """
    tree = syntax_tree(text)
    nodes = list(ast.walk(tree))
    if names_defined_in(tree) is None or "__main__" in text or ".modules" in text or any(map(_is_unknown, nodes)):
        return None
    whole = symtable.symtable(text, "<model>", "exec")
    stored = {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    modules = {alias.asname or alias.name.partition(".")[0] for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    bound = [one for one in whole.get_symbols() if one.is_assigned() or one.is_imported()]
    own = [one.get_name() for one in bound if one.get_name() in stored or not (one.is_namespace() or one.get_name() in modules)]
    return tuple(dict.fromkeys([*own, *_globals_of(whole.get_children())]))


def _is_unknown(node: ast.AST) -> bool:
    """Returns whether a statement imports all names of a module that may have any."""
    if not isinstance(node, ast.ImportFrom) or node.names[0].name != "*":
        return False
    root = (node.module or "").partition(".")[0]
    return node.level > 0 or not (root == "actr3d" or is_old_name(root))


def _globals_of(tables: Sequence[symtable.SymbolTable]) -> Iterator[str]:
    for table in tables:
        yield from (one.get_name() for one in table.get_symbols() if one.is_declared_global() and one.is_assigned())
        yield from _globals_of(table.get_children())
