"""Converts the body of a production to a function of the bound variables.

A body sees, nearest first: its bound variables and the names that it assigns; the attributes of its agent and of the agent's
ancestors; the variables of a function around the agent's class; the globals of its own file. `?name` in a pattern that the body
passes to a module has the value that the body has assigned. Line numbers are kept, so that a traceback shows the modeller's own
file.
"""

from __future__ import annotations

import ast
import builtins
import copy
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from types import CellType, CodeType, FunctionType
from typing import Any

from actr3d.actr.kernel.source_code import for_python_actr, source_of, with_filename
from actr3d.actr.procedural.rebinding import BOUND, SCOPE_BUILTINS, SCOPES, Names, Rebinder, stored_names, used_names
from actr3d.errors import ProductionException

Body = Callable[[dict[str, Any]], None]
BUILTINS = vars(builtins)


class Scope(dict[str, Any]):
    """The variables that a body has bound; other names are looked up further out.

    Args:
        bound: The variables that the patterns bound.
        context: The attributes of the agent and its ancestors, by name.
        func: The modeller's function, for the variables around it and the globals of its file.
    """

    def __init__(self, bound: Mapping[str, Any], context: Mapping[str, Any], func: Callable[..., Any]) -> None:
        super().__init__(bound)
        self.__dict__["outer"] = context, func

    def __missing__(self, key: str) -> Any:
        context, func = self.__dict__["outer"]
        if key in context:
            return context[key]
        cell = cells(func).get(key)
        if cell is not None:
            return cell.cell_contents
        layers = (BUILTINS, func.__globals__) if for_python_actr(func.__globals__) else (func.__globals__, BUILTINS)
        for names in layers:
            if key in names:
                return self._seeing(key) if names is BUILTINS and key in SCOPE_BUILTINS else names[key]
        raise NameError(f"name '{key}' is not defined", name=key)

    def __delitem__(self, key: str) -> None:
        if key not in self:
            raise NameError(f"name '{key}' is not defined", name=key)
        super().__delitem__(key)

    def _seeing(self, name: str) -> Callable[..., Any]:
        """Returns a builtin that sees these variables as those around its call."""
        builtin = BUILTINS[name]
        if name in ("locals", "vars", "dir"):
            return lambda *args: builtin(*args) if args else sorted(self) if name == "dir" else self

        def run(source: Any, globals: Any = None, locals: Any = None, **keys: Any) -> Any:
            if globals is None:
                context, func = self.__dict__["outer"]
                globals, locals = {**func.__globals__, **context, **self}, self if locals is None else locals
            return builtin(source, globals, locals, **keys)

        return run

    def bind(self, key: str, value: Any) -> Any:
        """Binds a name, and returns its value."""
        self[key] = value
        return value

    def bind_all(self, names: Mapping[str, Any]) -> bool:
        """Binds several names, and returns True."""
        self.update(names)
        return True


def cells(func: Callable[..., Any]) -> dict[str, CellType]:
    """Returns the variables of the functions around `func` that it uses, by name."""
    return dict(zip(func.__code__.co_freevars, func.__closure__ or (), strict=True))


def compile_body(
    statements: Sequence[ast.stmt],
    *,
    func: Callable[..., Any],
    name: str,
    bound: Iterable[str],
    context: Mapping[str, Any],
    any_bound: bool = False,
) -> Body:
    """Compiles a body's statements to a function.

    Args:
        statements: The body, or some of its statements, as parsed; they are not changed.
        func: The modeller's function that they come from; its file's globals and the variables around it stay live.
        name: The production's name, which tracebacks show.
        bound: The variables that the patterns bind.
        context: The attributes of the agent and its ancestors by name; fixed from now on.
        any_bound: Whether any name may be a bound variable: a function among the patterns may bind some, or the body's `exec`.

    Returns:
        A function that takes the bound variables. If the body assigns names, or with `any_bound`, they must be a `Scope`.

    Raises:
        ProductionException: If the body contains `yield`, or cannot be compiled.
    """
    names = _names_of(tuple(statements))
    around = cells(func)
    if for_python_actr(func.__globals__):
        # There, a body does not see its file's globals: a builtin's name means the builtin, whatever the file assigns to it.
        context = {**{n: BUILTINS[n] for n in names if n in BUILTINS}, **context}
    seen = frozenset(n for n in names if n in context or n in around)
    code, given = _code_of(statements, func, name, tuple(bound), seen, any_bound)
    space: dict[str, Any] = {}
    exec(code, func.__globals__, space)
    body: FunctionType = space["__make__"](*(context.get(n) for n in given))
    inner = body.__code__.replace(co_name=name, co_qualname=name)
    here = dict(zip(inner.co_freevars, body.__closure__ or (), strict=True))
    closure = tuple(cell if n in context else around.get(n, cell) for n, cell in here.items())
    return FunctionType(inner, func.__globals__, name, None, closure)


_CODES: dict[Any, tuple[CodeType, Sequence[str]]] = {}
MAX_CODES = 10_000
"""The number of bodies whose code is kept."""
_names_of = lru_cache(maxsize=MAX_CODES)(used_names)


def _code_of(
    statements: Sequence[ast.stmt], func: Callable[..., Any], name: str, bound: tuple[str, ...], seen: frozenset[str], any_bound: bool
) -> tuple[CodeType, Sequence[str]]:
    """Returns the result of `_compile`, once for all agents that are loaded from a text, also if it is loaded again: their names have
    different values, but their code is equal except for the file's name."""
    places = tuple((statement.lineno, statement.col_offset) for statement in statements)
    filename = func.__code__.co_filename
    key = (source_of(func), func.__code__, func.__qualname__, name, places, bound, seen, any_bound)
    made = _CODES.get(key)
    if made is None:
        _refuse_yield(statements, name, filename)
        if len(_CODES) >= MAX_CODES:
            _CODES.clear()
        made = _CODES[key] = _compile(statements, func, name, bound, seen, any_bound)
    code, given = made
    return with_filename(code, filename), given


def _compile(
    statements: Sequence[ast.stmt], func: Callable[..., Any], name: str, bound: Iterable[str], seen: Iterable[str], any_bound: bool
) -> tuple[CodeType, Sequence[str]]:
    """Compiles a factory, which takes objects by name and returns the body as a function; returns its code, and the names that it needs."""
    filename = func.__code__.co_filename
    assigned = stored = stored_names(statements)
    used = used_names(statements)
    mangler = _Mangler(func)
    body = [mangler.visit(copy.deepcopy(node)) for node in statements]
    if any_bound:
        stored = assigned | used - Names(statements).declared_global
    own = SCOPE_BUILTINS - assigned
    if stored:
        body = Rebinder(stored, own).body(body)
    taken = [n for n in bound if n in used and n not in stored - own]
    given = sorted(n for n in seen if n not in stored - own and n not in taken)
    first = statements[0]
    items = {n: ast.Subscript(ast.Name(BOUND, ast.Load()), ast.Constant(n), ast.Load()) for n in taken}
    prologue = [ast.Assign([ast.Name(n, ast.Store())], item) for n, item in items.items()]
    inner = _function("__production__", [BOUND], [*prologue, *body], first)
    outer = _function("__make__", given, [inner, ast.Return(ast.Name("__production__", ast.Load()))], first)
    module = ast.fix_missing_locations(ast.Module([outer], []))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the compiler has issued all warnings about the file
            return compile(module, filename, "exec", dont_inherit=True), given
    except SyntaxError as error:
        line = error.lineno or first.lineno
        raise ProductionException(f"{filename}:{line}: production '{name}': {error.msg}").at(filename, line) from error


def _refuse_yield(statements: Iterable[ast.stmt], name: str, filename: str) -> None:
    """Raises an error if a body contains `yield`."""
    for node in statements:
        for part in _own_nodes(node):
            if isinstance(part, (ast.Yield, ast.YieldFrom, ast.Await)):
                word = "awaits" if isinstance(part, ast.Await) else "yields"
                raise ProductionException(
                    f"{filename}:{part.lineno}: production '{name}' {word}; the body of a production cannot wait: "
                    "call a generator method, which can"
                ).at(filename, part.lineno)


class _Mangler(ast.NodeTransformer):
    """Renames private attributes (`self.__x`) as Python does in the methods of the same class."""

    def __init__(self, func: Callable[..., Any]) -> None:
        path = func.__qualname__.split(".")
        self.owner = path[-2].lstrip("_") if len(path) > 1 and path[-2] != "<locals>" else ""

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        self.generic_visit(node)
        if self.owner and node.attr.startswith("__") and not node.attr.endswith("__"):
            node.attr = f"_{self.owner}{node.attr}"
        return node

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.AST:
        return node  # an inner class mangles with its own name


def _own_nodes(node: ast.AST) -> Iterable[ast.AST]:
    """Yields a node and those below it that belong to the same function."""
    yield node
    if not isinstance(node, SCOPES):
        for child in ast.iter_child_nodes(node):
            yield from _own_nodes(child)


def _function(name: str, parameters: Sequence[str], body: list[Any], at: ast.AST) -> ast.FunctionDef:
    """Returns a plain function definition at the position of `at`."""
    args = ast.arguments(posonlyargs=[], args=[ast.arg(p) for p in parameters], kwonlyargs=[], kw_defaults=[], defaults=[])
    node: Any = ast.FunctionDef(name=name, args=args, body=body or [ast.Pass()], decorator_list=[])
    node.type_params = []  # required from Python 3.12 on
    return ast.copy_location(node, at)
