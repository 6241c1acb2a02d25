"""Productions: made from methods whose defaults are patterns."""

from __future__ import annotations

import ast
import inspect
import math
from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from numbers import Real
from typing import Any, Protocol

from actr3d.actr.chunks.pattern import Bindings, conditions
from actr3d.actr.kernel.scheduler import Scheduler
from actr3d.actr.kernel.source_code import assigned_globals, file_and_line, function_node, has_file, location
from actr3d.actr.procedural.production_body import MAX_CODES, Body, Scope, compile_body
from actr3d.actr.procedural.rebinding import sees_variables, stored_names
from actr3d.errors import PatternException, ProductionException, hint_for

_sees_variables = lru_cache(maxsize=MAX_CODES)(sees_variables)


@lru_cache(maxsize=MAX_CODES)
def _assigned_in(statements: tuple[ast.stmt, ...]) -> frozenset[str]:
    return frozenset(stored_names(statements))


class ProductionOwner(Protocol):
    """The production system that a production belongs to."""

    sch: Scheduler

    def now(self) -> float:
        """Returns the current time [s]."""
        ...


class Production:
    """One rule of a production system: patterns to match, and a body to run.

    Args:
        system: The production system it belongs to.
        name: Its name.
        func: The modeller's method; its parameters name what to match, its defaults are the patterns.

    Raises:
        ProductionException: If a pattern cannot be parsed, or the body's source is not available.
    """

    base_utility: float = 0
    parents: tuple[str, ...] = ()
    """The names of the two productions that a compiled one was made from."""

    def __init__(self, system: ProductionOwner, name: str, func: Callable[..., Any]) -> None:
        self.system = system
        self.name = name
        self.original_func = func
        patterns = defaults_of(func) or {}
        self.base_utility = utility = patterns.pop("utility", 0)
        if not isinstance(utility, Real) or math.isnan(utility):
            raise ProductionException(f"production '{name}' ({self.place}): its utility must be a number (got {utility!r})").at(
                *location(func)
            )
        self.pattern_specs = patterns
        self.keys = list(patterns)
        try:
            self.conditions = conditions(patterns)
        except PatternException as error:
            raise PatternException(f"production '{name}' ({self.place}): {error}").at(*location(func)) from None
        self.bound: Bindings | None = None
        """The variables that the last match bound."""
        self.context: dict[str, Any] = {}
        """What the body sees by name; set when the system begins."""

    @property
    def place(self) -> str:
        """Where it is written: `file:line`."""
        return file_and_line(self.original_func)

    @cached_property
    def node(self) -> ast.FunctionDef:
        """The syntax tree of the modeller's method.

        Raises:
            ProductionException: If its source is not available.
        """
        node = function_node(self.original_func)
        if node is None:
            if self.original_func.__name__ == "<lambda>":
                reason = f"it is a lambda ({self.place}); write it with def"
            elif self.original_func.__code__.co_flags & (inspect.CO_COROUTINE | inspect.CO_ASYNC_GENERATOR):
                reason = f"it is async ({self.place}); write it with def"
            elif has_file(self.original_func):
                reason = f"its source is not available ({self.place}): the file has changed since it was loaded; load it again"
            else:
                reason = f"its source is not available ({self.place}); load the model from a file, or its text with loading.load_text"
            raise ProductionException(f"production '{self.name}': {reason}").at(*location(self.original_func))
        return node

    @property
    def code(self) -> str:
        """The body as text."""
        return "\n".join(map(ast.unparse, self.node.body))

    @cached_property
    def variables(self) -> list[str]:
        """The variables that the patterns bind."""
        return [condition.value for condition in self.conditions if condition.op == "bind"]

    @cached_property
    def more_bound(self) -> bool:
        """Whether a function among the patterns may also bind variables."""
        return any(condition.op == "call" for condition in self.conditions)

    @cached_property
    def any_bound(self) -> bool:
        """Whether any name in the body may be a bound variable."""
        return self.more_bound or _sees_variables(tuple(self.node.body))

    @cached_property
    def _looks_up(self) -> bool:
        """Whether the body looks names up while it runs."""
        return self.any_bound or bool(self.assigned)

    @cached_property
    def assigned(self) -> frozenset[str]:
        """The names that the body assigns."""
        return _assigned_in(tuple(self.node.body))

    def body_of(self, statements: Sequence[ast.stmt]) -> Body:
        """Makes a function of some of the body's statements."""
        return compile_body(
            statements,
            name=self.name,
            func=self.original_func,
            bound=self.variables,
            context=self.context,
            any_bound=self.any_bound,
        )

    @cached_property
    def _body(self) -> Body:
        return self.body_of(self.node.body)

    def forget_body(self) -> None:
        """Discards the function made of the body; the next one sees what the names in `context` mean then."""
        self.__dict__.pop("_body", None)

    def share_globals(self) -> None:
        """Moves names that the body declares global, and an initializer has assigned, to the globals of the modeller's file."""
        func = self.original_func
        for name in assigned_globals(func) & self.context.keys():
            func.__globals__[name] = self.context.pop(name)

    def scope(self, bound: Bindings) -> Bindings:
        """Returns the bound variables in the form that the body needs."""
        return Scope(bound, self.context, self.original_func) if self._looks_up else bound

    def fire(self) -> None:
        """Runs the body with the variables that the last match bound."""
        sch = self.system.sch
        sch.fired = sch.firing = self
        try:
            self._run()
        except Exception as error:
            self.note(error)
            raise
        finally:
            sch.firing = None

    def _run(self) -> None:
        bound = self.system.sch.bound = self.scope(self.bound or {})
        self._body(bound)

    def note(self, error: Exception) -> None:
        """Adds a note to an error: the production in which it occurred, and what a misspelt name may mean."""
        hint = hint_for(error, [*(self.system.sch.bound or {}), *self.context, *self.original_func.__globals__])
        error.add_note(f"in production '{self.name}' ({self.place}) at {self.system.now():g} s{hint}")

    def __repr__(self) -> str:
        return f"<Production {self.name}>"


def defaults_of(func: Callable[..., Any]) -> dict[str, Any] | None:
    """Returns the parameters of a function with their defaults, or None if one has none, so that it is not a production."""
    code, defaults, named = func.__code__, func.__defaults__ or (), func.__kwdefaults__ or {}
    if code.co_flags & (inspect.CO_VARARGS | inspect.CO_VARKEYWORDS):
        return None
    if len(defaults) != code.co_argcount or len(named) != code.co_kwonlyargcount:
        return None
    return {**dict(zip(code.co_varnames, defaults, strict=False)), **named}
