"""Describes model files from their text alone: listing a file never executes it."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from actr3d.actr.kernel.source_code import last_name, productions_inside, syntax_tree
from actr3d.actr.loading.source_text import compile_source, read_source
from actr3d.actr.loading.sweep import parameters as first_lines
from actr3d.errors import ConfigurationError, ModelFileError, alternatives
from actr3d.parameter_schema import Parameter, default_of, parameters_in
from actr3d.runner.build_check import build_of, has_build, problem_of_build
from actr3d.values import escape_surrogates
from workbench.files import MAX_FILE_SIZE, MAX_FILES, file_stamp
from workbench.language.misspelt_words import misspelt_words
from workbench.undefined_names import undefined_names


@dataclass(frozen=True, kw_only=True)
class Problem:
    """Describes an error in a text, or a possible one."""

    level: str
    """`error` or `warning`."""
    message: str
    line: int | None = None


@dataclass(frozen=True, kw_only=True)
class WrittenPart:
    """A buffer, memory or other part of an agent, as its class body makes it."""

    name: str
    made_by: str
    """The name of the class that is called."""


@dataclass(frozen=True, kw_only=True)
class WrittenAgent:
    """A class with productions, as far as its text says what it has."""

    name: str
    productions: tuple[str, ...]
    parts: tuple[WrittenPart, ...]


@dataclass(frozen=True, kw_only=True)
class ModelListing:
    """Describes a model file, as far as this is possible without executing it."""

    title: str = ""
    """The first line of its docstring."""
    text: str = ""
    """Its docstring."""
    kind: str = "program"
    """`simulation` if the file defines `build`, otherwise `program`."""
    parameters: tuple[Parameter, ...] = ()
    later: tuple[str, ...] = ()
    """The other variables that a program sets at its top level: after other code, so that they are no parameters."""
    agents: tuple[WrittenAgent, ...] = ()
    problems: tuple[Problem, ...] = ()

    @property
    def productions(self) -> tuple[str, ...]:
        """The names `Agent.production` that were found in the text."""
        return tuple(f"{agent.name}.{production}" for agent in self.agents for production in agent.productions)

    def parameter(self, name: str) -> Parameter:
        """Returns a parameter by name.

        Raises:
            ConfigurationError: If there is no parameter of that name.
        """
        known = {parameter.name: parameter for parameter in self.parameters}
        if name not in known:
            raise ConfigurationError(f"no parameter '{name}'{alternatives(name, known)}")
        return known[name]


def listing_of(source: str, filename: str = "model.py") -> ModelListing:
    """Returns the description of a model's text; errors and warnings are in `problems`."""
    problems = tuple(problems_of(source, filename))
    tree = syntax_tree(source)
    text = escape_surrogates(ast.get_docstring(tree) or "")
    builds = has_build(source)
    parameters = tuple(parameters_in(tree, build_of(tree)) if builds else _of_first_lines(source))
    return ModelListing(
        title=text.split("\n", 1)[0],
        text=text,
        kind="simulation" if builds else "program",
        parameters=parameters,
        later=() if builds else tuple(_set_later(tree, {parameter.name for parameter in parameters})),
        agents=tuple(_agents(tree)),
        problems=problems,
    )


@dataclass(frozen=True)
class Outline:
    """Holds what a list shows of a model file."""

    title: str = ""
    kind: str = "program"


def outline_of(path: Path) -> Outline:
    """Returns the outline of a file, which is read again only when it has changed; an empty one if the file cannot be read."""
    stamp = file_stamp(path)
    try:
        return _outline(path, stamp) if stamp and stamp[-1] <= MAX_FILE_SIZE else Outline()
    except (OSError, ModelFileError):
        return Outline()


@lru_cache(maxsize=2 * MAX_FILES)
def _outline(path: Path, _: tuple[int, ...]) -> Outline:
    """Reads a file; the stamp changes when the file changes, so that the cache is not used for an old version."""
    listing = listing_of(read_source(path), path.name)
    return Outline(listing.title, listing.kind)


def problems_of(source: str, filename: str = "model.py") -> Iterator[Problem]:
    """Yields the errors and warnings of compiling a text; it is not executed."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            compile_source(source, filename)
        except ModelFileError as error:
            named = re.match(rf"{re.escape(filename)}:(\d+): (.*)", str(error), re.DOTALL)
            yield Problem(
                level="error", message=escape_surrogates(named[2] if named else str(error)), line=int(named[1]) if named else None
            )
    found = problem_of_build(source)
    if found is not None:
        yield Problem(level="error", message=escape_surrogates(found[1]), line=found[0])
    for warning in caught:
        yield Problem(level="warning", message=escape_surrogates(str(warning.message)), line=warning.lineno)


def undefined_in(source: str) -> Iterator[Problem]:
    """Yields a warning for each name that nothing defines; apart from `problems_of`, as only who checks a text wants them."""
    return map(_warning, undefined_names(syntax_tree(source)))


def misplaced_in(source: str) -> Iterator[Problem]:
    """Yields a warning for each production inside another method, as the agent gives it when it begins."""
    for kind in (node for node in syntax_tree(source).body if isinstance(node, ast.ClassDef)):
        parts = {part.name for part in _parts(kind)}
        for method in (node for node in kind.body if isinstance(node, ast.FunctionDef)):
            yield from map(_warning, productions_inside(method, parts.__contains__))


def misspelt_in(source: str) -> Iterator[Problem]:
    """Yields a warning for each misspelt word of the library: features and their slots in patterns, and commands to bodies."""
    return map(_warning, misspelt_words(source))


def _warning(found: tuple[int, str]) -> Problem:
    """Returns the warning that a check has found, given its line and its message."""
    return Problem(level="warning", message=escape_surrogates(found[1]), line=found[0])


def _of_first_lines(source: str) -> Iterator[Parameter]:
    """Yields parameters from the first lines of a program (`name = value`) whose values are literals."""
    try:
        found = first_lines(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    for name, node in found.items():
        default = default_of(node.value, {})
        if default["known"]:
            value = default["default"]
            kind = type(value).__name__
            takes = {"bool": "switch", "int": "number", "float": "number", "str": "text"}.get(kind, kind)
            yield Parameter(name=name, takes=takes, **default, optional=value is None, line=node.lineno)


def _set_later(tree: ast.Module, parameters: Collection[str]) -> Iterator[str]:
    """Yields the variables that the top level of a program sets to literals and that are no parameters."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and default_of(node.value, {})["known"]:
            yield from (one.id for one in node.targets if isinstance(one, ast.Name) and one.id not in parameters)


def _agents(tree: ast.Module) -> Iterator[WrittenAgent]:
    """Yields the classes with productions: methods whose parameters all have defaults."""
    for kind in (node for node in tree.body if isinstance(node, ast.ClassDef)):
        methods = [node for node in kind.body if isinstance(node, ast.FunctionDef)]
        productions = tuple(node.name for node in methods if node.args.args and len(node.args.defaults) == len(node.args.args))
        if productions:
            name = escape_surrogates(kind.name)
            yield WrittenAgent(name=name, productions=tuple(map(escape_surrogates, productions)), parts=tuple(_parts(kind)))


def _parts(kind: ast.ClassDef) -> Iterator[WrittenPart]:
    """Yields the parts that a class body makes: `goal = Buffer()`."""
    for node in kind.body:
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and last_name(node.value.func):
            for target in node.targets:
                if isinstance(target, ast.Name):
                    yield WrittenPart(name=escape_surrogates(target.id), made_by=escape_surrogates(last_name(node.value.func)))
